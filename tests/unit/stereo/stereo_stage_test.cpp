// SPDX-License-Identifier: MIT
#include "atlas/stereo/stereo_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <random>

namespace atlas {
namespace {

constexpr int kWidth = 320, kHeight = 200, kShift_px = 12;
constexpr double kFocal_px = 250.0, kBaseline_m = 0.3;

/// Ground truth: a textured wall at one depth, so the right image is the left one moved by kShift_px.
class StereoStageTest : public testing::Test {
 protected:
  void SetUp() override {
    params_.left_camera = "left";
    params_.right_camera = "right";
    params_.width_px = 0;
    params_.matcher.range_px = 64;
    params_.matcher.camera_height_m = 1.5;
    std::mt19937 random(7);
    cv::Mat wide(kHeight, kWidth + kShift_px, CV_8UC1);
    for (int row = 0; row < wide.rows; ++row) {
      for (int column = 0; column < wide.cols; ++column)
        wide.at<std::uint8_t>(row, column) = static_cast<std::uint8_t>(random() % 256);
    }
    left_ = wide.colRange(0, kWidth).clone();
    right_ = wide.colRange(kShift_px, kShift_px + kWidth).clone();
  }
  struct Heard {
    std::vector<StereoDisparityPtr> disparities;
    std::vector<ImagePtr> surfaces, u_disparities;
    std::vector<SensorGridPtr> grounds;
  };
  std::unique_ptr<StereoStage> stage(Heard& heard) const {
    auto stage = std::make_unique<StereoStage>(params_);
    stage->on_disparity = [&](const StereoDisparityPtr& d) { heard.disparities.push_back(d); };
    stage->on_surface = [&](const ImagePtr& i) { heard.surfaces.push_back(i); };
    stage->on_u_disparity = [&](const ImagePtr& i) { heard.u_disparities.push_back(i); };
    stage->on_ground = [&](const SensorGridPtr& g) { heard.grounds.push_back(g); };
    return stage;
  }
  static CameraInfo info(Stamp stamp, bool is_right) {
    CameraInfo info;
    info.stamp = stamp;
    info.frame = is_right ? "right" : "left";
    info.width = kWidth;
    info.height = kHeight;
    info.distortion_model = "plumb_bob";
    info.distortion.assign(5, 0.0);
    info.K = {kFocal_px, 0, 160, 0, kFocal_px, 100, 0, 0, 1};
    info.P = {kFocal_px, 0, 160, is_right ? -kFocal_px * kBaseline_m : 0, 0, kFocal_px, 100, 0, 0, 0, 1, 0};
    return info;
  }
  static ImagePtr image(Stamp stamp, const cv::Mat& pixels) {
    auto image = std::make_shared<Image>();
    image->stamp = stamp;
    image->frame = "left";
    image->format = "mono8";
    image->pixels = pixels;
    return image;
  }
  static void finish(StereoStage& stage) {
    for (std::size_t input = 0; input < stage.inputs(); ++input) stage.finish(input);
  }
  StereoStageParams params_;
  cv::Mat left_, right_;
};

TEST_F(StereoStageTest, AWallHasItsDisparityAndStandsWhereItIs) {
  Heard heard;
  const auto s = stage(heard);
  s->pushInfo(StereoStage::kLeftInfo, info(5, false));
  s->pushInfo(StereoStage::kRightInfo, info(5, true));
  s->pushImage(StereoStage::kLeft, image(5, left_));
  s->pushImage(StereoStage::kRight, image(5, right_));
  finish(*s);
  ASSERT_EQ(heard.disparities.size(), 1U);
  const StereoDisparity& d = *heard.disparities[0];
  EXPECT_EQ(d.stamp, 5);
  EXPECT_EQ(d.rig.baseline_m, kBaseline_m);
  const cv::Mat right_of_edge = d.image.disparity.colRange(80, kWidth - 16);
  cv::Mat as_true;
  cv::inRange(right_of_edge, (kShift_px - 0.5) * kDisparityScale, (kShift_px + 0.5) * kDisparityScale,
              as_true);
  const int near = cv::countNonZero(as_true);
  EXPECT_GT(near, 0.9 * static_cast<double>(right_of_edge.total()));
  ASSERT_EQ(heard.grounds.size(), 1U);
  const SensorGrid& ground = *heard.grounds[0];
  ASSERT_EQ(ground.occupied.size(),
            static_cast<std::size_t>(ground.columns) * static_cast<std::size_t>(ground.rows));
  // Straight ahead the likeliest cell is the wall: f b / d = 6.25 m, half a pixel of disparity is 0.26 m.
  const auto row = ground.occupied.begin() + static_cast<std::ptrdiff_t>(ground.rows / 2) * ground.columns;
  const auto best = std::max_element(row, row + ground.columns);
  const double ahead = ground.origin_x_m + (static_cast<double>(best - row) + 0.5) * ground.cell_m;
  EXPECT_NEAR(ahead, kFocal_px * kBaseline_m / kShift_px, 0.26 + ground.cell_m);
  EXPECT_GT(*best, 0.6F);
  const Eigen::Vector3d forward = ground.T_sensor_grid * Eigen::Vector3d(1.0, 0.0, 0.0);
  EXPECT_LT((forward - Eigen::Vector3d(0.0, 0.0, 1.0)).norm(), 1e-9) << "x of the ground is the optical axis";
  EXPECT_EQ(heard.surfaces[0]->pixels.size(), left_.size());
  EXPECT_EQ(heard.u_disparities[0]->pixels.cols, kWidth);
}

TEST_F(StereoStageTest, EveryLeftImageIsAnsweredOnce) {
  Heard heard;
  const auto s = stage(heard);
  const Stamp step = 100 * kMillisecond, late = 20 * kMillisecond;  // more than the tolerance of 5 ms
  for (int i = 0; i < 4; ++i) {
    s->pushInfo(StereoStage::kLeftInfo, info(i * step, false));
    s->pushInfo(StereoStage::kRightInfo, info(i * step, true));
    s->pushImage(StereoStage::kLeft, image(i * step, left_));
    if (i == 1) continue;  // missing
    const bool truncated = i == 3;
    s->pushImage(StereoStage::kRight,
                 image(i * step + (i == 2 ? late : 0), truncated ? right_.rowRange(0, 9) : right_));
  }
  finish(*s);
  ASSERT_EQ(heard.disparities.size(), 4U);
  ASSERT_EQ(heard.grounds.size(), 4U);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(heard.disparities[static_cast<std::size_t>(i)]->stamp, i * step);
    EXPECT_EQ(heard.disparities[static_cast<std::size_t>(i)]->image.disparity.empty(), i != 0) << i;
    EXPECT_EQ(heard.grounds[static_cast<std::size_t>(i)]->occupied.empty(), i != 0) << i;
  }
  EXPECT_EQ(s->counters().get("pairs"), 1U);
  EXPECT_EQ(s->counters().get(std::string("skipped pair: ") + toString(Reason::kEmpty)), 2U);
  EXPECT_EQ(s->counters().get(std::string("skipped pair: ") + toString(Reason::kBadLayout)), 1U);
  EXPECT_EQ(s->counters().get("right images without a left one"), 1U);
}

TEST_F(StereoStageTest, WithoutIntrinsicsNothingIsGuessed) {
  Heard heard;
  const auto s = stage(heard);
  s->pushImage(StereoStage::kLeft, image(5, left_));
  s->pushImage(StereoStage::kRight, image(5, right_));
  finish(*s);
  ASSERT_EQ(heard.disparities.size(), 1U);
  EXPECT_TRUE(heard.disparities[0]->image.disparity.empty());
  EXPECT_EQ(s->counters().get(std::string("skipped pair: ") + toString(Reason::kMissingIntrinsics)), 1U);
}

TEST_F(StereoStageTest, OrderOfArrivalHasNoInfluence) {
  std::vector<cv::Mat> results;
  for (const bool right_first : {false, true}) {
    Heard heard;
    const auto s = stage(heard);
    for (int pass = 0; pass < 2; ++pass) {
      const bool is_right = (pass == 0) == right_first;
      for (int i = 0; i < 3; ++i) {
        const Stamp stamp = i * 100 * kMillisecond + (is_right ? kMillisecond : 0);
        s->pushInfo(is_right ? StereoStage::kRightInfo : StereoStage::kLeftInfo, info(stamp, is_right));
        s->pushImage(is_right ? StereoStage::kRight : StereoStage::kLeft,
                     image(stamp, is_right ? right_ : left_));
      }
    }
    finish(*s);
    ASSERT_EQ(heard.disparities.size(), 3U);
    results.push_back(heard.disparities[2]->image.disparity);
  }
  EXPECT_FALSE(results[0].empty());
  EXPECT_EQ(cv::norm(results[0], results[1], cv::NORM_INF), 0.0);
}

TEST_F(StereoStageTest, CamerasThatAreNoPairAreRefusedInWords) {
  Heard heard;
  const auto s = stage(heard);
  CameraInfo same = info(5, true);
  same.P = info(5, false).P;  // no baseline, and no transform says where the right camera is
  s->pushInfo(StereoStage::kLeftInfo, info(5, false));
  s->pushInfo(StereoStage::kRightInfo, same);
  s->pushImage(StereoStage::kLeft, image(5, left_));
  s->pushImage(StereoStage::kRight, image(5, right_));
  EXPECT_THROW(finish(*s), std::invalid_argument);
}

TEST(StereoStageParams, BadOnesAreNamed) {
  StereoStageParams params;
  params.right_camera = params.left_camera;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.width_px = 10;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.max_stamp_difference_s = -1.0;
  EXPECT_THROW(validate(params), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
