// SPDX-License-Identifier: MIT
#include "atlas/base/spilled_list.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

namespace atlas {
namespace {

struct Element {
  std::size_t number = 0;
  std::array<double, 1000> values{};  // 31 in a block
};
constexpr std::size_t kCount = 1000;  // 33 blocks

SpillParams small() { return {std::filesystem::path(::testing::TempDir()) / "spilled_list", 1}; }

void fill(SpilledList<Element>& list) {
  for (std::size_t i = 0; i < kCount; ++i) {
    Element& element = list.append();
    ASSERT_EQ(element.number, 0u) << "not of an element that was there before";
    element.number = i;
    element.values[i] = 0.5 * static_cast<double>(i);
  }
}

TEST(SpilledList, ForwardsAndBackwardsEveryElementIsThere) {
  SpilledList<Element> list(small());
  fill(list);
  EXPECT_TRUE(list.spilled());
  ASSERT_EQ(list.size(), kCount);
  for (std::size_t i = 0; i < kCount; ++i) ASSERT_EQ(list[i].number, i);
  for (std::size_t i = kCount; i-- > 0;) ASSERT_EQ(list[i].values[i], 0.5 * static_cast<double>(i)) << i;
}

TEST(SpilledList, ChangesGoToTheFileAndComeBack) {
  SpilledList<Element> list(small());
  fill(list);
  for (std::size_t i = kCount; i-- > 0;) list.change(i).values[i] += 1.0;
  for (std::size_t i = 0; i < kCount; ++i)
    ASSERT_EQ(list[i].values[i], 0.5 * static_cast<double>(i) + 1.0) << i;
}

TEST(SpilledList, TwoNeighboursCanBeHeldAtATime) {
  SpilledList<Element> list(small());
  fill(list);
  for (std::size_t i = 0; i + 1 < kCount; ++i) {
    const Element& before = list[i];
    const Element& after = list[i + 1];
    ASSERT_EQ(before.number + 1, after.number);
    ASSERT_EQ(before.number, i);
  }
}

TEST(SpilledList, SmallOrWithoutFolderItStaysInMemory) {
  SpilledList<Element> roomy({small().folder, 100'000'000}), nowhere({"", 1});
  fill(roomy);
  fill(nowhere);
  EXPECT_FALSE(roomy.spilled());
  EXPECT_FALSE(nowhere.spilled());
  EXPECT_EQ(nowhere[kCount - 1].number, kCount - 1);
}

TEST(SpilledList, ClearedItBeginsAnew) {
  SpilledList<Element> list(small());
  fill(list);
  list.clear();
  EXPECT_FALSE(list.spilled());
  EXPECT_EQ(list.size(), 0u);
  EXPECT_THROW(list.change(0).number = 1, std::logic_error);
  fill(list);
  EXPECT_EQ(list[kCount / 2].number, kCount / 2);
}

}  // namespace
}  // namespace atlas
