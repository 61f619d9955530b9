// SPDX-License-Identifier: MIT
#include "atlas/camera/camera_window.hpp"

#include <gtest/gtest.h>

#include "scene.hpp"

namespace atlas::test {
namespace {

BatchedSweepPtr sweepAfter(int milliseconds) {
  return sweepOf({point(5, 0, 0)}, kStart + milliseconds * kMillisecond);
}

TEST(CameraWindow, holdsTheSweepsOfItsLengthBeforeAnImage) {
  CameraWindow window(500 * kMillisecond);
  for (int i = 0; i <= 6; ++i) window.push(sweepAfter(100 * i));
  EXPECT_EQ(window.size(), 5U) << "(100 ms, 600 ms]";
  const auto seen = window.since(kStart + 750 * kMillisecond);
  ASSERT_EQ(seen.size(), 4U) << "(250 ms, ...]";
  EXPECT_EQ(seen.front()->stamp, kStart + 300 * kMillisecond);
  EXPECT_EQ(seen.front()->batches.size(), 1U);
  EXPECT_TRUE(window.since(kStart + 2 * kSecond).empty());
}

TEST(CameraWindow, aSweepWithoutPoseIsNotKeptButTimePasses) {
  CameraWindow window(500 * kMillisecond);
  window.push(sweepAfter(0));
  auto no_pose = std::make_shared<BatchedSweep>(*sweepAfter(500));
  no_pose->batches.clear();
  window.push(no_pose);
  EXPECT_EQ(window.size(), 0U);
}

TEST(CameraWindow, anHourNeedsNoMoreThanASecond) {
  CameraWindow window(500 * kMillisecond);
  for (int i = 0; i < 36000; ++i) {
    window.push(sweepAfter(100 * i));
    ASSERT_LE(window.size(), 5U);
  }
}

}  // namespace
}  // namespace atlas::test
