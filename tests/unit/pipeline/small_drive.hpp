// SPDX-License-Identifier: MIT
// A drive small enough for a unit test: a car goes straight east at constant speed towards a wall; one fix
// and heading every 50 ms, IMU at 100 Hz, two lidars and two cameras at 10 Hz, a thermal camera at 30 Hz. All
// sensors are exact.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "atlas/pipeline.hpp"

namespace atlas::test {

constexpr Stamp kStart = 1'568'186'745'000'000'000;
constexpr double kWall_m = 30.0;  ///< x of the wall in map; y from -10 to 10, 5 m high
constexpr double kRoad_m = -1.7;  ///< z of the road in map, whose origin is the first fix
const Geodetic kBrno{49.2281, 16.5755, 281.0};

/// What a source publishes.
struct SourceEvent {
  Stamp stamp = 0;
  std::string topic;
  std::function<void(LocalGraph&)> publish;
};

class SmallDrive {
 public:
  explicit SmallDrive(double duration_s, double speed_mps = 2.0) : speed_mps_(speed_mps) {
    every(0.01, 0.0, duration_s, "imu/data", [this](Stamp stamp, std::uint32_t) { return imu(stamp); });
    every(0.05, 0.003, duration_s, "gnss/fix", [this](Stamp stamp, std::uint32_t) { return fix(stamp); });
    every(0.05, 0.003, duration_s, "gnss/heading", [](Stamp stamp, std::uint32_t) {
      return GnssHeading{stamp, 0.0, 1e-6};
    });
    for (const char* lidar : {"lidar_left", "lidar_right"}) {
      const double offset_s = lidar[6] == 'l' ? 0.02 : 0.06;
      every(0.1, offset_s, duration_s, lidar + std::string("/points"),
            [this, lidar](Stamp stamp, std::uint32_t) { return sweep(stamp, lidar); });
    }
    for (const char* camera : {"camera_left_front", "camera_right_front"}) {
      every(0.1, 0.04, duration_s, camera + std::string("/camera_info"),
            [camera](Stamp stamp, std::uint32_t) { return info(stamp, camera); });
      every(0.1, 0.04, duration_s, camera + std::string("/detections"),
            [camera](Stamp stamp, std::uint32_t index) { return detections(stamp, camera, index); });
    }
    every(1.0 / 30.0, 0.001, duration_s, "camera_ir/camera_info",
          [](Stamp stamp, std::uint32_t) { return info(stamp, "camera_ir"); });
    std::stable_sort(events_.begin(), events_.end(),
                     [](const SourceEvent& a, const SourceEvent& b) { return a.stamp < b.stamp; });
    add(kStart, "tf_static", rig());
    std::rotate(events_.begin(), events_.end() - 1, events_.end());  // first, as every reader does
  }

  [[nodiscard]] const std::vector<SourceEvent>& events() const { return events_; }
  [[nodiscard]] double xAt(Stamp stamp) const { return speed_mps_ * toSeconds(stamp - kFirstFix); }
  void drop(const std::string& topic, Stamp from) {
    events_.erase(std::remove_if(events_.begin(), events_.end(),
                                 [&](const SourceEvent& e) { return e.topic == topic && e.stamp >= from; }),
                  events_.end());
  }

 private:
  static constexpr Stamp kFirstFix = kStart + 3 * kMillisecond;  ///< where map begins

  template <class T>
  void add(Stamp stamp, const std::string& topic, const T& value) {
    events_.push_back({stamp, topic, [topic, value](LocalGraph& graph) { graph.publish(topic, value); }});
  }
  template <class Make>
  void every(double period_s, double offset_s, double duration_s, const std::string& topic, Make make) {
    std::uint32_t index = 0;
    for (; offset_s + index * period_s < duration_s; ++index) {
      const Stamp stamp = kStart + fromSeconds(offset_s + index * period_s);
      add(stamp, topic, make(stamp, index));
    }
  }
  [[nodiscard]] Pose T_map_imu(Stamp stamp) const {
    return {Eigen::Quaterniond::Identity(), {xAt(stamp), 0, 0}};
  }
  static StaticTransforms rig() {
    const Eigen::Quaterniond optical(0.5, -0.5, 0.5, -0.5);  // looks along x of the imu
    StaticTransforms result;
    const auto put = [&](const std::string& frame, const Pose& T) {
      result.transforms.push_back({"base_link", frame, T});
    };
    put("gnss_rear", {});
    put("lidar_left", {fromRollPitchYaw({0, 0, 0.3}), {0.2, 0.5, 0.1}});
    put("lidar_right", {fromRollPitchYaw({0, 0, -0.3}), {0.2, -0.5, 0.1}});
    for (const char* camera : {"camera_left_front", "camera_right_front", "camera_ir"})
      put(camera, {optical, {0.5, 0, 0}});
    return result;
  }
  static ImuSample imu(Stamp stamp) {
    ImuSample sample;
    sample.stamp = stamp;
    sample.linear_acceleration_mps2.z() = normalGravity(kBrno.latitude_deg, kBrno.altitude_m);
    sample.orientation = Eigen::Quaterniond::Identity();
    return sample;
  }
  [[nodiscard]] GnssFix fix(Stamp stamp) const {
    return {stamp, LocalEnu(kBrno).toGeodetic({xAt(stamp), 0, 0}), std::nullopt, "gnss_rear"};
  }
  static CameraInfo info(Stamp stamp, const std::string& frame) {
    CameraInfo result;
    result.stamp = stamp;
    result.frame = frame;
    result.width = 101;
    result.height = 81;
    result.distortion_model = "plumb_bob";
    result.distortion = {0, 0, 0, 0, 0};
    result.K = {100, 0, 50, 0, 100, 40, 0, 0, 1};
    return result;
  }
  static Detections detections(Stamp stamp, const std::string& frame, std::uint32_t index) {
    return {stamp, frame, index, {{45, 35, 55, 45, 2, 0.9}, {20, 30, 30, 40, 0, 0.8}}};
  }
  /// Points of the wall and of the road, the last one at the sweep's stamp.
  [[nodiscard]] SweepPtr sweep(Stamp stamp, const std::string& frame) const {
    auto result = std::make_shared<Sweep>();
    result->stamp = stamp;
    result->frame = frame;
    std::vector<Eigen::Vector3d> places;
    for (double y = -10.0; y <= 10.0; y += 0.4) {
      for (int j = 0; j < 12; ++j) places.emplace_back(kWall_m, y, kRoad_m + 0.4 * j);
      for (int j = 0; j < 10; ++j) places.emplace_back(kWall_m - 1.0 - 2.0 * j, y, kRoad_m);
    }
    Pose T_imu_lidar;
    for (const StaticTransform& t : rig().transforms)
      T_imu_lidar = t.child == frame ? t.T_parent_child : T_imu_lidar;
    for (std::size_t i = 0; i < places.size(); ++i) {
      LidarPoint p;
      p.time =
          static_cast<float>(-0.1 + 0.1 * static_cast<double>(i + 1) / static_cast<double>(places.size()));
      const Pose T_map_lidar = T_map_imu(stamp + fromSeconds(p.time)) * T_imu_lidar;
      const Eigen::Vector3f p_lidar = (T_map_lidar.inverse() * places[i]).cast<float>();
      p.x = p_lidar.x();
      p.y = p_lidar.y();
      p.z = p_lidar.z();
      result->points.push_back(p);
    }
    return result;
  }

  double speed_mps_;
  std::vector<SourceEvent> events_;
};

}  // namespace atlas::test
