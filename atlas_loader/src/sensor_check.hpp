// SPDX-License-Identifier: MIT
// The sensor monitor alone over a recording: decoder, monitor, and a summary of what it said.
#pragma once

#include <map>
#include <string>

#include "atlas/monitor/monitor_stage.hpp"
#include "open_input.hpp"

namespace atlas_loader {

struct SensorCheckOptions {
  InputOptions input;
  std::string config;  ///< YAML file; "" = packaged
  std::string out;     ///< "" = no file
  bool list = false;   ///< of the program: the table of anomalies
};

struct SeenAnomaly {
  int times = 0;
  double first_s = 0, lasted_s = 0;  ///< from the first status on
  double worst = 0;                  ///< value farthest from the threshold
  std::string unit;
};
struct CheckedSensor {
  double mean_score = 1, least_score = 1;  ///< mean over time
  std::map<std::string, SeenAnomaly> anomalies;
};
struct SensorCheck {
  double data_s = 0;
  std::map<std::string, CheckedSensor> sensors;
  [[nodiscard]] bool clean() const;
};

/// Collects what the monitor says.
class SensorCheckSummary {
 public:
  void add(const atlas::SensorStatus& status);
  /// Up to the newest status.
  [[nodiscard]] SensorCheck result() const;

 private:
  struct Collected {
    CheckedSensor checked;
    double score_time = 0;  ///< integral of the score, s
    atlas::Stamp begin = 0;
    atlas::SensorStatus newest;
  };
  static void hold(Collected& sensor, atlas::Stamp until);

  std::map<std::string, Collected> sensors_;
  atlas::Stamp first_ = 0, last_ = 0;
};

/// Throws std::invalid_argument for bad options, std::runtime_error for unreadable input.
SensorCheck checkSensors(const SensorCheckOptions& options);

}  // namespace atlas_loader
