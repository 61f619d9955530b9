// SPDX-License-Identifier: MIT
#include "atlas/fusion/measurement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "atlas/fusion/box_measurement.hpp"
#include "atlas/fusion/point_measurement.hpp"
#include "atlas/fusion/radar_sign.hpp"
#include "track_shapes.hpp"

namespace atlas {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

using test::car;
using test::residual;

TEST(Measurements, ThoseThatMakeNoSenseSayWhy) {
  Obstacle box{{1.0, 2.0, 0.5}, 0.1, {4.0, 2.0, 1.5}, 10};
  EXPECT_FALSE(SeenBox(box, Eigen::Vector3d::Zero(), {}).defect().has_value());
  box.size.x() = -4.0;
  EXPECT_EQ(SeenBox(box, Eigen::Vector3d::Zero(), {}).defect(), Reason::kBadLayout);
  EXPECT_EQ(WholeBox(box, {}).defect(), Reason::kBadLayout);
  box.size.x() = kNan;
  EXPECT_EQ(SeenBox(box, Eigen::Vector3d::Zero(), {}).defect(), Reason::kNotFinite);
  EXPECT_EQ(WholeBox(box, {}).defect(), Reason::kNotFinite);
  Frustum frustum;
  frustum.position = {kNan, 0.0, 0.0};
  EXPECT_EQ(FrustumMeasurement(frustum).defect(), Reason::kNotFinite);
  EXPECT_EQ(RadarMeasurement({1.0, 0.0, 0.0}, Eigen::Vector3d::Zero(), kNan).defect(), Reason::kNotFinite);
  EXPECT_EQ(RadarMeasurement({0.0, kNan, 0.0}, Eigen::Vector3d::Zero(), std::nullopt).defect(),
            Reason::kNotFinite);
}

TEST(RadarMeasurement, NearSurfaceAndRadialVelocity) {
  TrackShape track = car(20.0, 0.0);
  track.state.mean(kVx) = -7.0;
  const Measured measured = RadarMeasurement({17.8, 0.0, 0.5}, {0.0, 0.0, 0.5}, -7.0).measured(track);
  ASSERT_EQ(measured.rows.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(residual(measured.rows[i], track), 0.0, 1e-6);
  EXPECT_FALSE(RadarMeasurement({5.0, 0.0, 0.0}, Eigen::Vector3d::Zero(), 0.2).birth().has_value())
      << "standing clutter begins nothing";
  EXPECT_TRUE(RadarMeasurement({5.0, 0.0, 0.0}, Eigen::Vector3d::Zero(), 5.0).birth().has_value());
}

TEST(RadarSign, ToldByWhatStandsStill) {
  for (const double convention : {1.0, -1.0}) {
    RadarSign sign;
    for (int i = 0; i < 30; ++i) {
      EXPECT_FALSE(i < 15 && sign.sign().has_value()) << "a few targets do not decide";
      sign.add(convention * -8.0, -8.0);                 // stands while the vehicle approaches
      if (i % 5 == 0) sign.add(convention * 8.0, -8.0);  // one that drives away twice as fast
      sign.add(0.0, 0.1);                                // the vehicle hardly moves: says nothing
      sign.add(kNan, -8.0);
    }
    ASSERT_TRUE(sign.sign().has_value());
    EXPECT_EQ(*sign.sign(), convention);
  }
}

}  // namespace
}  // namespace atlas
