// SPDX-License-Identifier: MIT
#include "atlas_ros/carried.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace atlas_ros {
namespace {

struct Text {
  std::string text;
};
using TextConstPtr = boost::shared_ptr<const Text>;
using Value = std::shared_ptr<const int>;

TEST(Carried, TheValueTravelsWithTheMessageAndEndsWithIt) {
  const auto value = std::make_shared<const int>(42);
  TextConstPtr message = carrying(Text{"forty-two"}, Value(value));
  boost::shared_ptr<const void> untyped = message;  // as roscpp passes it on
  message.reset();
  TextConstPtr received = boost::static_pointer_cast<const Text>(untyped);
  untyped.reset();
  EXPECT_EQ(received->text, "forty-two");
  ASSERT_NE(carriedBy<Value>(received), nullptr);
  EXPECT_EQ(*carriedBy<Value>(received), value);
  EXPECT_EQ(value.use_count(), 2);
  received.reset();
  EXPECT_EQ(value.use_count(), 1);
}

TEST(Carried, NothingIsTakenFromAMessageThatCarriesNothing) {
  EXPECT_EQ(carriedBy<Value>(TextConstPtr(boost::make_shared<Text>())), nullptr) << "received by a socket";
  EXPECT_EQ(carriedBy<Value>(TextConstPtr(carrying(Text{"pi"}, 3.14))), nullptr) << "another type";
  EXPECT_EQ(carriedBy<Value>(TextConstPtr()), nullptr);
}

}  // namespace
}  // namespace atlas_ros
