// SPDX-License-Identifier: MIT
#include "atlas/camera/frustum_merge.hpp"

#include <gtest/gtest.h>

#include "scene.hpp"

namespace atlas::test {
namespace {

Frustum at(double x, double y, int class_id, std::uint32_t points, double sigma = 0.02) {
  Frustum f;
  f.position = {x, y, 0};
  f.detection.class_id = class_id;
  f.points = points;
  f.depth_sigma_m = sigma;
  for (Eigen::Vector3d& corner : f.corners) corner = f.position;
  return f;
}
Frustums image(std::vector<Frustum> frustums, std::uint32_t index = 0) {
  Frustums result;
  result.stamp = kStart;
  result.image_index = index;
  result.frustums = std::move(frustums);
  return result;
}

TEST(MergeDuplicates, oneObjectOfTwoCamerasIsOneFrustum) {
  const Frustums merged =
      mergeDuplicates({image({at(10, 2, 2, 50), at(30, 0, 2, 8)}, 7), image({at(10.4, 2.3, 2, 400)}, 8)}, {});
  EXPECT_EQ(merged.stamp, kStart);
  EXPECT_EQ(merged.image_index, 7U);
  ASSERT_EQ(merged.frustums.size(), 2U);
  EXPECT_EQ(merged.frustums[0].points, 400U) << "the one with more points stays";
  EXPECT_EQ(merged.frustums[1].points, 8U);
}

TEST(MergeDuplicates, whatIsDifferentStays) {
  EXPECT_EQ(mergeDuplicates({image({at(10, 2, 2, 50)}), image({at(10, 2, 0, 50)})}, {}).frustums.size(), 2U)
      << "class";
  EXPECT_EQ(mergeDuplicates({image({at(10, 2, 0, 50), at(10.3, 2, 0, 50)})}, {}).frustums.size(), 2U)
      << "two people side by side in one image";
  EXPECT_EQ(mergeDuplicates({image({at(10, 2, 2, 50)}), image({at(12, 2, 2, 50)})}, {}).frustums.size(), 2U)
      << "place";
  EXPECT_EQ(mergeDuplicates({image({at(10, 2, 2, 50, 0.4)}), image({at(12, 2, 2, 50)})}, {}).frustums.size(),
            1U)
      << "as near as its own uncertainty";
  EXPECT_TRUE(mergeDuplicates({}, {}).frustums.empty());
}

}  // namespace
}  // namespace atlas::test
