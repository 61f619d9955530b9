// SPDX-License-Identifier: MIT
#include "atlas/camera/point_colours.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "scene.hpp"

namespace atlas {
namespace {

using namespace test;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

struct Scene {
  CameraInfo info = leftFrontInfo();
  CameraModel model = *CameraModel::fromInfo(info);
  cv::Mat bgr{model.height(), model.width(), CV_8UC3, cv::Scalar(1, 2, 3)};
  cv::Mat depth{model.height(), model.width(), CV_32FC1, cv::Scalar(kNone)};
  cv::Mat confidence{model.height(), model.width(), CV_32FC1, cv::Scalar(0)};
  Pose T_map_camera{fromRollPitchYaw({-1.5, 0.1, 0.7}), Eigen::Vector3d(100, -50, 2)};
};

TEST(PointColours, AMeasuredPixelIsThePlaceThatProjectsIntoIt) {
  Scene s;
  PixelBearings bearings(s.model);
  struct Case {
    int row, column;
    float depth_m;
  };
  for (const Case& c : {Case{0, 0, 5.0F}, Case{600, 960, 12.5F}, Case{1199, 1919, 60.0F}}) {
    s.depth.setTo(kNone);
    s.confidence.setTo(0);
    s.depth.at<float>(c.row, c.column) = c.depth_m;
    s.confidence.at<float>(c.row, c.column) = 1.0F;
    s.bgr.at<cv::Vec3b>(c.row, c.column) = {10, 20, 30};
    const auto points = pointColours(s.bgr, s.depth, s.confidence, s.T_map_camera, bearings);
    ASSERT_EQ(points.size(), 1U);
    const ColouredPoint& p = points[0];
    EXPECT_EQ(std::vector<int>({p.red, p.green, p.blue}), std::vector<int>({30, 20, 10}));
    EXPECT_EQ(p.depth_m, c.depth_m);
    const Eigen::Vector3d p_camera = s.T_map_camera.inverse() * Eigen::Vector3d(p.x, p.y, p.z);
    EXPECT_NEAR(p_camera.z(), static_cast<double>(c.depth_m), 1e-4);
    const auto pixel = s.model.project(p_camera);
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - Eigen::Vector2d(c.column, c.row)).norm(), 0.01);
  }
}

TEST(PointColours, FilledGapsAndUnknownDepthsHaveNoPlace) {
  Scene s;
  PixelBearings bearings(s.model);
  s.depth.at<float>(5, 5) = 7.0F;
  s.confidence.at<float>(5, 5) = 0.6F;  // between two measured ones
  s.confidence.at<float>(6, 6) = 1.0F;  // no depth
  EXPECT_TRUE(pointColours(s.bgr, s.depth, s.confidence, s.T_map_camera, bearings).empty());
}

TEST(PointColours, ImagesOfAnotherSizeAreABug) {
  Scene s;
  PixelBearings bearings(s.model);
  const cv::Mat smaller(600, 960, CV_8UC3);
  EXPECT_THROW((void)pointColours(smaller, s.depth, s.confidence, s.T_map_camera, bearings),
               std::logic_error);
}

}  // namespace
}  // namespace atlas
