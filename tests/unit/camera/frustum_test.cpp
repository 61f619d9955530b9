// SPDX-License-Identifier: MIT
#include "atlas/camera/frustum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene.hpp"

namespace atlas::test {
namespace {

Detection2d box(double x_min, double y_min, double x_max, double y_max) {
  Detection2d result;
  result.x_min = x_min;
  result.y_min = y_min;
  result.x_max = x_max;
  result.y_max = y_max;
  return result;
}

TEST(RobustDepth, isTheTrueMedian) {
  std::vector<float> odd = {9.0F, 1.0F, 3.0F};
  EXPECT_EQ(robustDepth(odd)->median_m, 3.0);
  std::vector<float> even = {8.0F, 1.0F, 5.0F, 2.0F};  // the published program takes the upper one, 5
  EXPECT_EQ(robustDepth(even)->median_m, 3.5);
  std::vector<float> one = {4.0F};
  EXPECT_EQ(robustDepth(one)->median_m, 4.0);
  std::vector<float> none;
  EXPECT_EQ(robustDepth(none).reason(), Reason::kNoPoints);
}

// sigma is what repeated measurements of the median scatter by.
TEST(RobustDepth, sigmaIsTheScatterOfTheMedian) {
  std::mt19937 random(3);
  std::normal_distribution<float> noise(20.0F, 0.5F);
  double sum_sq = 0.0, sigma_sum = 0.0;
  constexpr int kRuns = 2000;
  for (int run = 0; run < kRuns; ++run) {
    std::vector<float> depths(51);
    for (float& depth : depths) depth = noise(random);
    const RobustDepth depth = robustDepth(depths).value();
    sum_sq += std::pow(depth.median_m - 20.0, 2);
    sigma_sum += depth.sigma_m;
  }
  const double scatter = std::sqrt(sum_sq / kRuns);  // known to 1/sqrt(2 * 2000) = 1.6 %
  EXPECT_NEAR(sigma_sum / kRuns, scatter, 0.1 * scatter);
}

TEST(RobustDepth, oneOutlierInFourDoesNotMoveIt) {
  std::vector<float> depths = {10.0F, 10.1F, 9.9F, 10.0F, 70.0F};
  EXPECT_NEAR(robustDepth(depths)->median_m, 10.0, 1e-6);
}

TEST(ClipToImage, keepsThePartInside) {
  const CameraModel model = CameraModel::fromInfo(simpleInfo()).value();
  const auto clipped = clipToImage(box(-20, 10, 30, 200), model);
  ASSERT_TRUE(clipped);
  EXPECT_EQ(clipped->x_min, -0.5);
  EXPECT_EQ(clipped->x_max, 30);
  EXPECT_EQ(clipped->y_max, 80.5);
  EXPECT_EQ(clipToImage(box(-20, 10, -5, 20), model).reason(), Reason::kEmpty);
  EXPECT_EQ(clipToImage(box(30, 10, 20, 20), model).reason(), Reason::kEmpty);
  EXPECT_EQ(clipToImage(box(std::nan(""), 10, 20, 20), model).reason(), Reason::kNotFinite);
}

TEST(MakeFrustum, byHand) {
  const CameraModel model = CameraModel::fromInfo(simpleInfo()).value();
  const Pose T_map_camera = {Eigen::Quaterniond::Identity(), {100, 0, 0}};
  const Frustum f = makeFrustum(box(40, 30, 60, 50), {20.0, 0.1}, 1.0, model, T_map_camera).value();
  // Corner (40, 30) has the bearing (-0.1, -0.1, 1).
  EXPECT_TRUE(f.corners[0].isApprox(Eigen::Vector3d(98, -2, 20), 1e-12));
  EXPECT_TRUE(f.corners[1].isApprox(Eigen::Vector3d(102, -2, 20), 1e-12));
  EXPECT_TRUE(f.corners[2].isApprox(Eigen::Vector3d(102, 2, 20), 1e-12));
  EXPECT_TRUE(f.corners[3].isApprox(Eigen::Vector3d(98, 2, 20), 1e-12));
  EXPECT_TRUE(f.corners[6].isApprox(Eigen::Vector3d(102.1, 2.1, 21), 1e-12));
  EXPECT_TRUE(f.position.isApprox(Eigen::Vector3d(100, 0, 20), 1e-12));
  EXPECT_EQ(f.range_m, 20.0);
}

// W13: an object at 20 m stays at 20 m at the image's border; taking its z-depth for its range puts it
// at 15.5..17.8 m.
TEST(MakeFrustum, W13_depthIsKeptAtTheBorderOfEveryCamera) {
  for (const CameraInfo& info : budCameras()) {
    const CameraModel model = CameraModel::fromInfo(info).value();
    const Detection2d corner = box(0, 0, 0.06 * model.width(), 0.06 * model.height());
    const Frustum f = makeFrustum(corner, {20.0, 0.1}, 1.0, model, Pose()).value();
    EXPECT_NEAR(f.position.z(), 20.0, 1e-12) << info.frame;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(f.corners[i].z(), 20.0, 1e-12) << info.frame;
    EXPECT_GT(f.range_m, 1.1 * 20.0) << info.frame;
    EXPECT_NEAR(f.range_m, f.position.norm(), 1e-12);
    // And the corners are seen where the box was.
    const auto pixel = model.project(f.corners[2]);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(pixel->x(), corner.x_max, 1e-6);
    EXPECT_NEAR(pixel->y(), corner.y_max, 1e-6);
  }
}

}  // namespace
}  // namespace atlas::test
