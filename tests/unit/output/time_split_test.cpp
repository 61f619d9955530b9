// SPDX-License-Identifier: MIT
#include "atlas/output/time_split.hpp"

#include <gtest/gtest.h>

namespace atlas {
namespace {

TEST(TimeSplit, wholeBlocksInTheirShares) {
  std::array<int, 3> blocks{};
  for (int block = 0; block < 100; ++block) {
    const Stamp begin = (1568186745 / 10 * 10 + 10 * block) * kSecond;
    const Split split = splitOf(begin, 10 * kSecond);
    EXPECT_EQ(splitOf(begin + 10 * kSecond - 1, 10 * kSecond), split);
    ++blocks[static_cast<std::size_t>(split)];
  }
  EXPECT_EQ(blocks, (std::array<int, 3>{70, 20, 10}));
  EXPECT_STREQ(nameOf(splitOf(0, kSecond)), "val");
  EXPECT_STREQ(nameOf(splitOf(7 * kSecond, kSecond)), "test");
  EXPECT_STREQ(nameOf(splitOf(8 * kSecond, kSecond)), "train");
}

}  // namespace
}  // namespace atlas
