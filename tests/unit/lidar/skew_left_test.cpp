// SPDX-License-Identifier: MIT
// A car drives straight on at constant speed between two rows of house corners: every sweep is skewed alike,
// and the surfaces still tell how much.
#include "atlas/lidar/skew_left.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "atlas/lidar/deskew_trial.hpp"
#include "moving_lidar.hpp"

namespace atlas {
namespace {

constexpr double kNoise_m = 0.02;

test::Drive straightOn() {
  test::Drive drive;
  drive.heading_rad = 0.0;
  drive.yaw_rate_radps = 0.0;
  return drive;
}

/// Distance to walls across the street that stand out from both house fronts, 6 m to the side, every 5 m.
double distanceTo(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) {
  const double side = direction.y() > 0 ? 13.0 - from.y() : from.y() + 13.0;
  const double to_front = side / std::abs(direction.y());
  const double step = direction.x() > 0 ? 5.0 : -5.0;
  for (double x = 5.0 * (direction.x() > 0 ? std::ceil(from.x() / 5.0) : std::floor(from.x() / 5.0));;
       x += step) {
    const double to_wall = (x - from.x()) / direction.x();
    if (to_wall > to_front || to_wall > 60.0) return to_front;
    if (std::abs(from.y() + to_wall * direction.y() + 0.0) > 4.0) return to_wall;
  }
}

/// A sweep of 0.1 s from the stamp on, clockwise, cut at the rear, 16 lasers side by side in height.
SweepPtr seeStreet(const test::Drive& drive, double stamp_s, int count, std::mt19937& random) {
  const Trajectory truth = drive.trajectory(stamp_s - 0.1, stamp_s + 0.3);
  std::normal_distribution<double> noise(0.0, kNoise_m);
  auto sweep = std::make_shared<Sweep>();
  sweep->stamp = test::at(stamp_s);
  for (int i = 0; i < count; ++i) {
    const double time_s = 0.1 * i / count, azimuth = M_PI - 2.0 * M_PI * i / count;
    const Pose T = *truth.at(sweep->stamp + fromSeconds(time_s)) * drive.T_imu_lidar;
    const Eigen::Vector3d direction(std::cos(azimuth), std::sin(azimuth), 0.0);
    const double range_m = std::min(60.0, distanceTo(T.translation, direction)) + noise(random);
    Eigen::Vector3d p_map = T.translation + range_m * direction;
    p_map.z() += 0.1 * (i % 16);
    const Eigen::Vector3f p = (T.inverse() * p_map).cast<float>();
    sweep->points.push_back({p.x(), p.y(), p.z(), 0, static_cast<float>(time_s), 0, 0});
  }
  return sweep;
}

SkewLeft left(DeskewWay way, const std::vector<SweepPtr>& sweeps, const test::Drive& drive) {
  const auto result = skewLeftOf(sweeps, way, drive.trajectory(0.5, 4.0), drive.T_imu_lidar, {0.4, 12, 20});
  EXPECT_TRUE(result);
  return *result;
}

std::vector<SweepPtr> street(const test::Drive& drive) {
  std::mt19937 random(1);
  std::vector<SweepPtr> sweeps;
  for (int i = 0; i < 6; ++i) sweeps.push_back(seeStreet(drive, 1.0 + 0.3 * i, 24000, random));
  return sweeps;
}

// More than a thousand neighbourhoods of 2 cm noise and shifts of up to 25 cm leave less than 0.02;
// neighbours that the radius cuts off and corners that are taken for planes add a bias, which must stay below
// 0.1 of the skew.
TEST(SkewLeft, TellsTheWaysApartWhereEverySweepIsSkewedAlike) {
  const test::Drive drive = straightOn();
  const std::vector<SweepPtr> sweeps = street(drive);
  const SkewLeft per_point = left(DeskewWay::kPerPoint, sweeps, drive);
  EXPECT_GT(per_point.neighbourhoods, 1000U);
  EXPECT_NEAR(per_point.share, 0.0, 0.03);
  EXPECT_NEAR(left(DeskewWay::kBatches100, sweeps, drive).share, 0.0, 0.03);
  EXPECT_NEAR(left(DeskewWay::kNone, sweeps, drive).share, 1.0, 0.1);
  EXPECT_GT(left(DeskewWay::kReversed, sweeps, drive).share, 1.5);
}

TEST(SkewLeft, SeesTimesThatRunTheWrongWay) {
  const test::Drive drive = straightOn();
  std::vector<SweepPtr> sweeps;
  for (const SweepPtr& sweep : street(drive)) {
    auto reversed = std::make_shared<Sweep>(*sweep);
    for (LidarPoint& p : reversed->points) p.time = 0.1F - p.time;
    sweeps.push_back(reversed);
  }
  // what is taken for the de-skewed map is wrong by twice the shift, the other way
  EXPECT_LT(left(DeskewWay::kPerPoint, sweeps, drive).share, -1.5);
}

TEST(SkewLeft, SaysNothingAtStandstillOrWithoutPoints) {
  test::Drive drive = straightOn();
  drive.speed_mps = 0.0;
  EXPECT_EQ(left(DeskewWay::kPerPoint, street(drive), drive).neighbourhoods, 0U);
  EXPECT_EQ(skewLeft({}, {}, {}).neighbourhoods, 0U);
  EXPECT_THROW((void)skewLeft(std::vector<LidarPoint>(2), {}, {}), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
