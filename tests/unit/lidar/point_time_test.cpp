// SPDX-License-Identifier: MIT
// Times of clouds that carry none, and stamps at either end of a sweep.
#include "atlas/lidar/point_time.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "moving_lidar.hpp"

namespace atlas {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

LidarPoint pointAt(double azimuth_rad, double range_m, std::uint16_t ring) {
  return {static_cast<float>(range_m * std::cos(azimuth_rad)),
          static_cast<float>(range_m * std::sin(azimuth_rad)),
          1.0F,
          0.0F,
          0.0F,
          ring,
          0};
}

/// 400 columns of 16 beams whose azimuths differ by up to 5 degrees within a column, as an HDL-64E's do.
/// direction -1 is clockwise. True times in `truth`.
std::vector<LidarPoint> columns(double direction, double begin_rad, std::vector<double>& truth) {
  std::vector<LidarPoint> points;
  for (int column = 0; column < 400; ++column) {
    for (int ring = 0; ring < 16; ++ring) {
      const double fan_rad = (ring % 2 == 0 ? 2.5 : -2.5) * M_PI / 180.0;
      const double range_m = 5.0 + 3.0 * std::sin(0.1 * column) + ring;
      points.push_back(pointAt(begin_rad + direction * 2 * M_PI * column / 400 + fan_rad, range_m,
                               static_cast<std::uint16_t>(ring)));
      truth.push_back(-0.1 * (399 - column) / 400);
    }
  }
  return points;
}

TEST(PointTime, ColumnsGetTheirTimeFromTheAzimuthInEitherDirection) {
  for (const double direction : {-1.0, 1.0}) {
    for (const double begin_rad : {0.3, M_PI, -2.0}) {
      std::vector<double> truth;
      std::vector<LidarPoint> points = columns(direction, begin_rad, truth);
      EXPECT_EQ(rebuildTimes(points, 0.1), TimeOrigin::kAzimuth);
      // the last point is off its column by 2.5 degrees, and so is every other: 5 degrees of 360 in 0.1 s
      for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_NEAR(static_cast<double>(points[i].time), truth[i], 0.1 * 5.0 / 360.0 + 1e-6);
    }
  }
}

TEST(PointTime, MissingColumnsDoNotMoveTheOthers) {
  std::vector<double> truth;
  std::vector<LidarPoint> points = columns(-1.0, 0.0, truth);
  for (std::size_t i = 16 * 100; i < 16 * 180; ++i) points[i].x = points[i].y = points[i].z = kNan;
  for (std::size_t i = 0; i < 16 * 3; ++i) points[i].x = points[i].y = points[i].z = 0.0F;
  points.erase(points.begin() + 16 * 200, points.begin() + 16 * 300);
  truth.erase(truth.begin() + 16 * 200, truth.begin() + 16 * 300);
  EXPECT_EQ(rebuildTimes(points, 0.1), TimeOrigin::kAzimuth);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i].x) || points[i].x == 0.0F) continue;
    EXPECT_NEAR(static_cast<double>(points[i].time), truth[i], 0.1 * 5.0 / 360.0 + 1e-6) << i;
  }
}

// KITTI: top laser first, azimuth increasing within a laser, sensor clockwise, cut at the rear.
TEST(PointTime, LaserByLaserIsClockwiseAndCutAtTheRear) {
  std::vector<LidarPoint> points;
  std::vector<double> truth;
  for (int ring = 63; ring >= 0; --ring) {
    for (int i = 0; i < 500; ++i) {
      const double turn = (i + 0.5) / 500.0;  // from the front over the left, as the files begin
      const double azimuth = 2 * M_PI * turn;
      points.push_back(pointAt(azimuth, 10.0, static_cast<std::uint16_t>(ring)));
      truth.push_back(-0.05 - 0.1 * std::remainder(turn, 1.0));
    }
  }
  EXPECT_EQ(rebuildTimes(points, 0.1), TimeOrigin::kLasers);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(static_cast<double>(points[i].time), truth[i], 1e-6);
}

TEST(PointTime, WithoutRotationTheOrderTells) {
  std::vector<LidarPoint> points;
  for (int i = 0; i < 1000; ++i) points.push_back(pointAt(0.5 * std::sin(1.7 * i), 10.0, 0));
  EXPECT_EQ(rebuildTimes(points, 0.1), TimeOrigin::kOrder);
  EXPECT_FLOAT_EQ(points.front().time, -0.0999F);
  EXPECT_FLOAT_EQ(points.back().time, 0.0F);
  std::vector<LidarPoint> none;
  EXPECT_EQ(rebuildTimes(none, 0.1), TimeOrigin::kOrder);
}

TEST(PointTime, UnitsOfDriversAreToldApart) {
  constexpr Stamp kStamp = 1'568'186'745'408'734'467;
  constexpr Stamp kSimulated = 50 * kSecond;
  struct Case {
    std::vector<double> raw;
    bool whole;
    Stamp stamp;
    double tolerance_s;
  };
  const double s = toSeconds(kStamp);
  // every one of them says 0, 20 and 99.9 ms after the stamp
  const std::vector<Case> cases = {
      {{0, 20e6, 99.9e6}, true, kStamp, 1e-8},                             // Ouster t, Livox offset_time: ns
      {{0, 0.02, 0.0999}, false, kStamp, 1e-8},                            // Velodyne time: s
      {{0, 20, 99.9}, false, kStamp, 1e-8},                                // ms
      {{0, 20e3, 99.9e3}, false, kStamp, 1e-8},                            // us
      {{0, 20e6, 99.9e6}, false, kStamp, 1e-8},                            // ns in a float field
      {{s, s + 0.02, s + 0.0999}, false, kStamp, 1e-6},                    // Hesai, RoboSense: Unix s
      {{1e3 * s, 1e3 * s + 20, 1e3 * s + 99.9}, false, kStamp, 1e-6},      // Unix ms
      {{1e9 * s, 1e9 * s + 20e6, 1e9 * s + 99.9e6}, false, kStamp, 1e-6},  // Livox timestamp: Unix ns
      {{50, 50.02, 50.0999}, false, kSimulated, 1e-8},                     // simulated time, s
      {{0, 0.02, 0.0999}, false, kSimulated, 1e-8},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const std::vector<float> times = relativeTimes(cases[i].raw, cases[i].whole, cases[i].stamp);
    EXPECT_NEAR(static_cast<double>(times[0]), 0.0, cases[i].tolerance_s) << i;
    EXPECT_NEAR(static_cast<double>(times[1]), 0.02, cases[i].tolerance_s) << i;
    EXPECT_NEAR(static_cast<double>(times[2]), 0.0999, cases[i].tolerance_s) << i;
  }
  EXPECT_TRUE(std::isnan(relativeTimes({0.0, NAN}, false, kStamp)[1]));
}

TEST(PointTime, StampIsMovedToEitherEnd) {
  auto sweep = std::make_shared<Sweep>();
  for (const float time : {-0.1F, kNan, -0.05F, 0.0F}) sweep->points.push_back({1, 0, 0, 0, time, 0, 0});
  EXPECT_EQ(withStampAt(sweep, ScanStamp::kRecorded), sweep);
  EXPECT_EQ(withStampAt(sweep, ScanStamp::kEnd), sweep) << "is so already";
  const SweepPtr start = withStampAt(sweep, ScanStamp::kStart);
  EXPECT_FLOAT_EQ(start->points[0].time, 0.0F);
  EXPECT_TRUE(std::isnan(start->points[1].time));
  EXPECT_FLOAT_EQ(start->points[3].time, 0.1F);
  EXPECT_FLOAT_EQ(withStampAt(start, ScanStamp::kEnd)->points[0].time, -0.1F);
  EXPECT_THROW((void)scanStampNamed("middle"), std::invalid_argument);
}

// A driver that writes times from 0 on, but stamps the end: the parameter puts it right.
TEST(PointTime, StageTakesTheStampAsTheParameterSays) {
  const test::Drive drive;
  const test::SeenSweep seen = test::seeWall(drive, 1.0, 640);
  auto mislabelled = std::make_shared<Sweep>(*seen.sweep);
  mislabelled->stamp += fromSeconds(static_cast<double>(mislabelled->points.back().time));
  DeskewParams params = test::oneLidar(0);
  const auto wrong = test::deskewOne(drive, mislabelled, params);
  params.scan_stamp = "end";
  const auto right = test::deskewOne(drive, mislabelled, params);
  EXPECT_GT(test::worstError(inMap(*wrong), seen.truth_map), 0.9) << "0.1 s at 10 m/s";
  EXPECT_LT(test::worstError(inMap(*right), seen.truth_map), 1e-4);
}

}  // namespace
}  // namespace atlas
