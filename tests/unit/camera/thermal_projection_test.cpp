// SPDX-License-Identifier: MIT
#include "atlas/camera/thermal_projection.hpp"

#include <gtest/gtest.h>

#include "atlas/camera/frustum.hpp"
#include "scene.hpp"

namespace atlas::test {
namespace {

CameraModel simpleModel() { return CameraModel::fromInfo(simpleInfo()).value(); }

// In the optical frame of the camera, which is also map here: a front plane at z with the given half sizes.
Frustum frustumAt(const Eigen::Vector3d& center, double half_width, double half_height) {
  Frustum f;
  f.detection.class_id = 7;
  f.detection.confidence = 0.75;
  const double w = half_width, h = half_height;
  const std::array<Eigen::Vector3d, 4> around = {Eigen::Vector3d(-w, -h, 0), Eigen::Vector3d(w, -h, 0),
                                                 Eigen::Vector3d(w, h, 0), Eigen::Vector3d(-w, h, 0)};
  for (std::size_t i = 0; i < 4; ++i) {
    f.corners[i] = center + around[i];
    f.corners[i + 4] = f.corners[i] * (center.z() + 1.0) / center.z();
  }
  return f;
}

TEST(ProjectFront, byHand) {
  const BoxInImage seen = projectFront(frustumAt({1, -1, 10}, 1.0, 0.5), simpleModel(), Pose(), {});
  ASSERT_EQ(seen.loss, BoxLoss::kNone);
  EXPECT_NEAR(seen.box.x_min, 50.0, 1e-9);
  EXPECT_NEAR(seen.box.x_max, 70.0, 1e-9);
  EXPECT_NEAR(seen.box.y_min, 25.0, 1e-9);
  EXPECT_NEAR(seen.box.y_max, 35.0, 1e-9);
  EXPECT_EQ(seen.box.class_id, 7);
  EXPECT_EQ(seen.box.confidence, 0.75);
}

TEST(ProjectFront, lossesHaveTheirReasons) {
  const ThermalBoxLimits limits{3.0, 0.3};
  const CameraModel model = simpleModel();
  EXPECT_EQ(projectFront(frustumAt({0, 0, -5}, 1, 1), model, Pose(), limits).loss, BoxLoss::kBehindCamera);
  EXPECT_EQ(projectFront(frustumAt({50, 0, 10}, 1, 1), model, Pose(), limits).loss, BoxLoss::kOutsideImage);
  EXPECT_EQ(projectFront(frustumAt({0, 0, 100}, 1, 1), model, Pose(), limits).loss, BoxLoss::kTooSmall);
  // 4 m wide around the left edge of the image at x = -5 m: a half is visible, then a quarter.
  const BoxInImage half = projectFront(frustumAt({-5, 0, 10}, 2, 1), model, Pose(), limits);
  ASSERT_EQ(half.loss, BoxLoss::kNone);
  EXPECT_EQ(half.box.x_min, -0.5);
  EXPECT_NEAR(half.box.x_max, 20.0, 1e-9);
  EXPECT_EQ(projectFront(frustumAt({-6, 0, 10}, 2, 1), model, Pose(), limits).loss, BoxLoss::kMostlyOutside);
}

// A vehicle alongside: one side of its front plane is behind the camera. What is in front decides, and
// nothing is mirrored.
TEST(ProjectFront, planeThroughTheCameraDoesNotMirror) {
  Frustum f = frustumAt({1.5, 0, 4}, 1, 1);
  f.corners[1].z() = f.corners[2].z() = -2.0;
  const BoxInImage seen = projectFront(f, simpleModel(), Pose(), {3.0, 0.0});
  ASSERT_EQ(seen.loss, BoxLoss::kNone);
  EXPECT_NEAR(seen.box.x_min, 50.0 + 100.0 * 0.5 / 4.0, 1e-9);
  EXPECT_EQ(seen.box.x_max, 100.5);
}

// From the RGB camera to the thermal camera of the dataset: the box must be where the object's own corners
// are seen.
TEST(ProjectFront, fromRgbToThermalThroughBothLenses) {
  const CameraModel rgb = CameraModel::fromInfo(leftFrontInfo()).value();
  const CameraModel ir = CameraModel::fromInfo(irInfo()).value();
  const Pose T_imu_rgb = forwardCamera({0.46, 0.34, 0.0}), T_imu_ir = forwardCamera({0.46, 0.24, 0.0});
  // A plate 2 m x 1.6 m, 15 m in front, 3 m to the left, 0.5 m down.
  const Eigen::Vector3d center(15.46, 3.0, -0.5);
  Eigen::Vector2d rgb_low(1e9, 1e9), rgb_high(-1e9, -1e9), ir_low(1e9, 1e9), ir_high(-1e9, -1e9);
  for (const double y : {-1.0, 1.0}) {
    for (const double z : {-0.8, 0.8}) {
      const Eigen::Vector3d p_imu = center + Eigen::Vector3d(0, y, z);
      const Eigen::Vector2d in_rgb = rgb.project(T_imu_rgb.inverse() * p_imu).value();
      const Eigen::Vector2d in_ir = ir.project(T_imu_ir.inverse() * p_imu).value();
      rgb_low = rgb_low.cwiseMin(in_rgb);
      rgb_high = rgb_high.cwiseMax(in_rgb);
      ir_low = ir_low.cwiseMin(in_ir);
      ir_high = ir_high.cwiseMax(in_ir);
    }
  }
  const Detection2d box{rgb_low.x(), rgb_low.y(), rgb_high.x(), rgb_high.y(), 2, 0.9};
  const Frustum frustum = makeFrustum(box, {15.0, 0.1}, 1.0, rgb, T_imu_rgb).value();
  const BoxInImage seen = projectFront(frustum, ir, T_imu_ir.inverse(), {});
  ASSERT_EQ(seen.loss, BoxLoss::kNone);
  // Distortion turns the plate into a barrel, so its bounding box grows by under a pixel per image.
  EXPECT_NEAR(seen.box.x_min, ir_low.x(), 1.0);
  EXPECT_NEAR(seen.box.x_max, ir_high.x(), 1.0);
  EXPECT_NEAR(seen.box.y_min, ir_low.y(), 1.0);
  EXPECT_NEAR(seen.box.y_max, ir_high.y(), 1.0);
}

}  // namespace
}  // namespace atlas::test
