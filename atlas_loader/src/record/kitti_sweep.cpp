// SPDX-License-Identifier: MIT
#include "record/kitti_sweep.hpp"

#include <cmath>
#include <cstring>
#include <limits>

namespace atlas::record {
namespace {
constexpr double kTwoPi = 6.28318530717958647692;
constexpr int kTopRing = 63;

/// Counts how often the azimuth has started anew.
class AzimuthWraps {
 public:
  /// az in (-pi, pi].
  int next(double azimuth_rad) {
    constexpr double kJitter = 0.1;  // rad; neighbouring returns of a laser are 0.003 rad apart
    if (first_ && azimuth_rad < 0 && azimuth_rad > -kJitter) {  // the file begins just before azimuth 0
      first_ = false;
      last_ = azimuth_rad;
      return wraps_;
    }
    first_ = false;
    const double az = azimuth_rad < 0 ? azimuth_rad + kTwoPi : azimuth_rad;
    if (az < last_ - kJitter) ++wraps_;
    // A return just before azimuth 0 at the start of a laser is still of this laser.
    if (last_ < kJitter && az > kTwoPi - kJitter && wraps_ > 0) --wraps_;
    last_ = az;
    return wraps_;
  }

 private:
  double last_ = 0;
  int wraps_ = 0;
  bool first_ = true;
};
}  // namespace

std::optional<Sweep> parseKittiSweep(std::string_view bytes, const KittiSpin& spin) {
  constexpr std::size_t kRecord = 4 * sizeof(float);
  if (bytes.empty() || bytes.size() % kRecord != 0) return std::nullopt;
  Sweep sweep;
  sweep.stamp = spin.end();
  sweep.frame = "velodyne";
  sweep.points.resize(bytes.size() / kRecord);
  const double forward_s = toSeconds(spin.forward - sweep.stamp);
  AzimuthWraps wraps;
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    float v[4];
    std::memcpy(v, bytes.data() + i * kRecord, kRecord);
    LidarPoint& point = sweep.points[i];
    point.intensity = v[3];
    const bool measured =
        std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]) && (v[0] != 0 || v[1] != 0);
    if (!measured) {  // no direction, so no time either: it stays as a place holder at the end of the sweep
      point.x = point.y = point.z = kNaN;
      continue;
    }
    point.x = v[0], point.y = v[1], point.z = v[2];
    const double azimuth = std::atan2(static_cast<double>(v[1]), static_cast<double>(v[0]));
    point.time = static_cast<float>(forward_s - azimuth / kTwoPi * spin.period_s);
    point.ring = static_cast<std::uint16_t>(std::max(0, kTopRing - wraps.next(azimuth)));
  }
  return sweep;
}

}  // namespace atlas::record
