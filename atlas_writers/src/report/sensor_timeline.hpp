// SPDX-License-Identifier: MIT
// What the sensor monitor said, from sensors/status.csv: a band of time for each sensor, coloured by its
// score, with the anomalies written where they began.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "atlas/base/time.hpp"
#include "report/html.hpp"

namespace atlas::report {

struct SensorSpan {
  Stamp begin = 0, end = 0;
  double score = 1;
  std::vector<std::string> anomalies;  ///< names
};
struct SensorBand {
  std::string sensor;
  std::vector<SensorSpan> spans;  ///< in time order, without gaps
};

/// Sensors in the order of their names; a status lasts until the sensor's next one, the last one until the
/// end of all. Empty without the file; throws std::runtime_error naming file and line of a broken row.
std::vector<SensorBand> readStatus(const std::filesystem::path& file);
/// "" without bands.
std::string timelineSvg(const std::vector<SensorBand>& bands);
/// Mean score of each sensor, and how long each anomaly lasted.
Table sensorTable(const std::vector<SensorBand>& bands);

}  // namespace atlas::report
