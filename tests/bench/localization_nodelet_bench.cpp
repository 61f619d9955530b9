// SPDX-License-Identifier: MIT
// What a message costs the localization nodelet, from the sensor_msgs/Imu to everything that is published for
// it: conversion, merge by stamp, guard, filter, odometry, tf, fused fix, path, status, each serialized as
// for a subscriber in another process. 100 Hz IMU, 20 Hz fixes of two receivers and headings, circles at 8
// m/s. The transport itself (sockets, callback queues) is not in it.
#include <benchmark/benchmark.h>
#include <ros/serialization.h>
#include <tf2_msgs/TFMessage.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <optional>

#include "atlas/localization/localization_stage.hpp"
#include "atlas_ros/message_of.hpp"
#include "status_messages.hpp"

namespace {

using namespace atlas;
constexpr double kSpeed_mps = 8.0, kRate_radps = 0.4, kRadius_m = kSpeed_mps / kRate_radps;
constexpr Duration kPeriod = 10 * kMillisecond;
const Geodetic kAnchor{49.2, 16.6, 280.0};

/// The path's messages of one IMU sample and what they become.
class Nodelet {
 public:
  Nodelet() : stage_(params()) {
    stage_.on_odometry = [this](const Odometry& odometry) {
      publish(*boost::make_shared<nav_msgs::Odometry>(atlas_ros::MessageOf<Odometry>::to(odometry)));
      tf2_msgs::TFMessage tf;
      tf.transforms = atlas_localization::transformsOf(odometry);
      publish(tf);
      if (map_) publish(atlas_localization::fusedFix(odometry, *map_));
      if (path_.extend(odometry)) publish(path_.message());
    };
    stage_.on_anchor = [this](const Anchor& anchor) { map_.emplace(anchor.position); };
    stage_.on_status = [this](const LocalizationStatus& status) {
      publish(atlas_localization::toMsg(status));
      if (status.bias) publish(atlas_localization::toMsg(*status.bias, status.stamp));
    };
    stage_.finish(LocalizationStage::kTfStatic);
  }

  /// Messages of the k-th period; their number.
  int play(int k) {
    const Stamp stamp = kSecond + k * kPeriod;
    const double angle = kRate_radps * toSeconds(k * kPeriod);
    int messages = 1;
    if (k % 5 == 0) {
      const LocalEnu map(kAnchor);
      GnssFix fix{stamp,
                  map.toGeodetic({kRadius_m * std::sin(angle), kRadius_m * (1.0 - std::cos(angle)), 0.0}),
                  std::nullopt, ""};
      const auto value = through(fix);
      stage_.push(value);
      stage_.pushSecond(value);
      stage_.push(through(GnssHeading{stamp, std::remainder(angle, 2.0 * M_PI), 2.7e-3}));
      messages += 3;
    }
    ImuSample sample;
    sample.stamp = stamp;
    sample.angular_velocity_radps = {1e-4 * std::sin(7.0 * k), 0.0, kRate_radps};
    sample.linear_acceleration_mps2 = {0.0, kSpeed_mps * kRate_radps, gravity_mps2_};
    sample.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
    stage_.push(through(sample));
    for (std::size_t input = 1; input < stage_.inputs(); ++input) stage_.advance(input, stamp);
    return messages;
  }
  [[nodiscard]] std::uint64_t odometries() const { return stage_.counters().get("odometry"); }
  [[nodiscard]] double bytes() const { return bytes_; }

 private:
  static LocalizationParams params() {
    LocalizationParams params;
    params.filter = "eskf";
    params.gnss_antenna_frame = "";
    params.receivers.second_receiver = true;
    params.positioning.imu_to_rear_axle_m = 0.0;
    return params;
  }
  /// The value as it comes out of its message.
  template <class T>
  static T through(const T& value) {
    return atlas_ros::MessageOf<T>::from(atlas_ros::MessageOf<T>::to(value)).value();
  }
  template <class Message>
  void publish(const Message& message) {
    bytes_ += static_cast<double>(ros::serialization::serializeMessage(message).num_bytes);
  }

  LocalizationStage stage_;
  atlas_localization::GrowingPath path_;
  std::optional<LocalEnu> map_;
  double gravity_mps2_ = normalGravity(kAnchor.latitude_deg, kAnchor.altitude_m);
  double bytes_ = 0.0;
};

/// `range(0)`: seconds driven before the measurement begins; the path has grown by then.
void BM_NodeletPerMessage(benchmark::State& state) {
  Nodelet nodelet;
  int k = 0;
  const int before = static_cast<int>(state.range(0)) * 100;
  while (k < before) nodelet.play(k++);
  std::int64_t messages = 0;
  for (auto _ : state) messages += nodelet.play(k++);
  state.SetItemsProcessed(messages);
  state.counters["per_message"] = benchmark::Counter(
      static_cast<double>(messages), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["odometries"] = static_cast<double>(nodelet.odometries());
}
BENCHMARK(BM_NodeletPerMessage)->Arg(10)->Arg(600);

}  // namespace
