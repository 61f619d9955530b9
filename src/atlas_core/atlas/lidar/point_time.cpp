// SPDX-License-Identifier: MIT
#include "atlas/lidar/point_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace atlas {
namespace {

constexpr double kTurn = 2.0 * M_PI;

struct TimeUnit {
  double seconds = 1.0;
  bool absolute = false;
};

TimeUnit unitOf(const std::vector<double>& raw, Stamp stamp) {
  constexpr double kMax = std::numeric_limits<double>::max();
  double smallest = kMax, largest = -kMax;
  for (const double value : raw) {
    if (!std::isfinite(value)) continue;
    smallest = std::min(smallest, value);
    largest = std::max(largest, value);
  }
  if (smallest > largest) return {};
  const double stamp_s = toSeconds(stamp);
  if (stamp_s > 2.0 && smallest >= stamp_s - 1.0 && largest <= stamp_s + 1.0) return {1.0, true};
  const double size = std::max(std::abs(smallest), std::abs(largest));
  if (size > 1e9) return {size < 1e11 ? 1.0 : size < 1e14 ? 1e-3 : size < 1e17 ? 1e-6 : 1e-9, true};
  return {size <= 1.0 ? 1.0 : size <= 1e3 ? 1e-3 : size <= 1e6 ? 1e-6 : 1e-9, false};
}

bool isReturn(const LidarPoint& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && (p.x != 0.0F || p.y != 0.0F);
}

/// Azimuth of each point since the first return, unwrapped; points without a return repeat the one before.
std::vector<double> unwrappedAzimuths(const std::vector<LidarPoint>& points) {
  std::vector<double> result(points.size(), 0.0);
  double sum = 0.0, last = 0.0;
  bool begun = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (isReturn(points[i])) {
      const double azimuth = std::atan2(static_cast<double>(points[i].y), static_cast<double>(points[i].x));
      if (begun) sum += std::remainder(azimuth - last, kTurn);
      last = azimuth;
      begun = true;
    }
    result[i] = sum;
  }
  return result;
}

void timesByOrder(std::vector<LidarPoint>& points, double turn_s) {
  const auto count = static_cast<double>(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i].time = static_cast<float>(turn_s * (static_cast<double>(i + 1) / count - 1.0));
}

void timesByAzimuth(std::vector<LidarPoint>& points, const std::vector<double>& azimuths, double turn_s) {
  const double end = std::abs(azimuths.back());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double before_end_s = (end - std::copysign(1.0, azimuths.back()) * azimuths[i]) / kTurn * turn_s;
    points[i].time = static_cast<float>(std::clamp(-before_end_s, -turn_s, 0.0));
  }
}

void timesByLaser(std::vector<LidarPoint>& points, double turn_s) {
  double time_s = -turn_s;
  for (LidarPoint& p : points) {
    if (isReturn(p)) {
      const double azimuth = std::atan2(static_cast<double>(p.y), static_cast<double>(p.x));
      time_s = -turn_s * (0.5 + azimuth / kTurn);  // pi, the rear: begin; -pi: end
    }
    p.time = static_cast<float>(time_s);
  }
}

}  // namespace

std::vector<float> relativeTimes(const std::vector<double>& raw, bool whole_numbers, Stamp stamp) {
  const TimeUnit unit = whole_numbers ? TimeUnit{1e-9, false} : unitOf(raw, stamp);
  const double zero = unit.absolute ? static_cast<double>(stamp) * 1e-9 / unit.seconds : 0.0;
  std::vector<float> result;
  result.reserve(raw.size());
  for (const double value : raw) result.push_back(static_cast<float>((value - zero) * unit.seconds));
  return result;
}

const char* toString(TimeOrigin origin) {
  switch (origin) {
    case TimeOrigin::kAzimuth:
      return "azimuth, column by column";
    case TimeOrigin::kLasers:
      return "azimuth, laser by laser";
    case TimeOrigin::kOrder:
      break;
  }
  return "order";
}

TimeOrigin rebuildTimes(std::vector<LidarPoint>& points, double turn_s) {
  if (points.empty()) return TimeOrigin::kOrder;
  const std::vector<double> azimuths = unwrappedAzimuths(points);
  const double turns = std::abs(azimuths.back()) / kTurn;
  if (turns > 0.5 && turns < 1.5) {
    timesByAzimuth(points, azimuths, turn_s);
    return TimeOrigin::kAzimuth;
  }
  if (turns >= 3.0) {
    timesByLaser(points, turn_s);
    return TimeOrigin::kLasers;
  }
  timesByOrder(points, turn_s);
  return TimeOrigin::kOrder;
}

ScanStamp scanStampNamed(const std::string& name) {
  if (name == "recorded") return ScanStamp::kRecorded;
  if (name == "start") return ScanStamp::kStart;
  if (name == "end") return ScanStamp::kEnd;
  throw std::invalid_argument("scan_stamp must be recorded, start or end, got " + name);
}

SweepPtr withStampAt(const SweepPtr& sweep, ScanStamp marks) {
  if (marks == ScanStamp::kRecorded) return sweep;
  constexpr float kMax = std::numeric_limits<float>::max();
  float first_s = kMax, last_s = -kMax;
  for (const LidarPoint& p : sweep->points) {
    if (!std::isfinite(p.time)) continue;
    first_s = std::min(first_s, p.time);
    last_s = std::max(last_s, p.time);
  }
  if (first_s > last_s) return sweep;
  const float moment_s = marks == ScanStamp::kStart ? first_s : last_s;
  if (moment_s == 0.0F) return sweep;
  auto shifted = std::make_shared<Sweep>(*sweep);
  for (LidarPoint& p : shifted->points) p.time -= moment_s;
  return shifted;
}

}  // namespace atlas
