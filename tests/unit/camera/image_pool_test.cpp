// SPDX-License-Identifier: MIT
#include "atlas/camera/image_pool.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace atlas::test {
namespace {

constexpr int kWidth = 7, kHeight = 5;

TEST(ImagePool, anImageThatIsHeldIsNotGivenAgain) {
  ImagePool pool;
  std::vector<cv::Mat> held;
  for (int i = 0; i < 20; ++i) held.push_back(pool.take({kWidth, kHeight}, static_cast<float>(i)));
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(cv::countNonZero(held[static_cast<std::size_t>(i)] != static_cast<float>(i)), 0) << i;
}

TEST(ImagePool, anImageThatNobodyHoldsIsGivenAgainAndIsClean) {
  ImagePool pool;
  const float* memory = nullptr;
  {
    cv::Mat image = pool.take({kWidth, kHeight}, 0.0F);
    image.at<float>(2, 3) = 4.0F;
    memory = image.ptr<float>();
  }
  const cv::Mat again = pool.take({kWidth, kHeight}, 1.0F);
  EXPECT_EQ(again.ptr<float>(), memory);
  EXPECT_EQ(cv::countNonZero(again != 1.0F), 0);
}

TEST(ImagePool, sizesDoNotMix) {
  ImagePool pool;
  pool.take({kWidth, kHeight}, 0.0F);
  EXPECT_EQ(pool.take({kHeight, kWidth}, 0.0F).size(), cv::Size(kHeight, kWidth));
}

}  // namespace
}  // namespace atlas::test
