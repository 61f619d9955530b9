// SPDX-License-Identifier: MIT
#include "record/sweep_timing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

#include "record/scan_layout.hpp"

namespace atlas::record {
namespace {
/// Time from the file's own field, relative to `stamp`, s; offsets count from the first point of the scan.
/// NaN where the file has none. Empty when the field is not believable: farther than a second from the stamp.
std::vector<double> fileTime(const PcdCloud& cloud, Stamp stamp, const SweepTiming& timing) {
  if (cloud.time_s.empty() || cloud.time_s.size() != cloud.points.size()) return {};
  // Unix seconds as double resolve 0.2 us; subtract whole seconds first.
  const double stamp_s = toSeconds(stamp % kSecond) + static_cast<double>(stamp / kSecond);
  double shift_s = cloud.absolute_time ? -stamp_s : 0.0;
  if (!cloud.absolute_time && timing.stamp_marks == RecordOptions::ScanStamp::kEnd) {
    double last = 0.0;
    for (const double t : cloud.time_s) last = std::isfinite(t) ? std::max(last, t) : last;
    if (last > 0.0)
      shift_s = -last;  // offsets from the start: the last one is the stamp's; already negative ones stay
  }
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> times;
  times.reserve(cloud.time_s.size());
  for (const double t : cloud.time_s) {
    constexpr double kLongestScan = 1.0;  // s
    if (std::isfinite(t) && std::abs(t + shift_s) > kLongestScan) return {};
    times.push_back(std::isfinite(t) ? t + shift_s : kNone);
  }
  const bool any = std::any_of(times.begin(), times.end(), [](double t) { return std::isfinite(t); });
  return any ? times : std::vector<double>{};
}

bool isReturn(const LidarPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && (p.x != 0 || p.y != 0 || p.z != 0);
}

/// Column of point i, and what `ring` says about it.
struct Placer {
  const ScanLayout& layout;
  std::size_t columns;
  [[nodiscard]] std::size_t column(std::size_t i) const {
    switch (layout.order) {
      case ScanLayout::Order::kColumns:
        return i / kLasersHdl32;
      case ScanLayout::Order::kRows:
        return i % columns;
      default:
        return i;
    }
  }
  [[nodiscard]] std::uint16_t ring(std::size_t i) const {
    switch (layout.order) {
      case ScanLayout::Order::kColumns:
        return layout.ring[i % kLasersHdl32];
      case ScanLayout::Order::kRows:
        return layout.ring[i / columns];
      default:
        return 0;
    }
  }
};

std::string remarkOn(const PcdCloud& cloud, const ScanLayout& layout, bool own_time, bool rotating) {
  if (!cloud.time_s.empty() && !own_time) return "point times of the file are not believable, rebuilt";
  if (!rotating || (own_time && cloud.has_ring)) return "";
  if (layout.order == ScanLayout::Order::kRows) return "scans laser by laser";
  if (layout.order == ScanLayout::Order::kColumns) return "";
  return own_time ? "layout of scans unknown: ring 0"
                  : "layout of scans unknown: point time linear in the order of the file, ring 0";
}
}  // namespace

double usualRevolution(std::vector<Duration> intervals) {
  constexpr double kNominal = 0.1, kShortest = 0.05, kLongest = 0.2;  // s
  if (intervals.empty()) return kNominal;
  const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  const double seconds = toSeconds(*middle);
  return seconds >= kShortest && seconds <= kLongest ? seconds : kNominal;
}

double revolutionDuration(std::optional<Duration> interval, double usual_s) {
  if (!interval) return usual_s;
  const double seconds = toSeconds(*interval);
  return std::abs(seconds - usual_s) <= 0.05 * usual_s ? seconds : usual_s;
}

MadeSweep makeSweep(PcdCloud cloud, Stamp stamp, const std::string& frame, const SweepTiming& timing) {
  MadeSweep made;
  Sweep& sweep = made.sweep;
  sweep.stamp = stamp;
  sweep.frame = frame;
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (LidarPoint& point : cloud.points) {
    if (!isReturn(point)) point.x = point.y = point.z = kNaN;
  }
  const ScanLayout layout = timing.rotating ? findScanLayout(cloud.points) : ScanLayout{};
  const std::vector<double> own_time = fileTime(cloud, stamp, timing);
  made.remark = remarkOn(cloud, layout, !own_time.empty(), timing.rotating);
  sweep.points = std::move(cloud.points);
  const std::size_t size = sweep.points.size();
  const Placer place{layout, size / kLasersHdl32};
  const double steps =
      static_cast<double>(layout.order == ScanLayout::Order::kUnknown ? size : size / kLasersHdl32);
  const double offset = timing.stamp_marks == RecordOptions::ScanStamp::kEnd ? -timing.duration_s : 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    const double phase = static_cast<double>(place.column(i)) / steps;
    const bool own = !own_time.empty() && std::isfinite(own_time[i]);
    sweep.points[i].time = static_cast<float>(own ? own_time[i] : offset + timing.duration_s * phase);
    if (!cloud.has_ring) sweep.points[i].ring = place.ring(i);
  }
  return made;
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
