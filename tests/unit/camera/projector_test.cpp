// SPDX-License-Identifier: MIT
#include "atlas/camera/projector.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "atlas/camera/depth_buffer.hpp"
#include "scene.hpp"

namespace atlas::test {
namespace {

// The float path with its culling sees the same points at the same places as the model in double.
TEST(Projector, agreesWithTheModel) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> coordinate(-30.0F, 30.0F);
  for (const CameraInfo& info : budCameras()) {
    const CameraModel model = CameraModel::fromInfo(info).value();
    const Projector projector(model, 0.5, 25.0);
    const Pose T_camera_lidar = {fromRollPitchYaw({0.1, -0.2, 0.3}), {0.4, -0.1, 0.2}};
    int seen_count = 0;
    for (int i = 0; i < 20000; ++i) {
      const LidarPoint p = point(coordinate(random), coordinate(random), coordinate(random));
      const Eigen::Vector3d p_camera = T_camera_lidar * Eigen::Vector3d(p.x, p.y, p.z);
      const auto pixel = model.project(p_camera);
      const bool expected = pixel && model.inImage(*pixel) && p_camera.z() >= 0.5 && p_camera.z() <= 25.0;
      ProjectedPoint seen;
      const bool got = projector.project(T_camera_lidar.matrix34f(), p, seen);
      // Float: 1e-7 of 2000 px; a point this near to a bound may fall on either side.
      const bool on_bound =
          pixel && (std::abs(pixel->x() + 0.5) < 0.01 || std::abs(pixel->y() + 0.5) < 0.01 ||
                    std::abs(pixel->x() - model.width() + 0.5) < 0.01 ||
                    std::abs(pixel->y() - model.height() + 0.5) < 0.01);
      if (!on_bound) {
        ASSERT_EQ(got, expected) << info.frame << " " << p_camera.transpose();
      }
      if (!got || !expected) continue;
      ++seen_count;
      EXPECT_NEAR(seen.u, pixel->x(), 0.005);
      EXPECT_NEAR(seen.v, pixel->y(), 0.005);
      EXPECT_NEAR(seen.depth_m, p_camera.z(), 1e-5);
    }
    EXPECT_GT(seen_count, 500) << info.frame;
  }
}

TEST(Projector, neverSeesPointsWithoutReturn) {
  const Projector projector(CameraModel::fromInfo(simpleInfo()).value(), 0.5, 50.0);
  ProjectedPoint seen;
  const auto matrix = Pose().matrix34f();
  const double nan = std::nan("");
  EXPECT_TRUE(projector.project(matrix, point(0, 0, 5), seen));
  EXPECT_FALSE(projector.project(matrix, point(nan, nan, nan), seen));
  EXPECT_FALSE(projector.project(matrix, point(nan, 0, 5), seen));
  EXPECT_FALSE(projector.project(matrix, point(0, nan, 5), seen));
  EXPECT_FALSE(projector.project(matrix, point(0, 0, -5), seen));
  EXPECT_FALSE(projector.project(matrix, point(0, 0, 51), seen));
}

// A sweep stored laser by laser: the batch of each point is given by index, and its pose is the one that
// counts.
TEST(Projector, usesThePoseOfEachPointsBatch) {
  auto sweep = std::make_shared<BatchedSweep>(*sweepOf({point(0, 0, 5), point(0, 0, 5), point(0, 0, 5)}));
  Batch later = sweep->batches[0];
  later.T_map_lidar.translation = {0.0, 0.0, 2.0};
  sweep->batches.push_back(later);
  sweep->batch_of_point = {1, 0, 1};
  const Projector projector(CameraModel::fromInfo(simpleInfo()).value(), 0.5, 50.0);
  std::vector<float> depths;
  projector.projectSweep(*compacted(*sweep), Pose(),
                         [&](const ProjectedPoint& seen) { depths.push_back(seen.depth_m); });
  EXPECT_EQ(depths, (std::vector<float>{5.0F, 7.0F, 7.0F})) << "batch by batch";
}

// W18: the order of the points must not matter, the nearest one is what a camera would see.
TEST(DepthBuffer, W18_nearestWinsInAnyOrder) {
  for (const bool near_first : {true, false}) {
    DepthBuffer buffer(10, 8);
    buffer.add({4.2F, 3.4F, near_first ? 5.0F : 20.0F});
    buffer.add({3.8F, 2.6F, near_first ? 20.0F : 5.0F});
    const cv::Mat depth = buffer.image();
    EXPECT_EQ(depth.at<float>(3, 4), 5.0F);
    EXPECT_TRUE(std::isnan(depth.at<float>(3, 5)));
  }
}

// Points at the very border of the image have a pixel, too.
TEST(DepthBuffer, everyPointOfTheImageHasAPixel) {
  DepthBuffer buffer(6, 5);
  buffer.add({-0.5F, -0.5F, 9.0F});
  buffer.add({5.49F, 4.49F, 3.0F}, false);
  const cv::Mat depth = buffer.image();
  EXPECT_EQ(depth.at<float>(0, 0), 9.0F);
  EXPECT_EQ(depth.at<float>(4, 5), 3.0F);
  EXPECT_TRUE(std::isnan(depth.at<float>(1, 1)));
}

}  // namespace
}  // namespace atlas::test
