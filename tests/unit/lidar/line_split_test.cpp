// SPDX-License-Identifier: MIT
// A chain along known walls, far from the origin of the map, with the noise of a lidar.
#include "atlas/lidar/line_split.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

namespace atlas {
namespace {

using Chain = std::vector<Eigen::Vector3d>;
const Eigen::Vector3d kFarAway(3000.0, -2000.0, 200.0);

/// Appends `count` points from `from` to `to`, without the last, with normal noise across.
void addWall(Chain& chain, const Eigen::Vector3d& from, const Eigen::Vector3d& to, int count, double noise_m,
             std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, noise_m);
  const Eigen::Vector3d across = (to - from).cross(Eigen::Vector3d::UnitZ()).normalized();
  for (int i = 0; i < count; ++i)
    chain.push_back(kFarAway + from + (to - from) * i / count + across * noise(random));
}

TEST(LineSplit, FindsTheWallsAndTheirCorners) {
  std::mt19937 random(4);
  const Eigen::Vector3d a(0, 0, 1), b(6, 0, 1), c(6, 4, 1), d(9, 7, 1);
  Chain chain;
  addWall(chain, a, b, 120, 0.02, random);
  addWall(chain, b, c, 80, 0.02, random);
  addWall(chain, c, d, 85, 0.02, random);
  const std::vector<ChainLine> lines = splitIntoLines(chain, 10, 0.04);
  ASSERT_EQ(lines.size(), 3U);
  const Eigen::Vector3d corners[] = {a, b, c, d};
  for (std::size_t i = 0; i < 3; ++i) {
    // Points are 5 cm apart and off by 2 cm, and the border may be wrong by one or two of them.
    EXPECT_LT((lines[i].from - kFarAway - corners[i]).norm(), 0.12) << i;
    EXPECT_LT((lines[i].to - kFarAway - corners[i + 1]).norm(), 0.12) << i;
    EXPECT_NEAR(lines[i].rms_m, 0.02, 0.005) << "80 points: known to 8 %";
  }
  EXPECT_EQ(lines[0].first, 0U);
  EXPECT_EQ(lines[2].end, chain.size());
  EXPECT_EQ(lines[0].end, lines[1].first);
}

TEST(LineSplit, CutsAnArcIntoChords) {
  Chain chain;
  for (int i = 0; i < 400; ++i) {  // a quarter of a circle of 10 m
    const double angle = M_PI / 2 * i / 400;
    chain.emplace_back(10 * std::cos(angle), 10 * std::sin(angle), 0);
  }
  const std::vector<ChainLine> lines = splitIntoLines(chain, 10, 0.04);
  // A chord of length l lies up to l^2 / 8 r off the arc, with an RMS of 0.30 of that from its best line: 3.3
  // m reach 0.04 m.
  EXPECT_GE(lines.size(), 5U);
  EXPECT_LE(lines.size(), 8U);
  for (const ChainLine& line : lines) EXPECT_LE(line.rms_m, 0.04);
}

TEST(LineSplit, NoPieceIsWorseThanAllowedAlsoAfterSharingPoints) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0.0, 0.03);
  Chain chain;
  for (int i = 0; i < 4000; ++i) {  // ten times around: where chords end is chance
    const double angle = M_PI / 2 * i / 100, radius_m = 10 + noise(random);
    chain.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle), 0);
  }
  const std::vector<ChainLine> lines = splitIntoLines(chain, 10, 0.04);
  EXPECT_GE(lines.size(), 100U);
  for (const ChainLine& line : lines) EXPECT_LE(line.rms_m, 0.04);
}

TEST(LineSplit, FindsNothingInHedgesAndShortChains) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> off(-0.5, 0.5);
  Chain hedge;
  for (int i = 0; i < 200; ++i) hedge.emplace_back(0.05 * i, off(random), off(random));
  EXPECT_TRUE(splitIntoLines(hedge, 10, 0.04).empty());
  EXPECT_TRUE(splitIntoLines({}, 10, 0.04).empty());
  EXPECT_TRUE(splitIntoLines(Chain(9, Eigen::Vector3d::Zero()), 10, 0.04).empty());
}

}  // namespace
}  // namespace atlas
