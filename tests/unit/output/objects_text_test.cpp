// SPDX-License-Identifier: MIT
#include "atlas/output/objects_text.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace atlas {
namespace {

Objects oneCar() {
  Objects objects;
  objects.stamp = 1'500'000'000'100'000'000;
  objects.objects.emplace_back();
  Object& car = objects.objects.back();
  car.id = 17;
  car.class_id = 2;
  car.class_probability = 0.9;
  car.position = {20.0, 2.0, 0.75};
  car.size = {4.4, 1.8, 1.5};
  car.velocity_mps = {5.0, 0.0, 0.0};
  car.age_s = 1.25;
  return objects;
}

TEST(ObjectsText, CsvByHand) {
  EXPECT_EQ(objectsCsvHeader(),
            "stamp_ns,id,class,probability,x,y,z,yaw,length,width,height,vx,vy,vz,static,age\n");
  EXPECT_EQ(objectsCsvRows(oneCar()),
            "1500000000100000000,17,2,0.9000,20.0000,2.0000,0.7500,0.0000,4.4000,1.8000,1.5000,5.0000,0.0000,"
            "0.0000,0,1.250\n");
  EXPECT_EQ(objectsCsvRows({}), "");
}

TEST(ObjectsText, KittiRowOfAForwardCamera) {
  // x right, y down, z forward; the camera is 1.5 m above the ground
  Eigen::Matrix3d R;
  R << 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0;
  KittiCamera camera{{Eigen::Quaterniond(R), R * Eigen::Vector3d(0.0, 0.0, -1.5)}, std::nullopt};
  const auto row = kittiTrackingRow(3, oneCar().objects[0], camera);
  ASSERT_TRUE(row.has_value());
  EXPECT_EQ(row->substr(0, 13), "3 17 Car 0 0 ");
  // bottom centre 2 m to the left, 1.5 m below, 20 m ahead; heading forward = -pi/2 about y down
  EXPECT_NE(row->find(" 1.500000 1.800000 4.400000 -2.000000 1.500000 20.000000 -1.570796 "),
            std::string::npos)
      << *row;
  camera.projection.emplace();
  *camera.projection << 700.0, 0.0, 600.0, 0.0, 0.0, 700.0, 180.0, 0.0, 0.0, 0.0, 1.0, 0.0;
  EXPECT_TRUE(kittiTrackingRow(3, oneCar().objects[0], camera).has_value());
  Object behind = oneCar().objects[0];
  behind.position.x() = -20.0;
  EXPECT_FALSE(kittiTrackingRow(3, behind, camera).has_value());
  EXPECT_EQ(kittiType(-1), "Misc");
}

}  // namespace
}  // namespace atlas
