// SPDX-License-Identifier: MIT
#include "atlas/camera/pixel_box.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace atlas::test {
namespace {

bool inDouble(const Detection2d& box, float u, float v) {
  return u > box.x_min && u < box.x_max && v > box.y_min && v < box.y_max;
}

TEST(PixelBox, answersAsWithEdgesInDoubleDownToTheLastFloat) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> edge(-50.0, 2000.0);
  for (int i = 0; i < 1000; ++i) {
    Detection2d box;
    box.x_min = edge(random);
    box.x_max = box.x_min + std::abs(edge(random));
    box.y_min = edge(random);
    box.y_max = box.y_min + std::abs(edge(random));
    if (i % 3 == 0) box.x_min = static_cast<float>(box.x_min);  // edges that a point can lie on
    if (i % 5 == 0) box.y_max = static_cast<float>(box.y_max);
    const PixelBox pixels(box);
    for (const double u : {box.x_min, box.x_max}) {
      for (const double v : {box.y_min, box.y_max}) {
        for (int step = -2; step <= 2; ++step) {
          ProjectedPoint point{static_cast<float>(u), static_cast<float>(v), 1.0F};
          for (int s = 0; s < std::abs(step); ++s) {
            point.u = std::nextafter(point.u, step > 0 ? 1e9F : -1e9F);
            point.v = std::nextafter(point.v, step > 0 ? 1e9F : -1e9F);
          }
          const ProjectedPoint at_u{point.u, static_cast<float>(0.5 * (box.y_min + box.y_max)), 1.0F};
          const ProjectedPoint at_v{static_cast<float>(0.5 * (box.x_min + box.x_max)), point.v, 1.0F};
          EXPECT_EQ(pixels.holds(at_u), inDouble(box, at_u.u, at_u.v));
          EXPECT_EQ(pixels.holds(at_v), inDouble(box, at_v.u, at_v.v));
        }
      }
    }
  }
}

}  // namespace
}  // namespace atlas::test
