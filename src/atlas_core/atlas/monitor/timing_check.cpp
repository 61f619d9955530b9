// SPDX-License-Identifier: MIT
#include "atlas/monitor/timing_check.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {
namespace {
constexpr std::size_t kIntervalsToLearn = 15;
constexpr double kSilentPeriods = 5.0;
constexpr Duration kRateWindow = 4 * kSecond;
constexpr int kLeastInWindow = 8;
}  // namespace

void TimingCheck::add(Stamp stamp, Findings& findings) {
  if (last_ == kBeginOfTime) {
    last_ = window_begin_ = stamp;
    findings.measure(Anomaly::kMissing, stamp, 0.0);
    return;
  }
  const Duration interval = stamp - last_;
  findings.measure(Anomaly::kDuplicate, stamp, interval == 0 ? 1.0 : 0.0);
  findings.measure(Anomaly::kMissing, stamp, 0.0);
  if (interval == 0) return;
  last_ = stamp;
  if (period_ == 0) {
    learn(interval);
    return;
  }
  findings.measure(Anomaly::kGap, stamp, static_cast<double>(interval) / static_cast<double>(period_));
  measureRate(stamp, findings);
}

void TimingCheck::learn(Duration interval) {
  first_intervals_.push_back(interval);
  if (first_intervals_.size() < kIntervalsToLearn) return;
  const auto middle = first_intervals_.begin() + kIntervalsToLearn / 2;
  std::nth_element(first_intervals_.begin(), middle, first_intervals_.end());
  period_ = *middle;
  first_intervals_ = {};
  window_begin_ = last_;
}

void TimingCheck::measureRate(Stamp stamp, Findings& findings) {
  ++in_window_;
  const Duration span = stamp - window_begin_;
  if (span < kRateWindow || in_window_ < kLeastInWindow) return;
  const double usual = static_cast<double>(span) / static_cast<double>(period_);
  findings.measure(Anomaly::kRate, stamp, std::abs(in_window_ / usual - 1.0));
  window_begin_ = stamp;
  in_window_ = 0;
}

void TimingCheck::misordered(Stamp stamp, std::uint64_t messages, Findings& findings) const {
  findings.measure(Anomaly::kMisordered, stamp, static_cast<double>(messages));
}

void TimingCheck::tick(Stamp now, Stamp begin, Findings& findings) const {
  const Stamp since = seen() ? last_ : begin;
  const double allowed_s =
      std::max(findings.threshold(Anomaly::kMissing), kSilentPeriods * toSeconds(period_));
  findings.measure(Anomaly::kMissing, now, toSeconds(now - since), allowed_s);
}

}  // namespace atlas
