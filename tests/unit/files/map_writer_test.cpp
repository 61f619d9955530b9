// SPDX-License-Identifier: MIT
// The map of a long drive: what is held in memory follows the neighbourhood of the vehicle, and tiles that
// waited on disk come back unharmed.
#include "files/map_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "temporary_folder.hpp"

namespace atlas {
namespace {

constexpr float kSide_m = 42.0F;  // returns lie in a square of twice this around the vehicle
constexpr double kStep_m = 5.0;   // driven from sweep to sweep

/// A sweep of 200 returns around the vehicle, in one batch.
BatchedSweep seenFrom(const Eigen::Vector3d& place, std::mt19937& random) {
  std::uniform_real_distribution<float> side(-kSide_m, kSide_m);
  std::uniform_real_distribution<float> height(0.0F, 3.0F);
  auto sweep = std::make_shared<Sweep>();
  for (int i = 0; i < 200; ++i) {
    const float x = side(random), y = side(random);
    sweep->points.push_back({x, y, height(random), static_cast<float>(i), 0, 0, 0});
  }
  BatchedSweep batched;
  batched.sweep = sweep;
  batched.T_map_lidar.translation = place;
  batched.batches.push_back({0, 200, 0, batched.T_map_lidar});
  return batched;
}

struct Held {
  std::size_t tiles = 0, voxels = 0, spilled = 0;  ///< most at any time
};

/// Drives straight on and back again.
Held driveThereAndBack(MapWriter& writer, double length_m) {
  std::mt19937 random(7);
  Held held;
  const int there = static_cast<int>(length_m / kStep_m);
  for (int i = 0; i < 2 * there; ++i) {
    writer.add(seenFrom({kStep_m * std::min(i, 2 * there - i), 0, 0}, random));
    held.tiles = std::max(held.tiles, writer.tilesInMemory());
    held.voxels = std::max(held.voxels, writer.voxelsInMemory());
    held.spilled = std::max(held.spilled, writer.tilesOnDisk());
  }
  return held;
}

MapParams keeping(double keep_radius_m) {
  MapParams params;
  params.voxel_m = 0.5;
  params.keep_radius_m = keep_radius_m;
  return params;
}

Anchor anchor() { return {0, {49.2, 16.6, 250.0}}; }

TEST(MapWriter, MemoryFollowsTheNeighbourhoodNotTheLengthOfTheDrive) {
  const test::TemporaryFolder folder;
  MapWriter brief(folder / "short", keeping(100.0)), longer(folder / "long", keeping(100.0));
  const Held of_short = driveThereAndBack(brief, 500.0), of_long = driveThereAndBack(longer, 4000.0);
  // Tiles of 50 m that touch the circle of 100 m: at most 6 along and, as the vehicle stays at
  // y = 0, 4 across.
  EXPECT_LE(of_long.tiles, 24U);
  EXPECT_LE(of_long.tiles, of_short.tiles + 6) << "one more column where the short drive turns";
  // The same density of returns within the same tiles; each holds some thousand voxels, so 5 % is far off
  // chance.
  EXPECT_LT(static_cast<double>(of_long.voxels), 1.05 * static_cast<double>(of_short.voxels));
  EXPECT_GT(of_long.spilled, 8 * of_short.spilled) << "what is not held waits on disk";
}

TEST(MapWriter, TilesThatWaitedOnDiskMakeTheSameMap) {
  const test::TemporaryFolder folder;
  {
    MapWriter spilling(folder / "spilling", keeping(20.0)), holding(folder / "holding", keeping(1e6));
    (void)driveThereAndBack(spilling, 600.0);
    (void)driveThereAndBack(holding, 600.0);
    EXPECT_GT(spilling.spills(), 10U);
    EXPECT_EQ(holding.spills(), 0U);
    spilling.finish(anchor());
    holding.finish(anchor());
  }
  for (const char* file : {"map/map.pcd", "map/map.ply", "map/tiles.json", "map/tiles/3_0.pcd"}) {
    EXPECT_EQ(folder.read("spilling/" + std::string(file)), folder.read("holding/" + std::string(file)))
        << file;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "spilling/map/.waiting"));
  const auto index = nlohmann::json::parse(folder.read("spilling/map/tiles.json"));
  EXPECT_EQ(index["returns"], 2 * 120 * 200) << "every return is in the map";
}

}  // namespace
}  // namespace atlas
