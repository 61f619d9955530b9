// SPDX-License-Identifier: MIT
#include "atlas/camera/pixel_set.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace atlas::test {
namespace {

using Places = std::vector<std::pair<int, int>>;

Places placesOf(const PixelSet& pixels) {
  Places result;
  pixels.forEach([&](int row, int column) { result.emplace_back(row, column); });
  return result;
}

// 63 and 64 lie in different words of a row, 129 in the last, shorter one.
TEST(PixelSet, rowByRowFromLeftToRight) {
  PixelSet pixels(130, 3);
  const Places places = {{0, 0}, {0, 63}, {0, 64}, {0, 129}, {2, 5}};
  for (auto place = places.rbegin(); place != places.rend(); ++place) pixels.add(place->first, place->second);
  pixels.add(2, 5);
  EXPECT_EQ(placesOf(pixels), places);
  pixels.remove(0, 64);
  pixels.remove(1, 1);
  EXPECT_EQ(placesOf(pixels), (Places{{0, 0}, {0, 63}, {0, 129}, {2, 5}}));
}

TEST(PixelSet, joinedAndCleared) {
  PixelSet a(70, 2), b(70, 2);
  a.add(0, 1);
  b.add(0, 1);
  b.add(1, 69);
  a.add(b);
  EXPECT_EQ(placesOf(a), (Places{{0, 1}, {1, 69}}));
  a.clear();
  EXPECT_TRUE(placesOf(a).empty());
}

TEST(PixelSet, endsOfColumnsHaveNothingAboveOrBelow) {
  PixelSet pixels(70, 4);
  for (const int row : {0, 1, 3}) pixels.add(row, 65);
  pixels.add(1, 2);
  Places tops, bottoms;
  for (int row = 0; row < 4; ++row) {
    pixels.forEachEndInRow(row, -1, [&](int column) { tops.emplace_back(row, column); });
    pixels.forEachEndInRow(row, 1, [&](int column) { bottoms.emplace_back(row, column); });
  }
  EXPECT_EQ(tops, (Places{{0, 65}, {1, 2}, {3, 65}}));
  EXPECT_EQ(bottoms, (Places{{1, 2}, {1, 65}, {3, 65}}));
}

TEST(PixelSet, pixelsMayBeRemovedWhileTheyAreVisited) {
  PixelSet pixels(70, 1);
  for (int column = 0; column < 70; ++column) pixels.add(0, column);
  int visited = 0;
  pixels.forEachInRow(0, [&](int column) {
    ++visited;
    if (column % 2 == 0) pixels.remove(0, column);
  });
  EXPECT_EQ(visited, 70);
  EXPECT_EQ(placesOf(pixels).size(), 35U);
}

}  // namespace
}  // namespace atlas::test
