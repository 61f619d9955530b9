// SPDX-License-Identifier: MIT
// Known noise on planes gives known thickness; wrong times of a moving lidar make the map worse.
#include "atlas/lidar/map_quality.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "atlas/lidar/deskew_trial.hpp"
#include "moving_lidar.hpp"

namespace atlas {
namespace {

/// A tilted square of 6 m with normal noise across it, 400 points per square metre.
std::vector<LidarPoint> noisyPlane(double noise_m, const Pose& T, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-3.0, 3.0);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::vector<LidarPoint> points;
  for (int i = 0; i < 14400; ++i) {
    const double x = place(random), y = place(random);
    const Eigen::Vector3f p = (T * Eigen::Vector3d(x, y, noise_m * noise(random))).cast<float>();
    points.push_back({p.x(), p.y(), p.z(), 0, 0, 0, 0});
  }
  return points;
}

/// A sweep of 0.1 s from the stamp on in a square room of 60 m that stands still. Each begins in another
/// direction: otherwise all would be wrong in the same way, which no measure of sharpness can see.
SweepPtr seeRoom(const test::Drive& drive, double stamp_s, int count) {
  const Trajectory truth = drive.trajectory(stamp_s - 0.1, stamp_s + 0.3);
  auto sweep = std::make_shared<Sweep>();
  sweep->stamp = test::at(stamp_s);
  for (int i = 0; i < count; ++i) {
    const double azimuth = 2.0 * stamp_s - 2.0 * M_PI * i / count, time_s = 0.1 * i / count;
    const double toWall_m = 30.0 / std::max(std::abs(std::cos(azimuth)), std::abs(std::sin(azimuth)));
    const Eigen::Vector3d p_map(toWall_m * std::cos(azimuth), toWall_m * std::sin(azimuth), 0.1 * (i % 32));
    const Eigen::Vector3d p =
        (*truth.at(sweep->stamp + fromSeconds(time_s)) * drive.T_imu_lidar).inverse() * p_map;
    sweep->points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()),
                             0, static_cast<float>(time_s), static_cast<std::uint16_t>(i % 32), 0});
  }
  return sweep;
}

const Pose kTilted{fromRollPitchYaw({0.4, -0.7, 1.1}), Eigen::Vector3d(100, -50, 7)};

TEST(MapQuality, ThicknessOfAPlaneIsItsNoise) {
  for (const double noise_m : {0.005, 0.02, 0.04}) {
    const MapQuality quality = mapQuality(noisyPlane(noise_m, kTilted), {});
    // About 110 points in a neighbourhood: each estimate scatters by 7 %, the median of thousands far less.
    // The radius cuts off a little of the tails.
    EXPECT_NEAR(quality.plane_thickness_m, noise_m, 0.03 * noise_m);
    EXPECT_GT(quality.planes, quality.neighbourhoods * 9 / 10);
  }
}

TEST(MapQuality, EntropyOfAPlaneIsThatOfItsCovariance) {
  const double noise_m = 0.02, radius_m = 0.3;
  const MapQuality quality = mapQuality(noisyPlane(noise_m, kTilted), {radius_m, 12, 1});
  const double within = radius_m * radius_m / 4;  // variance along each axis of a disc
  const double expected =
      0.5 * (3 * std::log(2 * M_PI * M_E) + std::log(within * within * noise_m * noise_m));
  EXPECT_NEAR(quality.mean_entropy, expected, 0.1) << "the rim of the square has half discs";
}

TEST(MapQuality, ASecondSheetIsSeen) {
  std::vector<LidarPoint> points = noisyPlane(0.01, Pose{});
  const MapQuality sharp = mapQuality(points, {});
  const auto second = noisyPlane(0.01, Pose{Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, 0.06)}, 2);
  points.insert(points.end(), second.begin(), second.end());
  const MapQuality doubled = mapQuality(points, {});
  // two sheets 6 cm apart: standard deviation sqrt(3^2 + 1^2) cm in the middle
  EXPECT_NEAR(doubled.plane_thickness_m, 0.0316, 0.002);
  EXPECT_GT(doubled.mean_entropy, sharp.mean_entropy + 0.9);
}

TEST(MapQuality, NothingIsSaidAboutTooFewOrBadPoints) {
  EXPECT_EQ(mapQuality({}, {}).neighbourhoods, 0U);
  std::vector<LidarPoint> points(100);
  for (LidarPoint& p : points) p.x = std::numeric_limits<float>::quiet_NaN();
  points.resize(111);  // 11 points at the origin
  EXPECT_EQ(mapQuality(points, {}).neighbourhoods, 0U);
  points.resize(112);
  EXPECT_EQ(mapQuality(points, {}).neighbourhoods, 12U);
  EXPECT_THROW((void)mapQuality(points, {0.0, 12, 1}), std::invalid_argument);
  EXPECT_THROW((void)mapQuality(points, {0.3, 12, 0}), std::invalid_argument);
}

TEST(MapQuality, EveryWayOfDeskewingIsRankedRight) {
  test::Drive drive;  // slow: sheets farther apart than the radius would be two sharp walls
  drive.speed_mps = 3.0;
  drive.yaw_rate_radps = 0.15;
  const Trajectory trajectory = drive.trajectory(0.5, 3.5);
  std::vector<SweepPtr> sweeps;
  for (int i = 0; i < 6; ++i) sweeps.push_back(seeRoom(drive, 1.0 + 0.4 * i, 32000));
  const auto quality = [&](DeskewWay way) {
    const auto result = qualityOf(sweeps, way, trajectory, drive.T_imu_lidar, {0.6, 12, 50});
    EXPECT_TRUE(result);
    return *result;
  };
  const MapQuality right = quality(DeskewWay::kPerPoint), none = quality(DeskewWay::kNone);
  const MapQuality reversed = quality(DeskewWay::kReversed), batches = quality(DeskewWay::kBatches100);
  EXPECT_LT(right.mean_entropy, batches.mean_entropy + 0.01);
  EXPECT_LT(batches.mean_entropy + 0.1, none.mean_entropy);
  EXPECT_LT(none.mean_entropy, reversed.mean_entropy);
  EXPECT_LT(right.plane_thickness_m, none.plane_thickness_m);
}

TEST(MapQuality, WaysThatLosePointsSaySo) {
  const test::Drive drive;
  const SweepPtr sweep = test::seeWall(drive, 1.0, 6400).sweep;
  const auto points = placed(sweep, DeskewWay::kThinnedFirst, drive.trajectory(0.5, 2.0), drive.T_imu_lidar);
  ASSERT_TRUE(points);
  ASSERT_EQ(points->size(), sweep->points.size());
  const auto kept =
      std::count_if(points->begin(), points->end(), [](const LidarPoint& p) { return std::isfinite(p.x); });
  EXPECT_GT(kept, 1000);
  EXPECT_LT(kept, 6400);
  EXPECT_EQ(placed(sweep, DeskewWay::kNone, drive.trajectory(1.05, 2.0), drive.T_imu_lidar).reason(),
            Reason::kNoPoseYet);
}

}  // namespace
}  // namespace atlas
