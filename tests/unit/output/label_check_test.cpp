// SPDX-License-Identifier: MIT
#include "atlas/output/label_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace atlas {
namespace {

TEST(LabelCheck, everyReasonAndNone) {
  EXPECT_EQ(whyNoLabel({10, 10, 20, 20, 79, 0.5}, 640, 512), nullptr);
  EXPECT_EQ(whyNoLabel({-10, -10, 5, 5, 0, 0.5}, 640, 512), nullptr);  // cut by the border is still there
  EXPECT_STREQ(whyNoLabel({10, 10, 20, 20, 80, 0.5}, 640, 512), "unknown class id");
  EXPECT_STREQ(whyNoLabel({10, 10, 20, 20, -1, 0.5}, 640, 512), "unknown class id");
  EXPECT_STREQ(whyNoLabel({10, 10, std::nan(""), 20, 0, 0.5}, 640, 512), "not finite");
  EXPECT_STREQ(whyNoLabel({10, 10, 20, 20, 0, std::nan("")}, 640, 512), "not finite");
  EXPECT_STREQ(whyNoLabel({700, 10, 720, 20, 0, 0.5}, 640, 512), "outside the image");
  EXPECT_STREQ(whyNoLabel({20, 10, 10, 20, 0, 0.5}, 640, 512), "outside the image");
}

}  // namespace
}  // namespace atlas
