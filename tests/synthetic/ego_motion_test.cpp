// SPDX-License-Identifier: MIT
// The route of the synthetic drive: where it stands still, and for how long.
#include "synthetic/ego_motion.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "synthetic/world.hpp"

namespace atlas::synthetic {
namespace {

/// Begin and end of every standstill, s.
std::vector<std::pair<double, double>> standstills(const EgoMotion& ego, double until_s) {
  std::vector<std::pair<double, double>> found;
  bool before = false;
  for (int i = 0; i * 0.1 < until_s; ++i) {
    const double t = i * 0.1;
    const bool stands = ego.speed(t) < 1e-9;
    if (stands && !before) found.emplace_back(t, t);
    if (stands) found.back().second = t;
    before = stands;
  }
  return found;
}

TEST(EgoMotion, AStopIsLongerAndTheRouteIsTheSame) {
  const EgoMotion usual(200.0, 9.81), stopped(200.0, 9.81, {40.0, 70.0});
  const auto a = standstills(usual, 120.0), b = standstills(stopped, 190.0);
  ASSERT_GE(a.size(), 4u);
  ASSERT_EQ(a.size(), b.size());
  std::size_t longer = 0;
  while (longer < a.size() && a[longer].first < 40.0) ++longer;
  ASSERT_LT(longer + 1, a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_NEAR(b[i].first - a[i].first, i > longer ? 70.0 : 0.0, 1e-6) << i;
    EXPECT_NEAR((b[i].second - b[i].first) - (a[i].second - a[i].first), i == longer ? 70.0 : 0.0, 0.11) << i;
  }
  const double after_s = a[longer].second + 5.0;  // the same place, later
  EXPECT_NEAR((usual.T_city_imu(after_s).translation - stopped.T_city_imu(after_s + 70.0).translation).norm(),
              0.0, 1e-9);
}

TEST(EgoMotion, AStopOutOfRangeIsRefused) {
  DriveOptions options;
  options.stop_for_s = -1.0;
  EXPECT_THROW(validate(options), std::invalid_argument);
  options.stop_for_s = 60.0;
  options.stop_at_s = -1.0;
  EXPECT_THROW(validate(options), std::invalid_argument);
}

}  // namespace
}  // namespace atlas::synthetic
