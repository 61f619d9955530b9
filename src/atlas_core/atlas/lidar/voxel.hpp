// SPDX-License-Identifier: MIT
// Thinning of a cloud to one point per voxel, in the order of the input: the same points give the same cloud,
// always.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "atlas/lidar/voxel_index.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// The voxel that holds a point: floor(coordinate / edge). Nothing for NaN, infinity, or beyond 2^31 voxels
/// of the origin.
[[nodiscard]] inline std::optional<VoxelKey> voxelOf(double x, double y, double z, double edge_m) {
  constexpr double kMax = 2147483000.0;  // voxels; inside int32
  const double vx = x / edge_m, vy = y / edge_m, vz = z / edge_m;
  const auto fits = [](double value) { return value > -kMax && value < kMax; };  // false for NaN
  if (!fits(vx) || !fits(vy) || !fits(vz)) return std::nullopt;
  const auto floorToInt = [](double value) {  // std::floor is a library call on plain x86-64
    const auto truncated = static_cast<std::int32_t>(value);
    return truncated - (value < static_cast<double>(truncated) ? 1 : 0);
  };
  return VoxelKey{floorToInt(vx), floorToInt(vy), floorToInt(vz)};
}

/// Which point stands for a voxel.
enum class VoxelPoint {
  kFirst,    ///< the first one met, unchanged
  kCentroid  ///< mean position and intensity; time and ring of the first one
};

/// Takes points one by one, so that no cloud of all points is needed before.
class VoxelFilter {
 public:
  /// edge_m > 0, else std::invalid_argument.
  VoxelFilter(double edge_m, VoxelPoint keep, std::size_t expected = 0);
  /// Points that are not finite are left out.
  void add(const LidarPoint& point);
  /// One point per voxel, voxels in the order in which they were first met. Ends the filter's life.
  [[nodiscard]] std::vector<LidarPoint> take();

 private:
  /// Sums of what the points of a voxel differ from its first one: floats are enough for that.
  struct Sum {
    float x = 0, y = 0, z = 0, intensity = 0;
    std::uint32_t count = 1;
  };
  /// The voxel of the last point of a laser: the next one mostly lies in the same.
  struct Last {
    VoxelKey key;
    std::uint32_t voxel = VoxelIndex::kNone;
  };
  double edge_m_;
  VoxelPoint keep_;
  std::array<Last, 128> last_{};  ///< by ring, modulo
  VoxelIndex index_;
  std::vector<LidarPoint> points_;  ///< first of each voxel
  std::vector<Sum> sums_;           ///< kCentroid only
};

/// All at once.
[[nodiscard]] std::vector<LidarPoint> voxelFiltered(const std::vector<LidarPoint>& points, double edge_m,
                                                    VoxelPoint keep = VoxelPoint::kFirst);

}  // namespace atlas
