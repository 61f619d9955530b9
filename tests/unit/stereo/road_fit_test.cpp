// SPDX-License-Identifier: MIT
#include "atlas/stereo/road_fit.hpp"

#include <gtest/gtest.h>

#include "atlas/stereo/disparity_choice.hpp"
#include "atlas/stereo/road_view.hpp"
#include "scene.hpp"

namespace atlas::test {
namespace {

/// The road in `road_share` of the columns, the rest walls; a fifth unknown, a tenth wrong.
cv::Mat disparities(const RoadProfile& road, double road_share, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.3);
  cv::Mat result(320, 512, CV_32SC1, cv::Scalar(kNoDisparity));
  for (int v = 0; v < 320; ++v) {
    for (int u = 0; u < 512; ++u) {
      const auto kind = random() % 10;
      double d =
          u < road_share * 512 ? road.disparityAt(v) : std::max(12.0, road.disparityAt(v)) + 6.0 * (u % 2);
      if (d < 1.0) d = 1.0 + (u % 4);
      if (kind < 2) continue;
      if (kind == 2) d = static_cast<double>(random() % 6000) / 100.0;
      result.at<std::int32_t>(v, u) =
          static_cast<std::int32_t>(std::max(0.0, d + noise(random)) * kDisparityScale);
    }
  }
  return result;
}

TEST(RoadFit, FindsTheRoadBesideWalls) {
  for (const RoadProfile& road :
       {RoadProfile{156.0, 0.172}, RoadProfile{140.5, 0.12}, RoadProfile{170.0, 0.25}}) {
    const auto found = fitRoad(disparities(road, 0.6, 1), lexusRig(), {}, std::nullopt);
    ASSERT_TRUE(found.has_value()) << road.horizon_row;
    EXPECT_NEAR(found->slope_px, road.slope_px, 0.02 * road.slope_px);
    EXPECT_NEAR(found->horizon_row, road.horizon_row, 2.0);
    const auto again = fitRoad(disparities(road, 0.6, 2), lexusRig(), {}, found);
    ASSERT_TRUE(again.has_value());
    EXPECT_NEAR(again->horizon_row, road.horizon_row, 2.0);
  }
}

/// A prior that is wrong, as after a cut, does not keep it from the road.
TEST(RoadFit, IsNotMisledByTheImageBefore) {
  const RoadProfile road{156.0, 0.172}, other{125.0, 0.33};
  const auto found = fitRoad(disparities(road, 0.7, 1), lexusRig(), {}, other);
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->slope_px, road.slope_px, 0.02 * road.slope_px);
}

TEST(RoadFit, WithoutARoadItIsUnknown) {
  cv::Mat wall(320, 512, CV_32SC1, cv::Scalar(12 * kDisparityScale));
  EXPECT_FALSE(fitRoad(wall, lexusRig(), {}, std::nullopt).has_value());
  wall.setTo(kNoDisparity);
  EXPECT_FALSE(fitRoad(wall, lexusRig(), {}, lexusRoad()).has_value());
}

/// A point on the road, seen by a camera that is tilted down.
TEST(RoadFit, RoadOfTheCamerasPlace) {
  const StereoRig rig = lexusRig();
  const double height_m = 1.28, pitch_rad = 0.05;
  const RoadProfile road = roadFromCamera(rig, height_m, pitch_rad);
  for (const double ahead_m : {5.0, 15.0, 40.0}) {
    // in the optical frame (y down, z forward) of the tilted camera
    const double y = height_m * std::cos(pitch_rad) - ahead_m * std::sin(pitch_rad);
    const double z = ahead_m * std::cos(pitch_rad) + height_m * std::sin(pitch_rad);
    EXPECT_NEAR(road.disparityAt(rig.v0_px + rig.focal_px * y / z), rig.disparityAt(z), 1e-9);
  }
  EXPECT_THROW(roadFromCamera(rig, 0.0, 0.0), std::invalid_argument);
  EXPECT_THROW(roadFromCamera(rig, 1.0, 2.0), std::invalid_argument);
}

/// In the view of the road the road has no disparity.
TEST(RoadView, TakesTheDisparityOfTheRoadAway) {
  const RoadProfile road = lexusRoad();
  const StereoScene scene = render(
      {512, 320}, [&](int v) { return std::max(0.0, road.disparityAt(v)); }, {}, 0.0);
  const cv::Mat view = shearedByRoad(scene.right, road);
  const cv::Rect seen(60, 160, 440, 150);
  cv::Mat off;
  cv::absdiff(view(seen), scene.left(seen), off);
  EXPECT_LT(cv::mean(off)[0], 1.0);
  cv::absdiff(scene.right(seen), scene.left(seen), off);
  EXPECT_GT(cv::mean(off)[0], 20.0);
}

}  // namespace
}  // namespace atlas::test
