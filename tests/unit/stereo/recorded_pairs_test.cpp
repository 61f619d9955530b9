// SPDX-License-Identifier: MIT
// The matcher beside OpenCV's semi-global one on real pairs with ground truth, in one run. The figures are
// printed; tests/bench/BENCHMARK.md has them.
#include "recorded_pairs.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "atlas/stereo/stereo_matcher.hpp"

namespace atlas::test {
namespace {

Score scoreOf(const std::vector<RecordedPair>& pairs, const std::string& set, const std::string& method,
              const std::string& aggregation = "paths") {
  Score score;
  int roads = 0;
  for (const RecordedPair& pair : pairs) {
    StereoParams params;
    params.method = method;
    params.aggregation = aggregation;
    params.range_px = pair.range_px;
    const DisparityImage found = StereoMatcher(pair.rig, params).match(pair.left, pair.right);
    score.add(found.disparity, pair.truth);
    roads += found.road.has_value();
  }
  std::printf("%-13s %-18s %-6s wrong %.2f %%, density %.1f %%, road in %d of %zu\n", set.c_str(),
              method.c_str(), aggregation.c_str(), 100.0 * score.wrongShare(), 100.0 * score.density(), roads,
              pairs.size());
  return score;
}

void compare(const std::vector<RecordedPair>& pairs, const std::string& set) {
  const Score ours = scoreOf(pairs, set, "double_correlation"), sgbm = scoreOf(pairs, set, "sgbm");
  scoreOf(pairs, set, "double_correlation", "window");
  scoreOf(pairs, set, "bm");
  EXPECT_LE(ours.wrongShare(), sgbm.wrongShare());
  EXPECT_GE(ours.density(), 0.8);
}

TEST(RecordedPairs, Kitti2015) {
  const auto pairs = kitti2015Pairs();
  if (pairs.empty()) GTEST_SKIP() << "ATLAS_DATA/kitti_stereo2015_sample is not there";
  compare(pairs, "KITTI 2015");
}

TEST(RecordedPairs, KittiDepth) {
  const auto pairs = kittiDepthPairs();
  if (pairs.empty()) GTEST_SKIP() << "ATLAS_DATA/kitti_depth_0001 is not there";
  compare(pairs, "KITTI depth");
}

TEST(RecordedPairs, Middlebury) {
  const auto pairs = middleburyPairs();
  if (pairs.empty()) GTEST_SKIP() << "ATLAS_DATA/stereo_middlebury is not there";
  compare(pairs, "Middlebury");
}

/// The camera of all KITTI drives of a day is where it was: 1.65 m above the road, its horizon near row 173.
TEST(RecordedPairs, KittiRoad) {
  const auto pairs = kittiDepthPairs();
  if (pairs.empty()) GTEST_SKIP() << "ATLAS_DATA/kitti_depth_0001 is not there";
  StereoParams params;
  params.range_px = 128;
  StereoMatcher matcher(pairs.front().rig, params);
  for (const RecordedPair& pair : pairs) {
    const DisparityImage found = matcher.match(pair.left, pair.right);
    ASSERT_TRUE(found.road.has_value()) << pair.name;
    EXPECT_NEAR(pair.rig.baseline_m / found.road->slope_px, 1.65, 0.08) << pair.name;
    EXPECT_NEAR(found.road->horizon_row, 172.9, 6.0) << pair.name;  // half a degree of pitch
    // the truth tells road and things apart by their height
    double road = 0, as_road = 0, things = 0, as_things = 0;
    for (int v = 0; v < pair.truth.rows; ++v) {
      for (int u = 0; u < pair.truth.cols; ++u) {
        const double t = static_cast<double>(pair.truth.at<float>(v, u));
        const auto label = static_cast<SurfaceLabel>(found.surface.at<std::uint8_t>(v, u));
        if (t < 8.0 || label == SurfaceLabel::kUnknown) continue;
        const double height_m = 1.65 * (1.0 - found.road->disparityAt(v) / t);
        if (std::abs(height_m) < 0.15) ++road, as_road += label == SurfaceLabel::kRoad;
        if (height_m > 0.4) ++things, as_things += label == SurfaceLabel::kObstacle;
      }
    }
    EXPECT_GT(as_road / road, 0.88) << pair.name;
    EXPECT_GT(as_things / things, 0.95) << pair.name;  // there are banks that are neither
  }
}

}  // namespace
}  // namespace atlas::test
