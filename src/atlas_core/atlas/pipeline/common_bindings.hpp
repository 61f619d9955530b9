// SPDX-License-Identifier: MIT
// Inputs that several stages have in common.
#pragma once

#include "atlas/base/bus.hpp"
#include "atlas/base/local_graph.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

/// Transforms that never change count before every other event.
constexpr Stamp kStaticStamp = 0;

template <class StageType, class Bus>
void rigAndOdometry(Bus& bus) {
  bus.template input<StageType, StaticTransforms>(
      0, "tf_static", [](StageType& s, const StaticTransforms& t) { s.push(kStaticStamp, t); });
  bus.template input<StageType, Odometry>(1, "odometry", [](StageType& s, const Odometry& o) { s.push(o); });
}

/// For stages that gate on the scores of sensors.
template <class StageType, class Bus>
void sensorStatus(Bus& bus, std::size_t input) {
  bus.template input<StageType, SensorStatus>(
      input, "sensor_status", [](StageType& s, const SensorStatus& status) { s.push(status); });
}

}  // namespace atlas
