// SPDX-License-Identifier: MIT
#include "atlas/base/outcome.hpp"

#include <gtest/gtest.h>

#include <set>

#include "atlas/base/check.hpp"

namespace atlas {
namespace {

TEST(Outcome, ValueOrReason) {
  const Outcome<int> value = 3;
  ASSERT_TRUE(value);
  EXPECT_EQ(*value, 3);
  const Outcome<int> none = Reason::kPoseGap;
  EXPECT_FALSE(none);
  EXPECT_EQ(none.reason(), Reason::kPoseGap);
}

TEST(Outcome, ReadingWhatIsNotThereThrowsInEveryBuild) {
  const Outcome<int> none = Reason::kPoseGap;
  EXPECT_THROW((void)none.value(), std::logic_error);
  EXPECT_THROW((void)*none, std::logic_error);
}

TEST(Outcome, EveryReasonHasItsOwnText) {
  std::set<std::string> texts;
  constexpr int kReasons = static_cast<int>(Reason::kLowQuality) + 1;
  for (int i = 0; i < kReasons; ++i) texts.insert(toString(static_cast<Reason>(i)));
  EXPECT_EQ(texts.size(), static_cast<std::size_t>(kReasons));
  EXPECT_EQ(texts.count("unknown reason"), 0U);
}

TEST(Check, ThrowsWithPlaceAndMessage) {
  EXPECT_NO_THROW(ATLAS_CHECK(1 + 1 == 2, "arithmetic"));
  try {
    ATLAS_CHECK(false, "stamp 12 before 13");
    FAIL();
  } catch (const std::logic_error& error) {
    EXPECT_NE(std::string(error.what()).find("outcome_test.cpp"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("stamp 12 before 13"), std::string::npos);
  }
}

}  // namespace
}  // namespace atlas
