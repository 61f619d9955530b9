// SPDX-License-Identifier: MIT
#include "atlas/stereo/stereo_matcher.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "scene.hpp"

namespace atlas::test {
namespace {

StereoParams params(const std::string& method, const std::string& aggregation = "paths") {
  StereoParams result;
  result.method = method;
  result.aggregation = aggregation;
  return result;
}

/// Columns whose match at the largest disparity is inside the right image, without the border.
cv::Mat inside(cv::Size size, int range_px) {
  cv::Mat mask(size, CV_8UC1, cv::Scalar(0));
  mask(cv::Rect(range_px, 10, size.width - range_px - 10, size.height - 20)).setTo(255);
  return mask;
}

std::string messageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

class EachMethod : public testing::TestWithParam<std::pair<const char*, const char*>> {};
INSTANTIATE_TEST_SUITE_P(Stereo, EachMethod,
                         testing::Values(std::pair("double_correlation", "paths"),
                                         std::pair("double_correlation", "window"),
                                         std::pair("sgbm", "paths"), std::pair("bm", "paths")));

/// Between whole disparities too, and between those of the half-size images.
TEST_P(EachMethod, FindsAFrontalPlaneToAFractionOfAPixel) {
  for (const double d : {7.0, 12.3, 20.75}) {
    const StereoScene scene = render({512, 320}, [&](int) { return d; }, {});
    StereoMatcher matcher(lexusRig(), params(GetParam().first, GetParam().second));
    const Judgement found =
        judge(matcher.match(scene.left, scene.right).disparity, scene.truth, inside({512, 320}, 64));
    EXPECT_GT(found.density, 0.9) << d;
    EXPECT_LT(found.median_px, 0.25) << d;  // what the u-disparity grid takes for its standard deviation
    EXPECT_LT(found.bad_share, 0.01) << d;
  }
}

TEST_P(EachMethod, ToldTheRoadOnItsOwn) {
  const StereoScene scene = roadScene();
  StereoMatcher matcher(lexusRig(), params(GetParam().first, GetParam().second));
  const DisparityImage found = matcher.match(scene.left, scene.right);
  ASSERT_TRUE(found.road.has_value());
  EXPECT_NEAR(found.road->slope_px, lexusRoad().slope_px, 0.03 * lexusRoad().slope_px);
  EXPECT_NEAR(found.road->horizon_row, lexusRoad().horizon_row, 2.0);
}

class DoubleCorrelation : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Stereo, DoubleCorrelation, testing::Values("paths", "window"));

TEST_P(DoubleCorrelation, TellsRoadFromThings) {
  const StereoScene scene = roadScene();
  StereoMatcher matcher(lexusRig(), params("double_correlation", GetParam()));
  const DisparityImage found = matcher.match(scene.left, scene.right);
  cv::Mat things, not_road;
  cv::erode(scene.things, things, cv::Mat::ones(15, 15, CV_8U));  // not their outlines
  cv::dilate(scene.things, not_road, cv::Mat::ones(31, 61, CV_8U));
  cv::Mat road = inside({512, 320}, 64) & ~not_road;
  road.rowRange(0, 190).setTo(0);  // so near the horizon the disparity says nothing about the slope
  EXPECT_GT(shareOf(found.surface, SurfaceLabel::kRoad, road), 0.95);
  EXPECT_GT(shareOf(found.surface, SurfaceLabel::kObstacle, things), 0.9);
  EXPECT_LT(judge(found.disparity, scene.truth, road).median_px, 0.2);
}

/// The strip on the left of a thing is not in the right image: no disparity is better than a wrong one.
TEST_P(DoubleCorrelation, DoesNotInventWhatIsHidden) {
  const double far_px = 8.0, near_px = 28.0;
  const cv::Rect place(250, 80, 100, 160);
  const StereoScene scene = render({512, 320}, [&](int) { return far_px; }, {{place, near_px}});
  StereoMatcher matcher(lexusRig(), params("double_correlation", GetParam()));
  const cv::Mat disparity = matcher.match(scene.left, scene.right).disparity;
  cv::Mat hidden(scene.truth.size(), CV_8UC1, cv::Scalar(0)), beside = hidden.clone();
  hidden(cv::Rect(place.x - 16, place.y + 20, 12, place.height - 40))
      .setTo(255);  // 20 px wide, without its borders
  beside(cv::Rect(place.br().x + 10, place.y + 20, 40, place.height - 40)).setTo(255);
  EXPECT_LT(judge(disparity, scene.truth, hidden).density, 0.4);
  EXPECT_GT(judge(disparity, scene.truth, beside).density, 0.9);
}

TEST_P(DoubleCorrelation, WhatIsNearerThanTheRangeIsUnknown) {
  const cv::Rect place(220, 60, 140, 200);
  const StereoScene scene = render({512, 320}, [](int) { return 8.0; }, {{place, 50.0}});
  StereoParams short_range = params("double_correlation", GetParam());
  short_range.range_px = 32;
  StereoMatcher matcher(lexusRig(), short_range);
  cv::Mat thing(scene.truth.size(), CV_8UC1, cv::Scalar(0));
  thing(cv::Rect(place.x + 15, place.y + 15, place.width - 30, place.height - 30)).setTo(255);
  EXPECT_LT(judge(matcher.match(scene.left, scene.right).disparity, scene.truth, thing).density, 0.1);
}

TEST_P(DoubleCorrelation, GivesTheSameBytesAgain) {
  const StereoScene scene = roadScene();
  StereoMatcher one(lexusRig(), params("double_correlation", GetParam()));
  const DisparityImage first = one.match(scene.left, scene.right);
  one.match(scene.right, scene.left);  // whatever comes between
  one.reset();
  const DisparityImage again = one.match(scene.left, scene.right);
  EXPECT_EQ(cv::countNonZero(first.disparity != again.disparity), 0);
  EXPECT_EQ(cv::countNonZero(first.surface != again.surface), 0);
}

TEST_P(DoubleCorrelation, TakesColourAnd16Bit) {
  const StereoScene scene = roadScene();
  const StereoParams of = params("double_correlation", GetParam());
  const cv::Mat grey = StereoMatcher(lexusRig(), of).match(scene.left, scene.right).disparity;
  cv::Mat left, right;
  cv::cvtColor(scene.left, left, cv::COLOR_GRAY2BGR);
  cv::cvtColor(scene.right, right, cv::COLOR_GRAY2BGRA);
  EXPECT_EQ(cv::countNonZero(grey != StereoMatcher(lexusRig(), of).match(left, right).disparity), 0);
  double most = 0;
  cv::minMaxLoc(cv::max(scene.left, scene.right), nullptr, &most);
  scene.left.convertTo(left, CV_16U, 4095.0 / most);  // a camera of 12 bit
  scene.right.convertTo(right, CV_16U, 4095.0 / most);
  const Judgement deep = judge(StereoMatcher(lexusRig(), of).match(left, right).disparity, scene.truth);
  EXPECT_NEAR(deep.density, judge(grey, scene.truth).density, 0.03);
  EXPECT_LT(deep.median_px, 0.2);
}

TEST(StereoMatcher, KnowsTheRoadFromTheCamerasPlace) {
  const StereoScene scene = roadScene();
  StereoParams of = params("double_correlation");
  of.camera_height_m = 1.28;
  const DisparityImage found = StereoMatcher(lexusRig(), of).match(scene.left, scene.right);
  ASSERT_TRUE(found.road.has_value());
  EXPECT_DOUBLE_EQ(found.road->slope_px, 0.22 / 1.28);
  EXPECT_DOUBLE_EQ(found.road->horizon_row, 156.0);
}

TEST(StereoMatcher, AWallIsNoRoad) {
  const StereoScene scene = render({512, 320}, [](int) { return 12.0; }, {});
  const DisparityImage found =
      StereoMatcher(lexusRig(), params("double_correlation")).match(scene.left, scene.right);
  EXPECT_FALSE(found.road.has_value());
  EXPECT_EQ(cv::countNonZero(found.surface == static_cast<int>(SurfaceLabel::kRoad)), 0);
}

/// The sky, and a camera that sees nothing.
TEST(StereoMatcher, WithoutTextureNothingIsKnown) {
  const cv::Mat blank(320, 512, CV_8UC1, cv::Scalar(255));
  for (const char* aggregation : {"paths", "window"}) {
    const DisparityImage found =
        StereoMatcher(lexusRig(), params("double_correlation", aggregation)).match(blank, blank);
    EXPECT_EQ(cv::countNonZero(found.disparity), 0) << aggregation;
    EXPECT_EQ(cv::countNonZero(found.surface), 0) << aggregation;
  }
}

TEST(StereoMatcher, SaysWhatIsWrongWithImages) {
  StereoMatcher matcher(lexusRig(), params("double_correlation"));
  const cv::Mat good(320, 512, CV_8UC1, cv::Scalar(0)), small(320, 500, CV_8UC1), metres(320, 512, CV_32FC1);
  EXPECT_EQ(messageOf([&] { matcher.match(good, {}); }), "stereo: the right image is missing");
  EXPECT_EQ(messageOf([&] { matcher.match(small, good); }),
            "stereo: the left image must be 512x320 as its camera_info says, got 500x320");
  EXPECT_EQ(messageOf([&] { matcher.match(good, metres); }),
            "stereo: the right image must have 8 or 16 bit, got CV_32FC1");
}

TEST(StereoMatcher, SaysWhatIsWrongWithParameters) {
  const auto of = [](const std::function<void(StereoParams&)>& change) {
    StereoParams wrong;
    change(wrong);
    return messageOf([&] { StereoMatcher(lexusRig(), wrong); });
  };
  EXPECT_EQ(of([](auto& p) { p.method = "elas"; }),
            "stereo: method must be double_correlation, sgbm or bm, got 'elas'");
  EXPECT_EQ(of([](auto& p) { p.range_px = 4; }), "stereo: range_px must be in 8..256, got 4");
  EXPECT_EQ(of([](auto& p) { p.window.side_px = 10; }),
            "window matcher: side_px must be odd and in 3..31, got 10");
  EXPECT_EQ(of([](auto& p) { p.paths.large_step_cost = 2; }),
            "path matcher: large_step_cost must be in small_step_cost..100, got 2");
  EXPECT_EQ(of([](auto& p) { p.paths.choice.uniqueness_percent = -1; }),
            "disparity choice: uniqueness_percent must be in 0..100, got -1");
  EXPECT_NE(of([](auto& p) { p.road.max_height_m = 0.1; }).find("max_height_m must be above min_height_m"),
            std::string::npos);
  StereoRig narrow = lexusRig();
  narrow.width_px = 64;
  EXPECT_EQ(messageOf([&] { StereoMatcher(narrow, StereoParams{}); }),
            "stereo: range_px must be less than the width of the image (64), got 64");
  narrow.baseline_m = 0.0;
  EXPECT_NE(messageOf([&] { StereoMatcher(narrow, StereoParams{}); }).find("baseline_m must be positive"),
            std::string::npos);
}

/// sigma_Z = Z^2 sigma_d / (f b): what is twice as far is four times less certain.
TEST(StereoMatcher, DepthErrorGrowsWithTheSquareOfTheDepth) {
  const StereoRig rig = lexusRig();
  EXPECT_NEAR(rig.depthSigma(10.0, 0.25), 0.277, 0.001);
  std::vector<double> sigma_px;
  for (const double depth_m : {4.0, 8.0, 16.0}) {
    const double d = rig.disparityAt(depth_m);
    const StereoScene scene = render(
        {512, 320}, [&](int) { return d; }, {}, 3.0);
    const cv::Mat found =
        StereoMatcher(rig, params("double_correlation")).match(scene.left, scene.right).disparity;
    double sum_sq = 0, count = 0;
    for (int v = 20; v < 300; ++v) {
      for (int u = 80; u < 500; ++u) {
        if (found.at<std::uint16_t>(v, u) == 0) continue;
        const double error_m = rig.depthOf(found.at<std::uint16_t>(v, u) / 256.0) - depth_m;
        sum_sq += error_m * error_m;
        ++count;
      }
    }
    sigma_px.push_back(std::sqrt(sum_sq / count) / rig.depthSigma(depth_m, 1.0));
  }
  for (const double sigma : sigma_px) {
    EXPECT_LT(sigma, 0.25);  // what the u-disparity grid assumes
    EXPECT_NEAR(sigma / sigma_px.front(), 1.0, 0.5);
  }
}

}  // namespace
}  // namespace atlas::test
