// SPDX-License-Identifier: MIT
// One square of the map: a mean for each voxel, in memory or in a file while nobody is near.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "atlas/camera/point_colours.hpp"
#include "atlas/lidar/voxel_index.hpp"
#include "atlas/output/pcd.hpp"

namespace atlas {

class MapTile {
 public:
  /// key: the voxel of the point; x, y, z: map, m.
  void add(const VoxelKey& key, double x, double y, double z, float intensity, double voxel_m);
  /// Tells some dozen points before that this voxel comes.
  void expect(const VoxelKey& key) const { index_.expect(key); }
  /// What a camera saw in a voxel, from `depth_m` away. A colour alone makes no point of the map.
  void addColour(const VoxelKey& key, const ColouredPoint& seen);
  /// All voxels with returns in order of (z, y, x), whatever the order in which they were met.
  [[nodiscard]] std::vector<MapPoint> points(double voxel_m) const;

  /// With returns.
  [[nodiscard]] std::size_t voxels() const { return voxels_; }
  [[nodiscard]] std::uint64_t returns() const { return returns_; }

  /// The tile exactly as it is; throws std::runtime_error when the system refuses or the file is damaged.
  void save(const std::filesystem::path& path) const;
  static MapTile load(const std::filesystem::path& path);

 private:
  /// Sums of the offsets from the voxel's lower corner. After kMaxSamples a mean does not gain any more and a
  /// float sum would begin to lose, so later returns are only counted.
  struct Sum {
    float x = 0, y = 0, z = 0, intensity = 0;
    std::uint32_t count = 0;
  };
  static constexpr std::uint32_t kMaxSamples = 4096;
  /// Weighted sums of whole numbers: their order has no influence. Full at kMaxWeight, before they overflow.
  struct Colour {
    std::uint32_t red = 0, green = 0, blue = 0, weight = 0;
    [[nodiscard]] std::uint32_t packed() const;
  };
  static constexpr std::uint32_t kMaxWeight = 1U << 24;

  std::uint32_t numberOf(const VoxelKey& key);

  CachedVoxelIndex index_;
  std::vector<Sum> sums_;
  std::vector<Colour> colours_;  ///< of the first voxels; the others have none
  std::size_t voxels_ = 0;
  std::uint64_t returns_ = 0;
};

}  // namespace atlas
