// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "atlas/fusion/box_measurement.hpp"

namespace atlas {
namespace {

TEST(WholeBox, SaysPlaceSizeAndHeading) {
  const WholeBox box({{10.0, -3.0, 0.8}, 0.4, {4.2, 1.7, 1.5}, 0}, {});
  const TrackBirth birth = *box.birth();
  EXPECT_TRUE(birth.heading_known);
  EXPECT_NEAR(birth.shape.yaw_rad, 0.4, 1e-12);
  const Measured measured = box.measured(birth.shape);
  ASSERT_EQ(measured.rows.size(), 4U);
  for (std::size_t i = 0; i < measured.rows.size(); ++i)
    EXPECT_NEAR(measured.rows[i].z, measured.rows[i].h.dot(birth.shape.state.mean), 1e-12) << "row " << i;
  EXPECT_NEAR(box.mismatch(birth.shape), 0.0, 1e-12);
  TrackShape truck = birth.shape;
  truck.state.mean(kLength) = 11.0;
  EXPECT_GT(box.mismatch(truck), 5.0) << "a car is no part of a truck";
}

}  // namespace
}  // namespace atlas
