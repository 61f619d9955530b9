// SPDX-License-Identifier: MIT
// The anomalies that a sensor has at present. An anomaly begins with a measurement beyond its threshold; it
// ends with one within, kHold after the last one beyond at the earliest.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "atlas/monitor/anomaly.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

class Findings {
 public:
  static constexpr Duration kHold = kSecond;

  explicit Findings(const AnomalyThresholds& thresholds) : thresholds_(thresholds) {}

  /// The quantity of an anomaly, judged against its threshold.
  void measure(Anomaly anomaly, Stamp stamp, double value) {
    measure(anomaly, stamp, value, thresholds_[anomaly]);
  }
  /// Against a limit of its own.
  void measure(Anomaly anomaly, Stamp stamp, double value, double limit);
  /// What somebody else has judged; `value` goes with it.
  void judge(Anomaly anomaly, Stamp stamp, bool present, double value, double limit);
  [[nodiscard]] double threshold(Anomaly anomaly) const { return thresholds_[anomaly]; }
  [[nodiscard]] bool has(Anomaly anomaly) const {
    return active_[static_cast<std::size_t>(anomaly)].has_value();
  }
  /// 1 without anomalies; the product of 1 - severity of those that are there.
  [[nodiscard]] double score() const;
  /// In the order of the table.
  [[nodiscard]] std::vector<SensorAnomaly> list() const;
  /// True once after an anomaly began or ended.
  bool takeChange();
  /// Anomalies that ever began, by kind.
  [[nodiscard]] const std::array<std::uint64_t, kAnomalies>& begun() const { return begun_; }

 private:
  struct Active {
    Stamp since = 0, last = 0;
    double value = 0.0, limit = 0.0;  ///< of the newest measurement beyond
  };
  AnomalyThresholds thresholds_;
  std::array<std::optional<Active>, kAnomalies> active_{};
  std::array<std::uint64_t, kAnomalies> begun_{};
  bool changed_ = false;
};

}  // namespace atlas
