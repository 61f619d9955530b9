// SPDX-License-Identifier: MIT
#include "atlas/localization/positioning_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace atlas {
namespace {

std::string messageOf(const PositioningParams& params) {
  try {
    validate(params);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

TEST(PositioningFilter, MadeByName) {
  Counters counters;
  EXPECT_NE(makePositioningFilter("kalman_1d", {}, Eigen::Vector3d::Zero(), {}, counters), nullptr);
}

TEST(PositioningFilter, UnknownNameIsRefusedWithTheKnownOnes) {
  Counters counters;
  try {
    makePositioningFilter("kalman_2d", {}, Eigen::Vector3d::Zero(), {}, counters);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("kalman_1d"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("'kalman_2d'"), std::string::npos);
  }
}

TEST(PositioningFilter, DefaultsAreValid) { EXPECT_EQ(messageOf({}), ""); }

TEST(PositioningFilter, WrongValueIsNamed) {
  PositioningParams params;
  params.tilt_time_constant_s = -2.5;
  EXPECT_EQ(messageOf(params), "positioning: need tilt_time_constant_s > 0, got -2.5");
  params = {};
  params.gnss_horizontal_sigma_m = std::nan("");
  EXPECT_NE(messageOf(params).find("gnss_horizontal_sigma_m"), std::string::npos);
  params = {};
  params.max_consecutive_rejections = 0;
  EXPECT_EQ(messageOf(params), "positioning: need max_consecutive_rejections >= 1, got 0");
  params = {};
  params.gnss_heading_slow_share = 1.0;
  EXPECT_NE(messageOf(params).find("gnss_heading_slow_share"), std::string::npos);
}

}  // namespace
}  // namespace atlas
