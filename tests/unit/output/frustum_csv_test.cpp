// SPDX-License-Identifier: MIT
#include "atlas/output/frustum_csv.hpp"

#include <gtest/gtest.h>

namespace atlas {
namespace {

TEST(FrustumCsv, oneRowPerFrustum) {
  EXPECT_EQ(frustumCsvHeader(), "stamp,frame,detection,class,confidence,distance,x,y,z\n");
  Frustums frustums;
  frustums.stamp = 1568186745453388439;
  frustums.image_index = 7;
  EXPECT_EQ(frustumCsvRows(frustums), "");
  Frustum f;
  f.corners.fill(Eigen::Vector3d::Zero());
  f.detection_index = 3;
  f.detection.class_id = 2;
  f.detection.confidence = 0.81;
  f.distance_m = 20.25;
  f.position = {1.0, -2.5, 0.125};
  frustums.frustums = {f};
  EXPECT_EQ(frustumCsvRows(frustums), "1568186745453388439,7,3,2,0.8100,20.2500,1.0000,-2.5000,0.1250\n");
}

}  // namespace
}  // namespace atlas
