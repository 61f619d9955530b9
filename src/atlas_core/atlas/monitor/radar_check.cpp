// SPDX-License-Identifier: MIT
#include "atlas/monitor/radar_check.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {

void RadarCheck::add(const RadarScan& scan, Findings& findings) {
  std::vector<double> values;
  for (const RadarTarget& target : scan.targets) {
    values.insert(values.end(), {target.position.x(), target.position.y(), target.position.z(),
                                 target.radial_velocity_mps});
  }
  const bool finite = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  findings.measure(Anomaly::kNotFinite, scan.stamp, finite ? 0.0 : 1.0);
  if (!finite) return;
  const bool empty = values.empty();  // nothing in view, again and again, is no fault
  const double same_s = same_.add(scan.stamp, std::move(values));
  findings.measure(Anomaly::kTargetsFrozen, scan.stamp, empty ? 0.0 : same_s);
}

}  // namespace atlas
