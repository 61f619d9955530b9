// SPDX-License-Identifier: MIT
// A street that is known: flat road with two painted stripes along it, a wall on the left and one across it.
#include "atlas/lidar/line_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace atlas {
namespace {

constexpr double kHeight_m = 1.8;  // of the lidar above the road
constexpr double kLeftWall_m = 9.0, kEndWall_m = 25.0;
constexpr double kStripes_m[] = {2.0, -1.5};  // lower edge in y
constexpr double kStripe_m = 0.15;
constexpr float kRoad = 12.0F, kPaint = 60.0F, kWall = 30.0F;
constexpr double kGlitter = 5.0;  // standard deviation of the road's brightness: rough asphalt
const Pose kPlace{fromRollPitchYaw({0.0, 0.0, 0.5}), Eigen::Vector3d(400.0, -300.0, 250.0)};

bool painted(double y) {
  return std::any_of(std::begin(kStripes_m), std::end(kStripes_m),
                     [y](double edge) { return y >= edge && y <= edge + kStripe_m; });
}

/// 24 lasers from -24 to +6.7 degrees, 0.1 degrees from column to column, column by column, 2 cm range noise.
BatchedSweep seeStreet() {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 0.02);
  auto sweep = std::make_shared<Sweep>();
  for (int column = 0; column < 3600; ++column) {
    for (int laser = 0; laser < 24; ++laser) {
      const double azimuth = -2 * M_PI * column / 3600, up = (-24.0 + 4.0 / 3.0 * laser) * M_PI / 180;
      const Eigen::Vector3d beam(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth),
                                 std::sin(up));
      double range_m = beam.z() < 0 ? kHeight_m / -beam.z() : 1e9;
      const float road = std::max(0.0F, kRoad + static_cast<float>(kGlitter / 0.02 * noise(random)));
      float intensity = painted(range_m * beam.y()) ? kPaint : road;
      for (const double wall_m : {kLeftWall_m / beam.y(), kEndWall_m / beam.x()}) {
        if (wall_m > 0 && wall_m < range_m) range_m = wall_m, intensity = kWall;
      }
      LidarPoint p;
      const Eigen::Vector3f place = ((range_m + noise(random)) * beam).cast<float>();
      p.x = range_m < 100 ? place.x() : NAN, p.y = place.y(), p.z = place.z();
      p.intensity = intensity;
      p.time = static_cast<float>(0.1 * column / 3600);
      p.ring = static_cast<std::uint16_t>(laser);
      sweep->points.push_back(p);
    }
  }
  BatchedSweep batched;
  batched.stamp = 7;
  batched.frame = "lidar_left";
  batched.sweep = sweep;
  batched.T_map_lidar = kPlace;
  batched.batches.push_back({0, static_cast<std::uint32_t>(sweep->points.size()), 7, kPlace});
  return batched;
}

/// In the lidar's frame.
std::pair<Eigen::Vector3d, Eigen::Vector3d> ends(const Line& line) {
  return {kPlace.inverse() * line.from, kPlace.inverse() * line.to};
}

TEST(LineStage, WallsAreWhereTheyAre) {
  const Lines found = findLines(seeStreet(), {});
  EXPECT_EQ(found.stamp, 7);
  EXPECT_EQ(found.frame, "lidar_left");
  int left = 0, across = 0;
  for (const Line& line : found.lines) {
    if (line.kind != LineKind::kSurface || line.points < 50) continue;
    const auto [a, b] = ends(line);
    // The mean of 50 returns of 2 cm noise: 3 mm; its ends with the slope: twice that, five times for
    // certainty.
    const bool is_left = std::abs(a.y() - kLeftWall_m) < 0.03 && std::abs(b.y() - kLeftWall_m) < 0.03;
    const bool is_across = std::abs(a.x() - kEndWall_m) < 0.03 && std::abs(b.x() - kEndWall_m) < 0.03;
    EXPECT_TRUE(is_left || is_across) << a.transpose() << " to " << b.transpose();
    left += is_left;
    across += is_across;
  }
  EXPECT_GE(left, 8) << "lasers that meet it above the ground, each once or more";
  EXPECT_GE(across, 3);
}

TEST(LineStage, MarkingsAreTheStripesAndNothingElse) {
  const Lines found = findLines(seeStreet(), {});
  int crossings[2] = {0, 0};
  for (const Line& line : found.lines) {
    if (line.kind != LineKind::kMarking) continue;
    const auto [a, b] = ends(line);
    const double y = 0.5 * (a.y() + b.y());
    const int stripe = y > 0 ? 0 : 1;
    EXPECT_NEAR(y, kStripes_m[stripe] + kStripe_m / 2, kStripe_m / 2 + 0.06)
        << "range noise moves it, three sigma";
    EXPECT_NEAR(a.z(), -kHeight_m, 0.08);
    EXPECT_FLOAT_EQ(static_cast<float>(line.intensity), kPaint);
    ++crossings[stripe];
  }
  // Lasers that meet the road within 25 m, ahead and behind: 15. Far out a stripe is narrower than two
  // columns.
  EXPECT_GE(crossings[0], 12);
  EXPECT_GE(crossings[1], 12);
}

TEST(LineStage, TheSameWhateverTheOrderOfLasersInTheSweep) {
  const BatchedSweep by_column = seeStreet();
  auto sorted = std::make_shared<Sweep>(*by_column.sweep);  // laser by laser, as KITTI
  std::stable_sort(sorted->points.begin(), sorted->points.end(),
                   [](const LidarPoint& a, const LidarPoint& b) { return a.ring > b.ring; });
  BatchedSweep by_laser = by_column;
  by_laser.sweep = sorted;
  const Lines a = findLines(by_column, {}), b = findLines(by_laser, {});
  ASSERT_EQ(a.lines.size(), b.lines.size());
  ASSERT_GT(a.lines.size(), 50U);
  for (std::size_t i = 0; i < a.lines.size(); ++i) {
    EXPECT_EQ(a.lines[i].from, b.lines[i].from);
    EXPECT_EQ(a.lines[i].to, b.lines[i].to);
    EXPECT_EQ(a.lines[i].kind, b.lines[i].kind);
  }
}

TEST(LineStage, AnswersEverySweep) {
  LineStage stage{LineParams{}};
  std::vector<std::size_t> answered;
  stage.on_lines = [&](std::size_t lidar, const Lines& lines) {
    answered.push_back(lidar);
    EXPECT_EQ(lines.lines.empty(), lidar == 1);
  };
  auto seen = std::make_shared<BatchedSweep>(seeStreet()),
       no_pose = std::make_shared<BatchedSweep>(seeStreet());
  no_pose->stamp = 5;
  no_pose->batches.clear();
  stage.push(0, seen);
  stage.push(1, no_pose);
  stage.finish(0);
  stage.finish(1);
  EXPECT_EQ(answered, (std::vector<std::size_t>{1, 0})) << "in order of their stamps";
  EXPECT_TRUE(stage.ended());
}

TEST(LineStage, RefusesParametersByName) {
  LineParams params;
  params.marking_contrast = 1.0;
  try {
    validate(params);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("marking_contrast"), std::string::npos);
  }
  params = {};
  params.lidars.clear();
  EXPECT_THROW(validate(params), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
