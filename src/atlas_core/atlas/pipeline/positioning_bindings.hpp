// SPDX-License-Identifier: MIT
// Inputs and outputs of what watches the sensors and what positions the vehicle.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "atlas/localization/localization_stage.hpp"
#include "atlas/monitor/monitor_stage.hpp"
#include "atlas/pipeline/common_bindings.hpp"

namespace atlas {

template <class Bus>
StageFactory bindMonitor(Bus& bus, const MonitorParams& params) {
  using S = MonitorStage;
  validate(params);
  const MonitorStage::Inputs first(params);
  bus.template input<S, StaticTransforms>(S::kTfStatic, "tf_static",
                                          [](S& s, const StaticTransforms& t) { s.push(kStaticStamp, t); });
  bus.template input<S, ImuSample>(S::kImu, "imu/data", [](S& s, const ImuSample& imu) { s.push(imu); });
  bus.template input<S, MagneticSample>(S::kMagnetic, "imu/mag",
                                        [](S& s, const MagneticSample& field) { s.push(field); });
  bus.template input<S, ScalarSample>(S::kPressure, "imu/pressure",
                                      [](S& s, const ScalarSample& pressure) { s.push(pressure); });
  bus.template input<S, GnssFix>(S::kFix, "gnss/fix", [](S& s, const GnssFix& fix) { s.push(fix); });
  bus.template input<S, GnssHeading>(S::kHeading, "gnss/heading",
                                     [](S& s, const GnssHeading& h) { s.push(h); });
  bus.template input<S, GnssFix>(S::kSecondFix, "imu/gnss/fix",
                                 [](S& s, const GnssFix& fix) { s.pushSecond(fix); });
  std::vector<std::pair<std::size_t, std::string>> clocks = {{S::kImuTime, "imu/time"},
                                                             {S::kFixTime, "gnss/time"}};
  for (std::size_t i = 0; i < params.lidars.size(); ++i)
    clocks.emplace_back(first.times + i, params.lidars[i] + "/time");
  for (const auto& [index, topic] : clocks) {
    bus.template input<S, TimeReference>(index, topic, [index = index](S& s, const TimeReference& reference) {
      s.pushTime(index, reference);
    });
  }
  inputs<S, SweepPtr>(bus, first.points, params.lidars, "/points");
  inputs<S, CameraInfo>(bus, first.infos, params.cameras, "/camera_info");
  inputs<S, ImagePtr>(bus, first.images, params.cameras, "/image");
  inputs<S, TemperatureRange>(bus, first.ranges, params.thermal_cameras, "/temperature_range");
  inputs<S, RadarScan>(bus, first.scans, params.radars, "/scan");
  const auto status = bus.template output<SensorStatus>("sensor_status");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_status = status;
    return stage;
  };
}

template <class Bus>
StageFactory bindLocalization(Bus& bus, const LocalizationParams& params) {
  using S = LocalizationStage;
  validate(params);
  const auto at = [&params](typename S::Input input) { return S::gatedInput(params, input); };
  bus.template input<S, StaticTransforms>(S::kTfStatic, "tf_static",
                                          [](S& s, const StaticTransforms& t) { s.push(kStaticStamp, t); });
  if (!params.gate_on_sensors.empty()) sensorStatus<S>(bus, S::kGateStatus);
  bus.template input<S, GnssFix>(at(S::kGnssFix), "gnss/fix", [](S& s, const GnssFix& fix) { s.push(fix); });
  bus.template input<S, GnssHeading>(at(S::kGnssHeading), "gnss/heading",
                                     [](S& s, const GnssHeading& h) { s.push(h); });
  bus.template input<S, ImuSample>(at(S::kImu), "imu/data", [](S& s, const ImuSample& imu) { s.push(imu); });
  if (params.receivers.second_receiver) {
    bus.template input<S, GnssFix>(at(S::kSecondFix), "imu/gnss/fix",
                                   [](S& s, const GnssFix& fix) { s.pushSecond(fix); });
  }
  if (params.barometer.barometer) {
    bus.template input<S, ScalarSample>(at(S::kPressure), "imu/pressure",
                                        [](S& s, const ScalarSample& pressure) { s.pushPressure(pressure); });
  }
  const auto odometry = bus.template output<Odometry>("odometry");
  const auto anchor = bus.template output<Anchor>("anchor");
  return [=] {
    auto stage = std::make_unique<S>(params);
    stage->on_odometry = odometry;
    stage->on_anchor = anchor;
    return stage;
  };
}

}  // namespace atlas
