// SPDX-License-Identifier: MIT
// The map of all places visited: one mean point per voxel, in tiles. Tiles far from the vehicle wait in files
// and come back when they are seen again, so memory depends on the neighbourhood, not on the length of the
// drive.
//   map/tiles/<ix>_<iy>.pcd   tile with x in [ix, ix + 1) * tile_m, y likewise; points in order of (z, y, x)
//   of their voxel map/tiles.json            index: anchor (WGS84), tile and voxel size, counts map/map.pcd,
//   map/map.ply  all tiles in order of (ix, iy), when there are at most single_file_limit points
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <utility>

#include "atlas/sensor/products.hpp"
#include "files/map_tile.hpp"

namespace atlas {

struct MapParams {
  double voxel_m = 0.2;
  double tile_m = 50.0;  ///< a whole multiple of voxel_m
  double keep_radius_m =
      150.0;  ///< tiles farther from the vehicle are written to disk; more than the lidars see
  std::uint64_t single_file_limit = 25000000;  ///< points: 20 bytes each, with colour 24
  bool colour = false;                         ///< the files have colours
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const MapParams& params);

class MapWriter {
 public:
  /// out: the run's output folder.
  MapWriter(const std::filesystem::path& out, const MapParams& params);
  /// Removes what waits on disk; without finish() there is no map.
  ~MapWriter();
  MapWriter(const MapWriter&) = delete;
  MapWriter& operator=(const MapWriter&) = delete;

  /// All points of the sweep that are finite; nothing for a sweep without pose.
  void add(const BatchedSweep& batched);
  /// What a camera has seen.
  void add(const std::vector<ColouredPoint>& seen);
  /// Writes the files; replaces the map of an earlier run in the same folder.
  void finish(const Anchor& anchor);

  [[nodiscard]] std::size_t voxelsInMemory() const;
  [[nodiscard]] std::size_t tilesInMemory() const { return tiles_.size(); }
  [[nodiscard]] std::size_t tilesOnDisk() const { return spilled_.size(); }
  [[nodiscard]] std::uint64_t spills() const { return spills_; }

 private:
  using TileKey = std::pair<std::int32_t, std::int32_t>;
  struct Tile {
    MapTile content;
    std::uint64_t last_sweep = 0;  ///< number of the sweep that touched it last
  };
  struct Spilled {
    std::uint64_t voxels = 0, returns = 0;
  };
  Tile& tileAt(const TileKey& key);
  /// Calls visit(point, its voxel, the tile's content) for all that are finite.
  template <class Point, class Visit>
  void forEachVoxel(const std::vector<Point>& points, Visit&& visit);
  void spillFar(const Eigen::Vector3d& vehicle_map);
  [[nodiscard]] std::filesystem::path spillPath(const TileKey& key) const;
  [[nodiscard]] std::map<TileKey, Spilled> index() const;
  void removeOldMap() const;

  std::filesystem::path folder_;
  MapParams params_;
  std::int32_t voxels_per_tile_;
  std::map<TileKey, Tile> tiles_;
  std::map<TileKey, Spilled> spilled_;
  std::uint64_t sweeps_ = 0, spills_ = 0;
};

}  // namespace atlas
