// SPDX-License-Identifier: MIT
#include "atlas/base/time.hpp"

#include <gtest/gtest.h>

namespace atlas {
namespace {

TEST(Time, SecondsAndBack) {
  EXPECT_EQ(fromSeconds(1.5), 1'500'000'000);
  EXPECT_EQ(fromSeconds(-0.25), -250'000'000);
  EXPECT_EQ(fromSeconds(1e-10), 0);
  EXPECT_DOUBLE_EQ(toSeconds(-2 * kMillisecond), -0.002);
}

TEST(Time, ExactToTheNanosecondForAnHourLongRecord) {
  for (Duration d = 0; d < 3600 * kSecond; d += 37 * kSecond + 123456789)
    EXPECT_EQ(fromSeconds(toSeconds(d)), d);
}

TEST(Time, NearestNanosecond) {
  EXPECT_EQ(fromSeconds(1.4e-9), 1);
  EXPECT_EQ(fromSeconds(1.6e-9), 2);
  EXPECT_EQ(fromSeconds(-1.6e-9), -2);
}

}  // namespace
}  // namespace atlas
