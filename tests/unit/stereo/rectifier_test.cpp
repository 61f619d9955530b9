// SPDX-License-Identifier: MIT
#include "atlas/stereo/rectifier.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace atlas::test {
namespace {

CameraInfo cameraOf(const std::string& frame, double focal_px = 500.0) {
  CameraInfo info;
  info.frame = frame;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.distortion.assign(5, 0.0);
  info.K = {focal_px, 0, 319.5, 0, focal_px, 239.5, 0, 0, 1};
  return info;
}

void setBaselineInP(CameraInfo& right, double baseline_m) {
  const auto& K = right.K;
  right.P = {K[0], 0, K[2], -K[0] * baseline_m, 0, K[4], K[5], 0, 0, 0, 1, 0};
}

std::string refusalOf(const CameraInfo& left, const CameraInfo& right,
                      const std::optional<Pose>& T_left_right) {
  try {
    const Rectifier rectifier(left, right, T_left_right);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

Pose placeOf(double x, double y, double z, const Eigen::Vector3d& rotation_rad = Eigen::Vector3d::Zero()) {
  return {expSo3(rotation_rad), {x, y, z}};
}

TEST(Rectifier, WhatIsRectifiedPassesUntouched) {
  CameraInfo left = cameraOf("left"), right = cameraOf("right");
  setBaselineInP(left, 0.0);
  setBaselineInP(right, 0.25);
  const cv::Mat image(480, 640, CV_8UC1, cv::Scalar(7));
  for (const Rectifier& rectifier :
       {Rectifier(left, right, std::nullopt),
        Rectifier(cameraOf("left"), cameraOf("right"), placeOf(0.25, 0.0, 0.0))}) {
    EXPECT_TRUE(rectifier.untouched());
    EXPECT_EQ(rectifier.left(image).data, image.data);
    EXPECT_DOUBLE_EQ(rectifier.rig().focal_px, 500.0);
    EXPECT_DOUBLE_EQ(rectifier.rig().u0_px, 319.5);
    EXPECT_NEAR(rectifier.rig().baseline_m, 0.25, 1e-12);
  }
}

/// Where a point is in a camera's image, drawn as a spot.
cv::Mat spotAt(const CameraInfo& info, const Eigen::Vector3d& p_camera) {
  std::vector<cv::Point2d> pixel;
  cv::Mat K(3, 3, CV_64F, const_cast<double*>(info.K.data()));
  cv::projectPoints(std::vector<cv::Point3d>{{p_camera.x(), p_camera.y(), p_camera.z()}}, cv::Vec3d(),
                    cv::Vec3d(), K, info.distortion, pixel);
  cv::Mat image(480, 640, CV_32FC1);
  for (int v = 0; v < image.rows; ++v)
    for (int u = 0; u < image.cols; ++u) {
      const double away_sq = (u - pixel[0].x) * (u - pixel[0].x) + (v - pixel[0].y) * (v - pixel[0].y);
      image.at<float>(v, u) = static_cast<float>(200.0 * std::exp(-away_sq / 18.0));
    }
  image.convertTo(image, CV_8UC1);
  return image;
}

Eigen::Vector2d middleOf(const cv::Mat& spot) {
  const cv::Moments moments = cv::moments(spot);
  EXPECT_GT(moments.m00, 0.0);
  return {moments.m10 / moments.m00, moments.m01 / moments.m00};
}

/// Two lenses that bend, not parallel: afterwards a point lies in the same row, and its disparity and place
/// in the left image say where it is.
TEST(Rectifier, PutsAPointIntoTheSameRow) {
  CameraInfo left = cameraOf("left"), right = cameraOf("right", 510.0);
  left.distortion = {-0.2, 0.05, 0.001, -0.001, 0.0};
  right.distortion = {-0.18, 0.04, -0.001, 0.0005, 0.0};
  const Pose T_left_right = placeOf(0.3, 0.01, -0.02, {0.02, -0.03, 0.015});
  const Rectifier rectifier(left, right, T_left_right);
  ASSERT_FALSE(rectifier.untouched());
  const StereoRig& rig = rectifier.rig();
  EXPECT_NEAR(rig.baseline_m, T_left_right.translation.norm(), 1e-9);
  for (const Eigen::Vector3d& p_left :
       {Eigen::Vector3d(0.3, -0.2, 4.0), {-0.8, 0.6, 5.0}, {1.0, 0.3, 6.0}, {0.0, 0.0, 3.0}}) {
    const Eigen::Vector2d in_left = middleOf(rectifier.left(spotAt(left, p_left)));
    const Eigen::Vector2d in_right =
        middleOf(rectifier.right(spotAt(right, T_left_right.inverse() * p_left)));
    EXPECT_NEAR(in_left.y(), in_right.y(), 0.2);
    const double depth_m = rig.depthOf(in_left.x() - in_right.x());
    const Eigen::Vector3d p_rectified((in_left.x() - rig.u0_px) / rig.focal_px * depth_m,
                                      (in_left.y() - rig.v0_px) / rig.focal_px * depth_m, depth_m);
    EXPECT_LT((rig.T_left_rectified * p_rectified - p_left).norm(), rig.depthSigma(p_left.z(), 0.3))
        << p_left.transpose();
  }
}

/// The same from the R and P that a calibration put into camera_info.
TEST(Rectifier, UsesTheRectificationInCameraInfo) {
  CameraInfo left = cameraOf("left"), right = cameraOf("right");
  left.distortion[0] = right.distortion[0] = -0.2;
  setBaselineInP(left, 0.0);
  setBaselineInP(right, 0.4);
  const Rectifier rectifier(left, right, std::nullopt);
  EXPECT_FALSE(rectifier.untouched());
  EXPECT_NEAR(rectifier.rig().baseline_m, 0.4, 1e-12);
  const Eigen::Vector3d p_left(0.5, 0.4, 4.0);
  const Eigen::Vector2d in_left = middleOf(rectifier.left(spotAt(left, p_left)));
  const Eigen::Vector2d in_right =
      middleOf(rectifier.right(spotAt(right, p_left - Eigen::Vector3d(0.4, 0.0, 0.0))));
  EXPECT_NEAR(in_left.x(), 319.5 + 500.0 * 0.5 / 4.0, 0.2);
  EXPECT_NEAR(in_left.x() - in_right.x(), 500.0 * 0.4 / 4.0, 0.2);
}

TEST(Rectifier, SaysWhyTwoCamerasMakeNoPair) {
  const CameraInfo left = cameraOf("left"), right = cameraOf("right");
  const auto expect = [&](const std::string& refusal, const std::string& why) {
    EXPECT_NE(refusal.find(why), std::string::npos) << "got: " << refusal;
  };
  expect(refusalOf(left, right, std::nullopt),
         "not rectified: P has no baseline, and the place of the right camera is unknown");
  expect(refusalOf(left, left, placeOf(0.2, 0, 0)), "both are the same camera");
  expect(refusalOf(left, right, placeOf(0, 0, 0)), "no baseline");
  expect(refusalOf(left, right, placeOf(0.05, 0.3, 0)), "they must stand side by side");
  expect(refusalOf(left, right, placeOf(-0.3, 0, 0)), "the right camera is on the left: exchange them");
  expect(refusalOf(left, right, placeOf(0.3, 0, 0, {0, 1.5, 0})), "they look in directions");
  CameraInfo wrong = right;
  wrong.width = 800;
  expect(refusalOf(left, wrong, placeOf(0.3, 0, 0)), "sizes differ: 640x480 and 800x480");
  wrong = right;
  wrong.K[0] = 0;
  expect(refusalOf(left, wrong, placeOf(0.3, 0, 0)), "camera_info of 'right' has no focal length or size");
  wrong = right;
  wrong.distortion_model = "equidistant";
  wrong.distortion = {0.1, 0, 0, 0};
  expect(refusalOf(left, wrong, placeOf(0.3, 0, 0)),
         "the lens model 'equidistant' of 'right' is not supported");
  CameraInfo exchanged_left = left, exchanged_right = right;
  setBaselineInP(exchanged_left, 0.25);
  setBaselineInP(exchanged_right, 0.0);
  expect(refusalOf(exchanged_left, exchanged_right, std::nullopt), "the right camera is on the left by P");
}

}  // namespace
}  // namespace atlas::test
