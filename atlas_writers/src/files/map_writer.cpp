// SPDX-License-Identifier: MIT
#include "files/map_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "atlas/lidar/batched_points.hpp"
#include "atlas/lidar/voxel.hpp"
#include "atlas/output/ply.hpp"
#include "files/output_file.hpp"

namespace atlas {
namespace {

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("map_writer: " + what + ", got " + std::to_string(value));
}

std::int32_t floorDiv(std::int32_t a, std::int32_t b) { return a / b - (a % b < 0 ? 1 : 0); }

std::string tileName(const std::pair<std::int32_t, std::int32_t>& key) {
  return std::to_string(key.first) + "_" + std::to_string(key.second);
}

/// Distance of a value from the interval [low, high].
double outside(double value, double low, double high) { return std::max({0.0, low - value, value - high}); }

std::int32_t voxelsPerTile(const MapParams& params) {
  validate(params);
  return static_cast<std::int32_t>(std::llround(params.tile_m / params.voxel_m));
}

}  // namespace

void validate(const MapParams& params) {
  need(params.voxel_m >= 0.01 && params.voxel_m <= 100.0, "voxel_m must lie in [0.01, 100]", params.voxel_m);
  need(params.tile_m >= params.voxel_m && params.tile_m <= 10000.0, "tile_m must lie in [voxel_m, 10000]",
       params.tile_m);
  const double ratio = params.tile_m / params.voxel_m;
  need(std::abs(ratio - std::round(ratio)) < 1e-6, "tile_m must be a whole multiple of voxel_m",
       params.tile_m);
  need(params.keep_radius_m > 0.0, "keep_radius_m must be positive", params.keep_radius_m);
}

MapWriter::MapWriter(const std::filesystem::path& out, const MapParams& params)
    : folder_(out / "map"), params_(params), voxels_per_tile_(voxelsPerTile(params)) {
  ensureFolder(folder_);
}

MapWriter::~MapWriter() {
  std::error_code ignored;  // nothing useful can be done about it here
  std::filesystem::remove_all(folder_ / ".waiting", ignored);
}

std::filesystem::path MapWriter::spillPath(const TileKey& key) const {
  return folder_ / ".waiting" / tileName(key);
}

MapWriter::Tile& MapWriter::tileAt(const TileKey& key) {
  Tile& tile = tiles_[key];
  const auto waiting = spilled_.find(key);
  if (waiting != spilled_.end()) {
    tile.content = MapTile::load(spillPath(key));
    spilled_.erase(waiting);
  }
  tile.last_sweep = sweeps_;
  return tile;
}

template <class Point, class Visit>
void MapWriter::forEachVoxel(const std::vector<Point>& points, Visit&& visit) {
  constexpr std::size_t kAhead = 64;  // points whose voxels are fetched while others are worked on
  std::array<std::optional<VoxelKey>, kAhead> voxels;
  std::optional<TileKey> key;
  Tile* tile = nullptr;  // of the point before: neighbours in a sweep are neighbours in space
  for (std::size_t first = 0; first < points.size(); first += kAhead) {
    const std::size_t count = std::min(kAhead, points.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const Point& p = points[first + i];
      voxels[i] = voxelOf(p.x, p.y, p.z, params_.voxel_m);
      if (tile != nullptr && voxels[i])
        tile->content.expect(*voxels[i]);  // a guess: most lie in the same tile
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::optional<VoxelKey>& voxel = voxels[i];
      if (!voxel) continue;
      const TileKey tile_key{floorDiv(voxel->x, voxels_per_tile_), floorDiv(voxel->y, voxels_per_tile_)};
      if (!key || *key != tile_key) {
        key = tile_key;
        tile = &tileAt(tile_key);
      }
      visit(points[first + i], *voxel, tile->content);
    }
  }
}

void MapWriter::add(const std::vector<ColouredPoint>& seen) {
  forEachVoxel(
      seen, [](const ColouredPoint& p, const VoxelKey& voxel, MapTile& tile) { tile.addColour(voxel, p); });
}

void MapWriter::add(const BatchedSweep& batched) {
  if (batched.batches.empty()) return;
  ++sweeps_;
  forEachVoxel(inMap(batched).points, [this](const LidarPoint& p, const VoxelKey& voxel, MapTile& tile) {
    tile.add(voxel, p.x, p.y, p.z, p.intensity, params_.voxel_m);
  });
  spillFar(batched.T_map_lidar.translation);
}

void MapWriter::spillFar(const Eigen::Vector3d& vehicle_map) {
  for (auto it = tiles_.begin(); it != tiles_.end();) {
    const auto& [ix, iy] = it->first;
    const double dx = outside(vehicle_map.x(), ix * params_.tile_m, (ix + 1.0) * params_.tile_m);
    const double dy = outside(vehicle_map.y(), iy * params_.tile_m, (iy + 1.0) * params_.tile_m);
    if (it->second.last_sweep == sweeps_ ||
        dx * dx + dy * dy <= params_.keep_radius_m * params_.keep_radius_m) {
      ++it;
      continue;
    }
    const MapTile& content = it->second.content;
    content.save(spillPath(it->first));
    spilled_[it->first] = {content.voxels(), content.returns()};
    ++spills_;
    it = tiles_.erase(it);
  }
}

std::map<MapWriter::TileKey, MapWriter::Spilled> MapWriter::index() const {
  std::map<TileKey, Spilled> all = spilled_;
  for (const auto& [key, tile] : tiles_) all[key] = {tile.content.voxels(), tile.content.returns()};
  return all;
}

void MapWriter::removeOldMap() const {
  std::error_code ignored;  // absent is fine; anything else fails when the new file is written
  for (const char* name : {"map.pcd", "map.ply", "tiles.json"})
    std::filesystem::remove(folder_ / name, ignored);
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "tiles", ignored)) {
    if (entry.path().extension() == ".pcd") std::filesystem::remove(entry.path(), ignored);
  }
}

void MapWriter::finish(const Anchor& anchor) {
  removeOldMap();
  const std::map<TileKey, Spilled> tiles = index();
  std::uint64_t points = 0, returns = 0;
  for (const auto& [key, tile] : tiles) {
    points += tile.voxels;
    returns += tile.returns;
  }
  nlohmann::ordered_json json = {{"frame", "map"},
                                 {"anchor",
                                  {{"latitude", anchor.position.latitude_deg},
                                   {"longitude", anchor.position.longitude_deg},
                                   {"altitude", anchor.position.altitude_m}}},
                                 {"tile_m", params_.tile_m},
                                 {"voxel_m", params_.voxel_m},
                                 {"points", points},
                                 {"returns", returns},
                                 {"tiles", nlohmann::ordered_json::array()}};
  std::optional<OutputFile> pcd, ply;
  if (points <= params_.single_file_limit) {
    pcd.emplace(folder_ / "map.pcd").write(mapPcdHeader(points, params_.colour));
    ply.emplace(folder_ / "map.ply").write(mapPlyHeader(points, params_.colour));
  }
  std::uint64_t coloured = 0;
  for (const auto& [key, tile] : tiles) {
    if (tile.voxels == 0) continue;  // seen by a camera alone
    const auto held = tiles_.find(key);
    const std::vector<MapPoint> content = held != tiles_.end()
                                              ? held->second.content.points(params_.voxel_m)
                                              : MapTile::load(spillPath(key)).points(params_.voxel_m);
    const std::string file = "tiles/" + tileName(key) + ".pcd";
    const std::string records = mapRecords(content, params_.colour);
    writeFile(folder_ / file, mapPcdHeader(content.size(), params_.colour).append(records));
    if (pcd) pcd->write(records);
    if (ply) ply->write(records);
    for (const MapPoint& point : content) coloured += point.colour != 0 ? 1 : 0;
    json["tiles"].push_back({{"file", file},
                             {"ix", key.first},
                             {"iy", key.second},
                             {"points", tile.voxels},
                             {"returns", tile.returns}});
  }
  if (pcd) pcd->commit();
  if (ply) ply->commit();
  if (params_.colour) json["coloured"] = coloured;
  writeFile(folder_ / "tiles.json", json.dump(1) + "\n");
  std::error_code ignored;
  std::filesystem::remove_all(folder_ / ".waiting", ignored);
  tiles_.clear();
  spilled_.clear();
}

std::size_t MapWriter::voxelsInMemory() const {
  std::size_t sum = 0;
  for (const auto& [key, tile] : tiles_) sum += tile.content.voxels();
  return sum;
}

}  // namespace atlas
