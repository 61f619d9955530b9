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

namespace {

/// The nearer, the more pixels a voxel fills and the less a wrong pose matters: by the square of the depth.
std::uint32_t weightAt(float depth_m) {
  constexpr float kFull = 255.0F, kFullUntil_m = 4.0F;
  const float ratio = kFullUntil_m / std::max(depth_m, kFullUntil_m);
  return static_cast<std::uint32_t>(std::max(1.0F, kFull * ratio * ratio));
}

}  // namespace

std::uint32_t MapTile::numberOf(const VoxelKey& key) {
  const std::uint32_t voxel = index_.insert(key);
  if (voxel == sums_.size()) sums_.emplace_back();
  return voxel;
}

std::uint32_t MapTile::Colour::packed() const {
  if (weight == 0) return 0;
  const auto mean = [this](std::uint32_t sum) {
    return static_cast<std::uint32_t>((std::uint64_t{sum} + weight / 2) / weight);
  };
  return 0xFF000000U | mean(red) << 16U | mean(green) << 8U | mean(blue);
}

void MapTile::addColour(const VoxelKey& key, const ColouredPoint& seen) {
  const std::uint32_t voxel = numberOf(key);
  if (voxel >= colours_.size()) colours_.resize(sums_.size());
  Colour& colour = colours_[voxel];
  const std::uint32_t weight = std::min(weightAt(seen.depth_m), kMaxWeight - colour.weight);
  colour.red += weight * seen.red;
  colour.green += weight * seen.green;
  colour.blue += weight * seen.blue;
  colour.weight += weight;
}

void MapTile::add(const VoxelKey& key, double x, double y, double z, float intensity, double voxel_m) {
  Sum& sum = sums_[numberOf(key)];
  ++returns_;
  if (sum.count == 0) ++voxels_;
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
  result.reserve(voxels_);
  for (const std::uint32_t i : order) {
    const Sum& sum = sums_[i];
    if (sum.count == 0) continue;
    const double samples = std::min(sum.count, kMaxSamples);
    const auto mean = [&](std::int32_t corner, float offsets) {
      return static_cast<float>(corner * voxel_m + static_cast<double>(offsets) / samples);
    };
    result.push_back({mean(keys[i].x, sum.x), mean(keys[i].y, sum.y), mean(keys[i].z, sum.z),
                      static_cast<float>(static_cast<double>(sum.intensity) / samples), sum.count,
                      i < colours_.size() ? colours_[i].packed() : 0});
  }
  return result;
}

void MapTile::save(const std::filesystem::path& path) const {
  static_assert(std::is_trivially_copyable_v<VoxelKey> && std::is_trivially_copyable_v<Sum> &&
                std::is_trivially_copyable_v<Colour>);
  OutputFile file(path);
  const std::uint64_t counts[] = {sums_.size(), colours_.size(), voxels_, returns_};
  file.write(counts, sizeof counts);
  file.write(index_.keys().data(), sums_.size() * sizeof(VoxelKey));
  file.write(sums_.data(), sums_.size() * sizeof(Sum));
  file.write(colours_.data(), colours_.size() * sizeof(Colour));
  file.commit();
}

MapTile MapTile::load(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const auto read = [&](void* data, std::uint64_t bytes) {
    if (!file.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes))) {
      throw std::runtime_error("cannot read back " + path.string());
    }
  };
  std::uint64_t counts[4] = {};
  read(counts, sizeof counts);
  const auto [voxels, colours, with_returns, returns] = counts;
  if (voxels * (sizeof(VoxelKey) + sizeof(Sum)) + colours * sizeof(Colour) + sizeof counts !=
      std::filesystem::file_size(path)) {
    throw std::runtime_error("damaged: " + path.string());
  }
  MapTile tile;
  tile.voxels_ = with_returns;
  tile.returns_ = returns;
  std::vector<VoxelKey> keys(voxels);
  read(keys.data(), voxels * sizeof(VoxelKey));
  tile.sums_.resize(voxels);
  read(tile.sums_.data(), voxels * sizeof(Sum));
  tile.colours_.resize(colours);
  read(tile.colours_.data(), colours * sizeof(Colour));
  tile.index_ = CachedVoxelIndex(voxels);
  for (const VoxelKey& key : keys) tile.index_.insert(key);
  return tile;
}

}  // namespace atlas
