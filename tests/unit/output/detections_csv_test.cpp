// SPDX-License-Identifier: MIT
#include "atlas/output/detections_csv.hpp"

#include <gtest/gtest.h>

namespace atlas {
namespace {

TEST(DetectionRows, sevenColumnsWithTheBoxCentre) {
  Detections detections;
  detections.image_index = 42;
  detections.boxes = {
      {127.5, 95.5, 191.5, 159.5, 2, 0.8189}, {-10, 0, -5, 10, 1, 0.5}, {-0.5, -0.5, 639.5, 511.5, 0, 1.0}};
  EXPECT_EQ(detectionRows(detections, 640, 512),
            "42, 0.250000, 0.250000, 0.100000, 0.125000, 0.818900, 2\n"
            "42, 0.500000, 0.500000, 1.000000, 1.000000, 1.000000, 0\n");
}

}  // namespace
}  // namespace atlas
