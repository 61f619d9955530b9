// SPDX-License-Identifier: MIT
#include "atlas/output/status_csv.hpp"

#include "atlas/output/fixed_text.hpp"

namespace atlas {

std::string statusCsvHeader() { return "stamp_ns,sensor,score,anomalies\n"; }

std::string statusCsvRow(const SensorStatus& status) {
  std::string text =
      std::to_string(status.stamp) + "," + status.sensor + "," + fixedText(status.score, 3) + ",";
  const char* between = "";
  for (const SensorAnomaly& anomaly : status.anomalies) {
    text += between + anomaly.name + "=" + fixedText(anomaly.value, 3);
    between = ";";
  }
  return text + "\n";
}

}  // namespace atlas
