// SPDX-License-Identifier: MIT
// What a stage does with the scores of the sensor monitor: data of a sensor whose score is below a limit is
// not used. Its status input stands before those of the data, so that a status counts for data of its stamp.
#pragma once

#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "atlas/sensor/products.hpp"

namespace atlas {

/// Least score by sensor; sensors that are not named are always used.
using SensorLimits = std::map<std::string, double>;

/// Throws std::invalid_argument naming the stage, the sensor and its limit when that is not in 0..1.
inline void validate(const SensorLimits& limits, const std::string& stage) {
  for (const auto& [sensor, limit] : limits) {
    if (limit >= 0.0 && limit <= 1.0) continue;
    throw std::invalid_argument(stage + ": gate_on_sensors: " + sensor + " must be in 0..1, got " +
                                std::to_string(limit));
  }
}

class SensorGate {
 public:
  explicit SensorGate(SensorLimits limits) : limits_(std::move(limits)) {}
  void add(const SensorStatus& status) { scores_[status.sensor] = status.score; }
  /// True before the first status, too.
  [[nodiscard]] bool open(const std::string& sensor) const {
    const auto limit = limits_.find(sensor);
    const auto score = scores_.find(sensor);
    return limit == limits_.end() || score == scores_.end() || score->second >= limit->second;
  }

 private:
  SensorLimits limits_;
  std::map<std::string, double> scores_;
};

}  // namespace atlas
