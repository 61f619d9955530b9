// SPDX-License-Identifier: MIT
#include "atlas/camera/depth_stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "scene.hpp"

namespace atlas::test {
namespace {

struct Answer {
  std::size_t camera;
  DepthImagePtr image;
};

DepthParams params(std::vector<std::string> cameras = {"camera"}) {
  DepthParams p;
  p.cameras = std::move(cameras);
  p.lidars = {"lidar"};
  p.fill_gap_m = 0.0;
  p.look_ahead_s = 0.0;
  return p;
}

struct Inputs {
  std::vector<Odometry> odometry;
  std::vector<BatchedSweepPtr> sweeps;
  std::vector<std::vector<CameraInfo>> infos;
  Pose T_imu_camera = forwardCamera();
};

std::vector<Answer> answers(DepthStage& stage, const Inputs& inputs, unsigned seed = 0) {
  std::vector<Answer> result;
  stage.on_depth = [&](std::size_t camera, const DepthImagePtr& image) { result.push_back({camera, image}); };
  std::vector<Feed> feeds(3 + inputs.infos.size());
  std::vector<std::pair<std::string, Pose>> sensors;
  for (std::size_t c = 0; c < inputs.infos.size(); ++c) {
    feeds[3 + c].input = stage.cameraInfoInput(c);
    for (const CameraInfo& info : inputs.infos[c]) {
      feeds[3 + c].pushes.push_back([&stage, c, &info] { stage.push(c, info); });
      sensors.emplace_back(info.frame, inputs.T_imu_camera);
    }
  }
  feeds[0] = {DepthStage::kTfStatic, {[&stage, sensors] { stage.push(0, rig(sensors)); }}};
  feeds[1].input = DepthStage::kOdometry;
  for (const Odometry& o : inputs.odometry) feeds[1].pushes.push_back([&stage, &o] { stage.push(o); });
  feeds[2].input = stage.lidarInput(0);
  for (const auto& sweep : inputs.sweeps)
    feeds[2].pushes.push_back([&stage, &sweep] { stage.push(0, sweep); });
  run(stage, feeds, seed);
  EXPECT_TRUE(stage.ended());
  return result;
}

Inputs standing() {
  Inputs inputs;
  inputs.odometry = {odometry(kStart - kMillisecond), odometry(kStart + kMillisecond)};
  inputs.sweeps = {sweepOf(wall(10.0, 8.0, 8.0, 0.05), kStart)};
  inputs.infos = {{simpleInfo("camera", kStart)}};
  return inputs;
}

std::uint64_t knownPixels(const cv::Mat& depth) {
  std::uint64_t known = 0;
  for (int row = 0; row < depth.rows; ++row) {
    for (int column = 0; column < depth.cols; ++column)
      known += std::isnan(depth.at<float>(row, column)) ? 0 : 1;
  }
  return known;
}

// z-depth of a wall is the same in every pixel; range would grow by 15 % towards the corners (W13).
TEST(DepthStage, W13_wallHasOneDepthEverywhere) {
  DepthStage stage(params());
  const auto result = answers(stage, standing());
  ASSERT_EQ(result.size(), 1U);
  const DepthImage& image = *result[0].image;
  EXPECT_EQ(image.stamp, kStart);
  EXPECT_EQ(image.camera, "camera");
  EXPECT_EQ(image.image_index, 0U);
  ASSERT_EQ(image.depth.type(), CV_32FC1);
  ASSERT_EQ(image.depth.size(), cv::Size(101, 81));
  for (int row = 0; row < 81; ++row) {
    // A point every 0.05 m at 10 m is one every half pixel: no holes.
    for (int column = 0; column < 101; ++column) EXPECT_FLOAT_EQ(image.depth.at<float>(row, column), 10.0F);
  }
}

TEST(DepthStage, W18_nearObjectHidesFarWall) {
  for (const bool near_first : {true, false}) {
    Inputs inputs = standing();
    const auto object = sweepOf(wall(5.0, 0.5, 0.5, 0.02), kStart - 40 * kMillisecond);
    const auto back = sweepOf(wall(10.0, 8.0, 8.0, 0.05), kStart - 20 * kMillisecond);
    inputs.sweeps = {near_first ? object : sweepOf(back->sweep->points, kStart - 40 * kMillisecond),
                     near_first ? back : sweepOf(object->sweep->points, kStart - 20 * kMillisecond)};
    DepthStage stage(params());
    const cv::Mat depth = answers(stage, inputs)[0].image->depth;
    EXPECT_FLOAT_EQ(depth.at<float>(40, 50), 5.0F);
    EXPECT_FLOAT_EQ(depth.at<float>(40 + 9, 50 + 9), 5.0F);  // 0.5 m at 5 m: 10 px
    EXPECT_FLOAT_EQ(depth.at<float>(40, 50 + 12), 10.0F);
  }
}

// The car drives towards the wall: the image is made at the pose interpolated at its own stamp, from points
// kept in map.
TEST(DepthStage, W6_usesThePoseOfTheImage) {
  Inputs inputs = standing();
  inputs.odometry.clear();
  for (int i = -50; i <= 50; ++i)
    inputs.odometry.push_back(odometry(kStart + i * 10 * kMillisecond, {i * 0.2, 0, 0}));
  inputs.sweeps = {sweepOf(wall(30.0, 20.0, 20.0, 0.05), kStart - 300 * kMillisecond)};
  inputs.infos = {{simpleInfo("camera", kStart + 104 * kMillisecond)}};
  DepthStage stage(params());
  const auto result = answers(stage, inputs);
  // 20 m/s * 0.104 s = 2.08 m
  EXPECT_NEAR(result[0].image->depth.at<float>(40, 50), 30.0 - 2.08, 1e-4);
}

TEST(DepthStage, sweepsAfterTheImageAndBeforeTheWindowAreNotSeen) {
  Inputs inputs = standing();
  inputs.odometry = {odometry(kStart - kSecond / 4), odometry(kStart + kSecond / 8)};
  inputs.sweeps = {sweepOf(wall(7.0, 8, 8, 0.05), kStart - kSecond / 2),  // exactly at the open end
                   sweepOf(wall(9.0, 8, 8, 0.05), kStart), sweepOf(wall(5.0, 8, 8, 0.05), kStart + 1)};
  for (unsigned seed = 0; seed < 20; ++seed) {
    DepthStage stage(params());
    EXPECT_FLOAT_EQ(answers(stage, inputs, seed)[0].image->depth.at<float>(40, 50), 9.0F);
  }
}

// A car has driven away from 6 m to 9 m while the window was filled, measured by lines 10 px apart.
TEST(DepthStage, whatHasMovedAwayIsNotSeen) {
  const auto car = [](double x, double shift) {
    std::vector<LidarPoint> points;
    for (int line = -3; line <= 3; ++line) {
      for (int i = -30; i <= 30; ++i) points.push_back(point(x, 0.01 * i * x, (0.1 * line + shift) * x));
    }
    return points;
  };
  Inputs inputs = standing();
  inputs.sweeps = {sweepOf(car(6.0, 0.0), kStart - 300 * kMillisecond),
                   sweepOf(car(9.0, 0.05), kStart + 40 * kMillisecond)};
  DepthParams p = params();
  p.look_ahead_s = 0.1;
  p.line_gap_deg = 7.0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    DepthStage stage(p);
    const cv::Mat depth = answers(stage, inputs, seed)[0].image->depth;
    EXPECT_FLOAT_EQ(depth.at<float>(45, 50), 9.0F);
    EXPECT_TRUE(std::isnan(depth.at<float>(40, 50))) << depth.at<float>(40, 50);
  }
  p.hide_occluded = false;
  DepthStage all(p);
  EXPECT_FLOAT_EQ(answers(all, inputs)[0].image->depth.at<float>(40, 50), 6.0F);
}

TEST(DepthStage, confidenceComesWithEveryImage) {
  Inputs inputs = standing();
  inputs.sweeps = {sweepOf(wall(10.0, 3.0, 3.0, 0.3), kStart)};  // a point every 3 px
  DepthParams p = params();
  p.fill_gap_m = 0.5;
  p.line_gap_deg = 3.0;
  DepthStage stage(p);
  std::vector<Answer> confidence;
  stage.on_confidence = [&](std::size_t camera, const DepthImagePtr& image) {
    confidence.push_back({camera, image});
  };
  const auto result = answers(stage, inputs);
  ASSERT_EQ(confidence.size(), 1U);
  EXPECT_EQ(confidence[0].image->stamp, kStart);
  const cv::Mat &depth = result[0].image->depth, &sure = confidence[0].image->depth;
  EXPECT_EQ(sure.at<float>(40, 50), 1.0F);
  EXPECT_GT(sure.at<float>(40, 51), 0.0F);
  EXPECT_LT(sure.at<float>(40, 51), 1.0F);
  EXPECT_EQ(sure.at<float>(0, 0), 0.0F);
  for (int row = 0; row < depth.rows; ++row) {
    for (int column = 0; column < depth.cols; ++column)
      EXPECT_EQ(std::isnan(depth.at<float>(row, column)), sure.at<float>(row, column) == 0.0F);
  }
}

TEST(DepthStage, W12_unknownIsNaNAndCounted) {
  const auto check = [](const std::function<void(Inputs&)>& change, const std::string& counter) {
    Inputs inputs = standing();
    change(inputs);
    DepthStage stage(params());
    const auto result = answers(stage, inputs);
    ASSERT_EQ(result.size(), 1U) << counter;
    EXPECT_EQ(result[0].image->depth.size(), cv::Size(101, 81)) << counter;
    EXPECT_EQ(knownPixels(result[0].image->depth), 0U) << counter;
    EXPECT_EQ(stage.counters().get(counter), 1U) << counter;
  };
  check([](Inputs& i) { i.odometry.clear(); }, "skipped depth image: no pose yet");
  check([](Inputs& i) { i.odometry.pop_back(); }, "skipped depth image: gap between poses");
  check([](Inputs& i) { i.odometry[1].stamp += kSecond; }, "skipped depth image: gap between poses");
  check([](Inputs& i) { i.sweeps.clear(); }, "skipped depth image: no points");
}

TEST(DepthStage, unusableCameraInfoGivesNoImage) {
  Inputs inputs = standing();
  inputs.infos[0][0].K = {};
  DepthStage stage(params());
  const auto result = answers(stage, inputs);
  ASSERT_EQ(result.size(), 1U);
  EXPECT_TRUE(result[0].image->depth.empty());
  EXPECT_EQ(stage.counters().get("skipped depth image: camera_info missing or zero"), 1U);
}

TEST(DepthStage, missingExtrinsicsAreCounted) {
  Inputs inputs = standing();
  DepthStage stage(params());
  std::vector<Answer> result;
  stage.on_depth = [&](std::size_t camera, const DepthImagePtr& image) { result.push_back({camera, image}); };
  stage.push(0, rig({}));
  for (const Odometry& o : inputs.odometry) stage.push(o);
  stage.push(0, inputs.sweeps[0]);
  stage.push(0, inputs.infos[0][0]);
  for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
  ASSERT_EQ(result.size(), 1U);
  EXPECT_EQ(knownPixels(result[0].image->depth), 0U);
  EXPECT_EQ(stage.counters().get("skipped depth image: no extrinsic calibration for the frame"), 1U);
}

// Two cameras, moving car: whatever order the inputs arrive in, the same images in the same order.
TEST(DepthStage, arrivalOrderHasNoInfluence) {
  Inputs inputs;
  for (int i = 0; i < 60; ++i)
    inputs.odometry.push_back(odometry(kStart + i * 10 * kMillisecond, {i * 0.1, 0.01 * i, 0}));
  for (int i = 0; i < 6; ++i) {
    inputs.sweeps.push_back(sweepOf(wall(20.0 - i, 3.0, 3.0, 0.3, i * 0.1), kStart + i * 100 * kMillisecond));
  }
  inputs.infos.resize(2);
  for (int i = 0; i < 15; ++i) inputs.infos[0].push_back(simpleInfo("a", kStart + i * 33 * kMillisecond));
  for (int i = 0; i < 8; ++i) inputs.infos[1].push_back(simpleInfo("b", kStart + i * 66 * kMillisecond));
  std::vector<Answer> first;
  std::map<std::string, std::uint64_t> first_counts;
  for (unsigned seed = 0; seed < 25; ++seed) {
    DepthStage stage(params({"a", "b"}));
    const auto result = answers(stage, inputs, seed);
    ASSERT_EQ(result.size(), 23U);
    if (seed == 0) {
      first = result;
      first_counts = stage.counters().all();
      EXPECT_GT(knownPixels(first.back().image->depth), 100U);
      for (std::size_t i = 1; i < first.size(); ++i)
        EXPECT_LE(first[i - 1].image->stamp, first[i].image->stamp);
    }
    EXPECT_EQ(stage.counters().all(), first_counts);
    for (std::size_t i = 0; i < result.size(); ++i) {
      ASSERT_EQ(result[i].camera, first[i].camera);
      ASSERT_EQ(result[i].image->stamp, first[i].image->stamp);
      ASSERT_EQ(result[i].image->image_index, first[i].image->image_index);
      const cv::Mat &a = result[i].image->depth, &b = first[i].image->depth;
      ASSERT_EQ(std::memcmp(a.data, b.data, a.total() * a.elemSize()), 0)
          << "seed " << seed << " image " << i;
    }
  }
}

TEST(DepthStage, progressIsHeldBackByTheImageThatWaits) {
  DepthStage stage(params());
  std::size_t count = 0;
  stage.on_depth = [&](std::size_t, const DepthImagePtr&) { ++count; };
  stage.push(0, rig({{"camera", forwardCamera()}}));
  stage.finish(DepthStage::kTfStatic);
  stage.push(odometry(kStart));
  stage.finish(stage.lidarInput(0));
  stage.push(0, simpleInfo("camera", kStart + 5));
  stage.advance(stage.cameraInfoInput(0), kStart + 100);
  stage.advance(DepthStage::kOdometry, kStart + 5);
  EXPECT_EQ(count, 0U);
  EXPECT_LT(stage.progress(), kStart + 5);
  stage.push(odometry(kStart + 50));
  EXPECT_EQ(count, 1U);
  EXPECT_GE(stage.progress(), kStart + 5);
}

TEST(DepthStage, refusesBadParameters) {
  DepthParams p = params();
  p.window_s = 0.0;
  EXPECT_THROW(DepthStage{p}, std::invalid_argument);
  p = params();
  p.max_depth_m = 0.1;
  EXPECT_THROW(DepthStage{p}, std::invalid_argument);
  p = params({});
  EXPECT_THROW(DepthStage{p}, std::invalid_argument);
  p = params();
  p.line_gap_deg = 0;
  EXPECT_THROW(validate(p), std::invalid_argument);
  p = params();
  p.surface_step = 1.0;
  EXPECT_THROW(validate(p), std::invalid_argument);
}

}  // namespace
}  // namespace atlas::test
