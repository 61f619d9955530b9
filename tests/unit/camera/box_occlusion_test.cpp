// SPDX-License-Identifier: MIT
#include "atlas/camera/box_occlusion.hpp"

#include <gtest/gtest.h>

namespace atlas::test {
namespace {

constexpr double kSize = 80.0;  // px, so cells of 10 px

BoxOcclusion view(double front_m = 20.0) {
  Detection2d box;
  box.x_max = box.y_max = kSize;
  return {box, front_m, {}};
}
/// One point in the middle of every cell of the columns [from, to).
void fill(BoxOcclusion& view, int from, int to, float depth_m) {
  for (int row = 0; row < 8; ++row) {
    for (int column = from; column < to; ++column)
      view.add({10.0F * static_cast<float>(column) + 5.0F, 10.0F * static_cast<float>(row) + 5.0F, depth_m});
  }
}

TEST(BoxOcclusion, shareOfTheCellsBehindSomethingNearer) {
  BoxOcclusion object = view();
  fill(object, 0, 8, 20.0F);
  EXPECT_EQ(object.hiddenShare(), 0.0);
  fill(object, 0, 6, 12.0F);  // the object still shines through beside the points of what is nearer
  EXPECT_EQ(object.hiddenShare(), 0.75);
}

// 1 m and 3 % of 20 m before the object is still taken as part of it.
TEST(BoxOcclusion, theObjectItselfHidesNothing) {
  BoxOcclusion object = view();
  fill(object, 0, 8, 18.41F);
  EXPECT_EQ(object.hiddenShare(), 0.0);
  fill(object, 0, 8, 18.39F);
  EXPECT_EQ(object.hiddenShare(), 1.0);
}

TEST(BoxOcclusion, cellsWithoutPointsSayNothing) {
  BoxOcclusion object = view();
  EXPECT_FALSE(object.hiddenShare().has_value());
  for (const float u : {5.0F, 15.0F, 25.0F}) object.add({u, 5.0F, 3.0F});
  EXPECT_FALSE(object.hiddenShare().has_value()) << "three cells are too few";
  object.add({35.0F, 5.0F, 3.0F});
  EXPECT_EQ(object.hiddenShare(), 1.0);
}

TEST(BoxOcclusion, pointsBesideTheBoxDoNotCount) {
  BoxOcclusion object = view();
  fill(object, 0, 1, 20.0F);
  for (const float at : {-0.1F, 80.0F, 500.0F}) {
    object.add({at, 5.0F, 3.0F});
    object.add({5.0F, at, 3.0F});
  }
  EXPECT_EQ(object.hiddenShare(), 0.0);
}

}  // namespace
}  // namespace atlas::test
