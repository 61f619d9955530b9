// SPDX-License-Identifier: MIT
#include "atlas/monitor/findings.hpp"

namespace atlas {

void Findings::measure(Anomaly anomaly, Stamp stamp, double value, double limit) {
  const bool beyond = infoOf(anomaly).side == AnomalyInfo::kAbove ? value > limit : value < limit;
  judge(anomaly, stamp, beyond, value, limit);
}

void Findings::judge(Anomaly anomaly, Stamp stamp, bool present, double value, double limit) {
  const auto index = static_cast<std::size_t>(anomaly);
  std::optional<Active>& active = active_[index];
  if (present) {
    if (!active) {
      active.emplace().since = stamp;
      ++begun_[index];
      changed_ = true;
    }
    active->last = stamp;
    active->value = value;
    active->limit = limit;
  } else if (active && stamp - active->last >= kHold) {
    active.reset();
    changed_ = true;
  }
}

double Findings::score() const {
  double score = 1.0;
  for (std::size_t i = 0; i < kAnomalies; ++i) {
    if (active_[i]) score *= 1.0 - infoOf(static_cast<Anomaly>(i)).severity;
  }
  return score;
}

std::vector<SensorAnomaly> Findings::list() const {
  std::vector<SensorAnomaly> result;
  for (std::size_t i = 0; i < kAnomalies; ++i) {
    if (!active_[i]) continue;
    const AnomalyInfo& info = infoOf(static_cast<Anomaly>(i));
    result.push_back({info.name, active_[i]->value, active_[i]->limit, info.unit, active_[i]->since});
  }
  return result;
}

bool Findings::takeChange() {
  const bool changed = changed_;
  changed_ = false;
  return changed;
}

}  // namespace atlas
