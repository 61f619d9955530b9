// SPDX-License-Identifier: MIT
#include "record/sweep_timing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace atlas::record {
namespace {
/// Time from the file's own field, relative to `stamp`. Offsets count from the first point of the scan.
void applyFileTime(const PcdCloud& cloud, const SweepTiming& timing, Sweep& sweep) {
  // Unix seconds as double resolve 0.2 us; subtract whole seconds first.
  const double stamp_s = toSeconds(sweep.stamp % kSecond) + static_cast<double>(sweep.stamp / kSecond);
  double shift_s = cloud.absolute_time ? -stamp_s : 0.0;
  if (!cloud.absolute_time && timing.stamp_marks == RecordOptions::ScanStamp::kEnd) {
    double last = -std::numeric_limits<double>::infinity();
    for (const double t : cloud.time_s) last = std::isfinite(t) ? std::max(last, t) : last;
    if (last > 0.0)
      shift_s = -last;  // offsets from the start: the last one is the stamp's; already negative ones stay
  }
  for (std::size_t i = 0; i < sweep.points.size(); ++i)
    sweep.points[i].time = static_cast<float>(cloud.time_s[i] + shift_s);
}
}  // namespace

double revolutionDuration(std::optional<Duration> interval) {
  constexpr double kNominal = 0.1, kShortest = 0.05,
                   kLongest = 0.2;  // s; 20 Hz .. 5 Hz, the range of the sensor
  if (!interval) return kNominal;
  const double seconds = toSeconds(*interval);
  return seconds >= kShortest && seconds <= kLongest ? seconds : kNominal;
}

Sweep makeSweep(PcdCloud cloud, Stamp stamp, const std::string& frame, const SweepTiming& timing) {
  Sweep sweep;
  sweep.stamp = stamp;
  sweep.frame = frame;
  sweep.points = std::move(cloud.points);
  const std::size_t size = sweep.points.size();
  const bool columns = timing.rotating && size % kLasersHdl32 == 0;
  const std::size_t group = columns ? kLasersHdl32 : 1;
  const double steps = static_cast<double>(size / group);
  const double offset = timing.stamp_marks == RecordOptions::ScanStamp::kEnd ? -timing.duration_s : 0.0;
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < size; ++i) {
    LidarPoint& point = sweep.points[i];
    if (point.x == 0.0f && point.y == 0.0f && point.z == 0.0f) point.x = point.y = point.z = kNaN;
    const double phase = static_cast<double>(i / group) / steps;
    point.time = static_cast<float>(offset + timing.duration_s * phase);
    if (!cloud.has_ring)
      point.ring = columns ? static_cast<std::uint16_t>(i % kLasersHdl32) : std::uint16_t{0};
  }
  if (cloud.time_s.size() == size && size > 0) applyFileTime(cloud, timing, sweep);
  return sweep;
}

std::optional<InnerTime> decodeInnerTime(std::uint64_t inner, Stamp system) {
  const auto seconds = static_cast<std::int64_t>(inner >> 32);
  const auto microseconds = static_cast<std::int64_t>(inner & 0xffffffffu);
  constexpr std::int64_t kHour = 3600;
  if (microseconds >= kHour * 1'000'000 + 1'000'000) return std::nullopt;
  const Stamp raw = (seconds / kHour * kHour) * kSecond + microseconds * 1000;
  InnerTime best{raw, false};
  // Off by one second, or by an hour when the two halves are from both sides of a full hour.
  for (const std::int64_t shift :
       {-kHour - 1, -kHour, -kHour + 1, std::int64_t{-1}, std::int64_t{1}, kHour - 1, kHour, kHour + 1}) {
    const Stamp candidate = raw + shift * kSecond;
    if (std::llabs(candidate - system) < std::llabs(best.time - system)) best = {candidate, true};
  }
  if (std::llabs(best.time - system) > 2 * kSecond) return std::nullopt;
  return best;
}

}  // namespace atlas::record
