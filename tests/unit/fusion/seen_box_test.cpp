// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "atlas/fusion/box_measurement.hpp"
#include "track_shapes.hpp"

namespace atlas {
namespace {

using test::car;
using test::residual;

TEST(SeenBox, OnlyTheRearOfACarIsWhereItSeems) {
  // the sensor at the origin sees 0.4 m of the rear of a car whose middle is at 20 m
  const Obstacle seen{{20.0 - 2.2 + 0.2, 0.0, 0.8}, 0.0, {0.4, 1.8, 1.5}, 50};
  const TrackShape track = car(20.0, 0.0);
  const Measured measured = SeenBox(seen, Eigen::Vector3d::Zero(), {}).measured(track);
  for (std::size_t i = 0; i < measured.rows.size(); ++i)
    EXPECT_LT(std::abs(residual(measured.rows[i], track)), 1e-9)
        << "row " << i << ": the car is where it was";
  const Rows anchor = SeenBox(seen, Eigen::Vector3d::Zero(), {}).anchor(track);
  EXPECT_LT(distanceOf(track.state, anchor).mahalanobis_sq, 1e-9);
}

TEST(SeenBox, AHiddenEndIsABound) {
  // a car seen from the side, its front behind something: 2 m of it are left
  const Obstacle cut{{-1.2, 10.0, 0.8}, 0.0, {2.0, 1.8, 1.5}, 50};
  const TrackShape track = car(0.0, 10.0);
  SeenBox::Hidden right;
  right.right = true;  // seen from the origin, looking along y, +x is to the right
  const Measured known = SeenBox(cut, Eigen::Vector3d::Zero(), right).measured(track);
  const Measured taken = SeenBox(cut, Eigen::Vector3d::Zero(), {}).measured(track);
  EXPECT_EQ(known.rows.size() + 1, taken.rows.size());
}

TEST(SeenBox, TheLongerSideMayBeTheWidth) {
  // the rear alone, fitted with its long side across: yaw of the box is a quarter turn off
  const Obstacle seen{{18.0, 0.0, 0.8}, 0.5 * M_PI, {1.8, 0.4, 1.5}, 50};
  const Measured measured = SeenBox(seen, Eigen::Vector3d::Zero(), {}).measured(car(20.0, 0.0));
  ASSERT_TRUE(measured.yaw.has_value());
  EXPECT_NEAR(std::remainder(measured.yaw->yaw_rad, M_PI), 0.0, 1e-9);
}

}  // namespace
}  // namespace atlas
