// SPDX-License-Identifier: MIT
#include "atlas/output/overlay.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace atlas {
namespace {

TEST(Overlay, nearIsRedAndFarIsBlue) {
  const cv::Mat image(60, 80, CV_8UC3, cv::Scalar(10, 10, 10));
  cv::Mat depth(60, 80, CV_32FC1, cv::Scalar(std::numeric_limits<float>::quiet_NaN()));
  depth.at<float>(20, 20) = 1.0F;
  depth.at<float>(40, 60) = 59.0F;
  const cv::Mat picture = drawDepth(image, depth);
  const auto near = picture.at<cv::Vec3b>(20, 20), far = picture.at<cv::Vec3b>(40, 60);
  EXPECT_GT(near[2], near[0]);
  EXPECT_GT(far[0], far[2]);
  EXPECT_EQ(picture.at<cv::Vec3b>(5, 5), cv::Vec3b(10, 10, 10));
  EXPECT_EQ(image.at<cv::Vec3b>(20, 20), cv::Vec3b(10, 10, 10));  // the input is not touched
  EXPECT_THROW(drawDepth(image, cv::Mat(10, 10, CV_32FC1)), std::invalid_argument);
}

TEST(Overlay, boxesAreDrawnAlsoOnGreyAndOutside) {
  const cv::Mat grey(120, 200, CV_8UC1, cv::Scalar(0));
  Frustums frustums;
  Frustum f;
  f.corners.fill(Eigen::Vector3d::Zero());
  f.detection = {60, 50, 120, 100, 2, 0.9};
  f.distance_m = 12.34;
  Frustum wild;
  wild.corners.fill(Eigen::Vector3d::Zero());
  wild.detection = {-1e12, 20, std::nan(""), 1e12, 0, 0.1};
  Frustum large;
  large.corners.fill(Eigen::Vector3d::Zero());
  large.detection = {-1e12, -1e12, 1e12, 1e12, -3, 0.1};
  frustums.frustums = {f, wild, large};
  const cv::Mat picture = drawFrustums(grey, frustums);
  ASSERT_EQ(picture.type(), CV_8UC3);
  EXPECT_NE(picture.at<cv::Vec3b>(80, 60), cv::Vec3b(0, 0, 0));   // left edge
  EXPECT_NE(picture.at<cv::Vec3b>(100, 90), cv::Vec3b(0, 0, 0));  // bottom edge
  EXPECT_EQ(picture.at<cv::Vec3b>(80, 90), cv::Vec3b(0, 0, 0));   // inside
  Detections detections;
  detections.boxes = {f.detection};
  EXPECT_NE(drawDetections(grey, detections).at<cv::Vec3b>(80, 60), cv::Vec3b(0, 0, 0));
}

}  // namespace
}  // namespace atlas
