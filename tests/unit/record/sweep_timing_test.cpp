// SPDX-License-Identifier: MIT
// Time and ring of each point, rebuilt from the order of the points, and the inner clock of the lidar.
#include "record/sweep_timing.hpp"

#include <gtest/gtest.h>

#include "record/scan_layout.hpp"
#include "small_record.hpp"

namespace atlas::record {
namespace {

using test::kBegin;
using Order = ScanLayout::Order;

PcdCloud cloudOf(const std::vector<std::array<float, 4>>& points) { return parsePcd(test::pcdText(points)); }

/// The same points laser by laser.
std::vector<std::array<float, 4>> byRows(const std::vector<std::array<float, 4>>& points) {
  const std::size_t columns = points.size() / 32;
  std::vector<std::array<float, 4>> out(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) out[(i % 32) * columns + i / 32] = points[i];
  return out;
}

TEST(ScanLayout, IsSeenInThePoints) {
  const auto points = test::revolution(100);
  EXPECT_EQ(findScanLayout(cloudOf(points).points).order, Order::kColumns);
  EXPECT_EQ(findScanLayout(cloudOf(byRows(points)).points).order, Order::kRows);
  auto shifted = points;  // one return left out at the begin, one added at the end
  std::rotate(shifted.begin(), shifted.begin() + 1, shifted.end());
  EXPECT_EQ(findScanLayout(cloudOf(shifted).points).order, Order::kColumns) << "still 32 places";
  auto without_empty = points;
  without_empty.erase(
      std::remove_if(without_empty.begin(), without_empty.end(), [](const auto& p) { return p[0] == 0; }),
      without_empty.end());
  std::vector<std::array<float, 4>> thinned;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i % 5 != 3) thinned.push_back(points[i]);
  }
  thinned.resize(thinned.size() / 32 * 32);
  EXPECT_EQ(findScanLayout(cloudOf(thinned).points).order, Order::kUnknown) << "a multiple of 32 by chance";
}

TEST(ScanLayout, LasersAreRankedFromTheBottom) {
  auto points = test::revolution(64);
  const ScanLayout rising = findScanLayout(cloudOf(points).points);
  for (std::uint16_t k = 0; k < 32; ++k) EXPECT_EQ(rising.ring[k], k);
  // The order in which the HDL-32E fires: bottom, middle, bottom + 1, middle + 1, ...
  std::vector<std::array<float, 4>> interleaved(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t laser = i % 32, place = laser < 16 ? 2 * laser : 2 * (laser - 16) + 1;
    interleaved[i / 32 * 32 + place] = points[i];
  }
  const ScanLayout fired = findScanLayout(cloudOf(interleaved).points);
  EXPECT_EQ(fired.order, Order::kColumns);
  EXPECT_EQ(fired.ring[0], 0);
  EXPECT_EQ(fired.ring[1], 16);
  EXPECT_EQ(fired.ring[31], 31);
}

TEST(ScanLayout, DeadLaserDoesNotMatter) {
  const ScanLayout layout = findScanLayout(cloudOf(test::revolution(64, 14)).points);
  EXPECT_EQ(layout.order, Order::kColumns);
  EXPECT_EQ(layout.ring[13], 13);
  EXPECT_EQ(layout.ring[15], 15);
}

TEST(MakeSweep, TimeGrowsColumnByColumnUpToTheStamp) {
  SweepTiming timing;
  timing.duration_s = 0.1;
  const MadeSweep made = makeSweep(cloudOf(test::revolution(100, 14)), kBegin, "lidar_left", timing);
  const Sweep& sweep = made.sweep;
  EXPECT_EQ(made.remark, "");
  ASSERT_EQ(sweep.points.size(), 3200U);
  EXPECT_FLOAT_EQ(sweep.points[0].time, -0.1F);
  EXPECT_FLOAT_EQ(sweep.points[31].time, -0.1F) << "the lasers of a column fire together";
  EXPECT_FLOAT_EQ(sweep.points[32].time, -0.099F);
  EXPECT_FLOAT_EQ(sweep.points[3199].time, -0.001F);
  EXPECT_EQ(sweep.points[33].ring, 1);
  EXPECT_TRUE(std::isnan(sweep.points[14].x)) << "(0, 0, 0) is no return and stays in its place";
  EXPECT_EQ(sweep.points[15].intensity, 15.0F);
  timing.stamp_marks = RecordOptions::ScanStamp::kStart;
  EXPECT_FLOAT_EQ(makeSweep(cloudOf(test::revolution(100)), kBegin, "l", timing).sweep.points[3199].time,
                  0.099F);
}

TEST(MakeSweep, RowsHaveTheTimeOfTheirColumn) {
  const MadeSweep made = makeSweep(cloudOf(byRows(test::revolution(100))), kBegin, "lidar_left", {});
  EXPECT_EQ(made.remark, "scans laser by laser");
  EXPECT_FLOAT_EQ(made.sweep.points[0].time, -0.1F);
  EXPECT_FLOAT_EQ(made.sweep.points[1].time, -0.099F);
  EXPECT_FLOAT_EQ(made.sweep.points[100].time, -0.1F);
  EXPECT_EQ(made.sweep.points[100].ring, 1);
}

TEST(MakeSweep, UnknownLayoutIsLinearAndSaidSo) {
  auto points = test::revolution(10);
  points.pop_back();
  const MadeSweep made = makeSweep(cloudOf(points), kBegin, "lidar_left", {});
  EXPECT_EQ(made.remark, "layout of scans unknown: point time linear in the order of the file, ring 0");
  EXPECT_FLOAT_EQ(made.sweep.points[0].time, -0.1F);
  EXPECT_NEAR(made.sweep.points.back().time, -0.1 / 319, 1e-7);
  SweepTiming livox;
  livox.rotating = false;
  EXPECT_EQ(makeSweep(cloudOf(points), kBegin, "lidar_center", livox).remark, "") << "as expected of a Livox";
}

TEST(MakeSweep, TimeAndRingOfTheFileComeFirst) {
  PcdCloud cloud = cloudOf(test::revolution(2));
  cloud.has_ring = true;
  for (LidarPoint& point : cloud.points) point.ring = 5;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    cloud.time_s.push_back(0.001 * static_cast<double>(i));
  const Sweep sweep = makeSweep(cloud, kBegin, "l", {}).sweep;
  EXPECT_EQ(sweep.points[40].ring, 5);
  EXPECT_FLOAT_EQ(sweep.points.back().time, 0.0F) << "offsets from the begin, stamp at the end";
  EXPECT_NEAR(sweep.points[0].time, -0.063, 1e-6);
  for (double& t : cloud.time_s) t += 1'568'186'745.4 - 0.063;  // Unix time of the points
  cloud.absolute_time = true;
  EXPECT_NEAR(makeSweep(cloud, kBegin, "l", {}).sweep.points[0].time, -0.063, 1e-6);
}

TEST(MakeSweep, UnbelievableTimesAreRebuilt) {
  PcdCloud cloud = cloudOf(test::revolution(20));
  cloud.time_s.assign(cloud.points.size(), 0.0);
  cloud.time_s[3] = 5e4;  // microseconds, or garbage
  const MadeSweep made = makeSweep(cloud, kBegin, "l", {});
  EXPECT_EQ(made.remark, "point times of the file are not believable, rebuilt");
  EXPECT_FLOAT_EQ(made.sweep.points[0].time, -0.1F);
  cloud.time_s[3] = std::numeric_limits<double>::quiet_NaN();
  cloud.time_s[4] = 0.05;
  EXPECT_FLOAT_EQ(makeSweep(cloud, kBegin, "l", {}).sweep.points[3].time, -0.1F)
      << "NaN only concerns its point";
}

TEST(Revolution, IsTheIntervalOfASteadyMotor) {
  const auto ms = [](double v) { return fromSeconds(v * 1e-3); };
  EXPECT_NEAR(usualRevolution({ms(100), ms(99.8), ms(31), ms(100.1), ms(198)}), 0.1, 1e-9);
  EXPECT_EQ(usualRevolution({}), 0.1);
  EXPECT_EQ(usualRevolution({ms(1000)}), 0.1) << "no revolution";
  EXPECT_NEAR(revolutionDuration(ms(99.5), 0.1), 0.0995, 1e-12);
  EXPECT_EQ(revolutionDuration(ms(198), 0.1), 0.1) << "jitter of the system clock";
  EXPECT_EQ(revolutionDuration(ms(31), 0.1), 0.1);
  EXPECT_EQ(revolutionDuration(std::nullopt, 0.05), 0.05);
}

TEST(InnerTime, IsDecoded) {
  // A row of the real record: 1568186745 s and 1545501509 us since the hour = 07:25:45.501509.
  const auto inner = decodeInnerTime(6735310785341193029ULL, 1568186745501937363);
  ASSERT_TRUE(inner);
  EXPECT_EQ(inner->time, 1568186745501509000);
  EXPECT_FALSE(inner->repaired);
}

TEST(InnerTime, OffByASecondIsRepaired) {
  for (const std::int64_t error : {-1, 1}) {
    const auto inner = decodeInnerTime(test::innerTime(kBegin, error), kBegin + 477'000);
    ASSERT_TRUE(inner);
    EXPECT_EQ(inner->time, kBegin);
    EXPECT_TRUE(inner->repaired);
  }
}

TEST(InnerTime, HalvesFromBothSidesOfAFullHour) {
  const Stamp hour = 1'568'188'800'000'000'000;                              // 08:00:00
  const auto before = static_cast<std::uint64_t>(hour / kSecond - 1) << 32;  // still the old second
  const auto inner = decodeInnerTime(before + 200, hour + 500'000);
  ASSERT_TRUE(inner);
  EXPECT_EQ(inner->time, hour + 200'000);
}

TEST(InnerTime, AnotherClockIsNone) {
  EXPECT_FALSE(decodeInnerTime(test::innerTime(kBegin), kBegin + 10 * kSecond));
  EXPECT_FALSE(decodeInnerTime(11851675248ULL, kBegin)) << "ns since the start of a camera";
  EXPECT_FALSE(decodeInnerTime(~0ULL, kBegin));
}

}  // namespace
}  // namespace atlas::record
