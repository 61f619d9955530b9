// SPDX-License-Identifier: MIT
#include "atlas/output/yolo.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace atlas {
namespace {

Detections one(double x_min, double y_min, double x_max, double y_max, std::int32_t class_id = 2) {
  Detections detections;
  detections.boxes = {{x_min, y_min, x_max, y_max, class_id, 0.9}};
  return detections;
}

// W16: x by the width, y by the height. The published program divides the height of the box by the image's
// width: 64 / 640.
TEST(Yolo, W16_everyNumberIsDividedByItsOwnDimension) {
  // centre (160, 128) from the image's corner, size 64 x 64 in 640 x 512
  EXPECT_EQ(yoloLabels(one(127.5, 95.5, 191.5, 159.5), 640, 512), "2 0.250000 0.250000 0.100000 0.125000\n");
}

// W16: y clipped by the height, not by the width (a box down to row 600 of 512 stays legal when cut at 640).
TEST(Yolo, W16_clippedToTheImage) {
  EXPECT_EQ(yoloLabels(one(-100, 255.5, 63.5, 600), 640, 512), "2 0.050000 0.750000 0.100000 0.500000\n");
  EXPECT_EQ(yoloLabels(one(-10, -10, 1000, 1000), 640, 512), "2 0.500000 0.500000 1.000000 1.000000\n");
}

// The centre of the first pixel is pixel 0, so its edges are -1/2 and 1/2: half a pixel, had it been
// forgotten, is 0.4 % of the width of a box of 128 px, at the one side only after clipping.
TEST(Yolo, thePixelInTheCornerIsOnePixelLarge) {
  EXPECT_EQ(yoloLabels(one(-0.5, -0.5, 0.5, 0.5), 100, 50), "2 0.005000 0.010000 0.010000 0.020000\n");
  EXPECT_EQ(yoloLabels(one(98.5, 48.5, 99.5, 49.5), 100, 50), "2 0.995000 0.990000 0.010000 0.020000\n");
  const auto whole = normalized({-0.5, -0.5, 99.5, 49.5, 0, 1}, 100, 50);
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->width, 1.0);
  EXPECT_EQ(whole->height, 1.0);
}

TEST(Yolo, whatIsNotInTheImageHasNoLine) {
  EXPECT_EQ(yoloLabels(one(-20, 10, -0.5, 20), 640, 512), "");
  EXPECT_EQ(yoloLabels(one(10, 511.5, 20, 530), 640, 512), "");
  EXPECT_EQ(yoloLabels(one(20, 10, 10, 20), 640, 512), "");
  EXPECT_EQ(yoloLabels(one(std::nan(""), 10, 20, 20), 640, 512), "");
  EXPECT_EQ(yoloLabels(one(0, 10, std::numeric_limits<double>::infinity(), 20), 640, 512), "");
  EXPECT_EQ(yoloLabels(Detections(), 640, 512), "");
}

TEST(Yolo, aLinePerBoxInTheirOrder) {
  Detections detections = one(-0.5, -0.5, 319.5, 255.5, 7);
  detections.boxes.push_back({319.5, 255.5, 639.5, 511.5, 0, 0.5});
  EXPECT_EQ(yoloLabels(detections, 640, 512),
            "7 0.250000 0.250000 0.500000 0.500000\n0 0.750000 0.750000 0.500000 0.500000\n");
}

}  // namespace
}  // namespace atlas
