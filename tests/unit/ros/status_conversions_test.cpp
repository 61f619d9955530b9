// SPDX-License-Identifier: MIT
// Messages of the sensor monitor and of traceability: both ways unchanged.
#include <gtest/gtest.h>

#include "atlas_ros/conversions.hpp"

namespace {

constexpr atlas::Stamp kStamp = 1568186745408734467;

TEST(SensorStatus, RoundTripIsExact) {
  const atlas::SensorStatus status{
      kStamp,
      "gnss",
      0.1 + 0.2,
      {{"gap", 1.0 / 3.0, 1.7, "periods", kStamp - 5}, {"frozen", 4, 3, "s", kStamp - 7}}};
  const atlas::SensorStatus back = atlas_ros::fromMsg(atlas_ros::toMsg(status));
  EXPECT_EQ(back.stamp, status.stamp);
  EXPECT_EQ(back.sensor, status.sensor);
  EXPECT_EQ(back.score, status.score);
  ASSERT_EQ(back.anomalies.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(back.anomalies[i].name, status.anomalies[i].name);
    EXPECT_EQ(back.anomalies[i].value, status.anomalies[i].value);
    EXPECT_EQ(back.anomalies[i].threshold, status.anomalies[i].threshold);
    EXPECT_EQ(back.anomalies[i].unit, status.anomalies[i].unit);
    EXPECT_EQ(back.anomalies[i].since, status.anomalies[i].since);
  }
}

TEST(ProductOrigins, RoundTripIsExactAndWhatIsUnknownStaysUnknown) {
  const atlas::ProductOrigins product{"objects/17",
                                      4000000000U,
                                      kStamp,
                                      {{"lidar_left/batches", kStamp - 1, 0U, {}},
                                       {"obstacles", kStamp - 2, {}, 0U},
                                       {"odometry", kStamp, {}, {}}}};
  const atlas::ProductOrigins back = atlas_ros::fromMsg(atlas_ros::toMsg(product));
  EXPECT_EQ(back.product, product.product);
  EXPECT_EQ(back.index, product.index);
  EXPECT_EQ(back.stamp, product.stamp);
  ASSERT_EQ(back.origins.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.origins[i].topic, product.origins[i].topic);
    EXPECT_EQ(back.origins[i].stamp, product.origins[i].stamp);
    EXPECT_EQ(back.origins[i].index, product.origins[i].index);
    EXPECT_EQ(back.origins[i].item, product.origins[i].item);
  }
}

}  // namespace
