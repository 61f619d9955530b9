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
  // centre (160, 128), size 64 x 64 in 640 x 512
  EXPECT_EQ(yoloLabels(one(128, 96, 192, 160), 640, 512), "2 0.250000 0.250000 0.100000 0.125000\n");
}

// W16: y clipped by the height, not by the width (a box down to row 600 of 512 stays legal when cut at 640).
TEST(Yolo, W16_clippedToTheImage) {
  EXPECT_EQ(yoloLabels(one(-100, 256, 64, 600), 640, 512), "2 0.050000 0.750000 0.100000 0.500000\n");
  EXPECT_EQ(yoloLabels(one(-10, -10, 1000, 1000), 640, 512), "2 0.500000 0.500000 1.000000 1.000000\n");
}

TEST(Yolo, whatIsNotInTheImageHasNoLine) {
  EXPECT_EQ(yoloLabels(one(-20, 10, 0, 20), 640, 512), "");
  EXPECT_EQ(yoloLabels(one(10, 512, 20, 530), 640, 512), "");
  EXPECT_EQ(yoloLabels(one(20, 10, 10, 20), 640, 512), "");
  EXPECT_EQ(yoloLabels(one(std::nan(""), 10, 20, 20), 640, 512), "");
  EXPECT_EQ(yoloLabels(one(0, 10, std::numeric_limits<double>::infinity(), 20), 640, 512), "");
  EXPECT_EQ(yoloLabels(Detections(), 640, 512), "");
}

TEST(Yolo, aLinePerBoxInTheirOrder) {
  Detections detections = one(0, 0, 320, 256, 7);
  detections.boxes.push_back({320, 256, 640, 512, 0, 0.5});
  EXPECT_EQ(yoloLabels(detections, 640, 512),
            "7 0.250000 0.250000 0.500000 0.500000\n0 0.750000 0.750000 0.500000 0.500000\n");
}

}  // namespace
}  // namespace atlas
