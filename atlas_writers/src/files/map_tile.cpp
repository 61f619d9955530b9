// SPDX-License-Identifier: MIT
#include "files/map_tile.hpp"

#include <algorithm>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <type_traits>

#include "files/output_file.hpp"

namespace atlas {

void MapTile::add(const VoxelKey& key, double x, double y, double z, float intensity, double voxel_m) {
  const std::uint32_t voxel = index_.insert(key);
  if (voxel == sums_.size()) sums_.emplace_back();
  Sum& sum = sums_[voxel];
  ++returns_;
  if (sum.count < kMaxSamples) {
    sum.x += static_cast<float>(x - key.x * voxel_m);
    sum.y += static_cast<float>(y - key.y * voxel_m);
    sum.z += static_cast<float>(z - key.z * voxel_m);
    sum.intensity += intensity;
  }
  ++sum.count;
}

std::vector<MapPoint> MapTile::points(double voxel_m) const {
  const std::vector<VoxelKey>& keys = index_.keys();
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tie(keys[a].z, keys[a].y, keys[a].x) < std::tie(keys[b].z, keys[b].y, keys[b].x);
  });
  std::vector<MapPoint> result;
  result.reserve(keys.size());
  for (const std::uint32_t i : order) {
    const Sum& sum = sums_[i];
    const double samples = std::min(sum.count, kMaxSamples);
    const auto mean = [&](std::int32_t corner, float offsets) {
      return static_cast<float>(corner * voxel_m + static_cast<double>(offsets) / samples);
    };
    result.push_back({mean(keys[i].x, sum.x), mean(keys[i].y, sum.y), mean(keys[i].z, sum.z),
                      static_cast<float>(static_cast<double>(sum.intensity) / samples), sum.count});
  }
  return result;
}

void MapTile::save(const std::filesystem::path& path) const {
  static_assert(std::is_trivially_copyable_v<VoxelKey> && std::is_trivially_copyable_v<Sum>);
  OutputFile file(path);
  const std::uint64_t voxels = sums_.size();
  file.write(&voxels, sizeof voxels);
  file.write(&returns_, sizeof returns_);
  file.write(index_.keys().data(), voxels * sizeof(VoxelKey));
  file.write(sums_.data(), voxels * sizeof(Sum));
  file.commit();
}

MapTile MapTile::load(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const auto read = [&](void* data, std::uint64_t bytes) {
    if (!file.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes))) {
      throw std::runtime_error("cannot read back " + path.string());
    }
  };
  std::uint64_t voxels = 0;
  MapTile tile;
  read(&voxels, sizeof voxels);
  read(&tile.returns_, sizeof tile.returns_);
  if (voxels * (sizeof(VoxelKey) + sizeof(Sum)) + 2 * sizeof voxels != std::filesystem::file_size(path)) {
    throw std::runtime_error("damaged: " + path.string());
  }
  std::vector<VoxelKey> keys(voxels);
  read(keys.data(), voxels * sizeof(VoxelKey));
  tile.sums_.resize(voxels);
  read(tile.sums_.data(), voxels * sizeof(Sum));
  tile.index_ = VoxelIndex(voxels);
  for (const VoxelKey& key : keys) tile.index_.insert(key);
  return tile;
}

}  // namespace atlas
