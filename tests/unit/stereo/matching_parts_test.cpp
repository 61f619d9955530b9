// SPDX-License-Identifier: MIT
// The parts of the matchers on cases worked out by hand.
#include <gtest/gtest.h>

#include <numeric>

#include "atlas/stereo/census.hpp"
#include "atlas/stereo/disparity_choice.hpp"
#include "atlas/stereo/disparity_image.hpp"
#include "atlas/stereo/refinement.hpp"
#include "scene.hpp"

namespace atlas::test {
namespace {

TEST(Census, SetsABitForEachDarkerNeighbour) {
  cv::Mat image(9, 9, CV_8UC1, cv::Scalar(100));
  image.at<std::uint8_t>(4, 4) = 150;  // all 16 are darker
  CensusImage bits = censusOf(image);
  EXPECT_EQ(bits.low.at<std::uint8_t>(4, 4), 0xFF);
  EXPECT_EQ(bits.high.at<std::uint8_t>(4, 4), 0xFF);
  EXPECT_EQ(bits.low.at<std::uint8_t>(4, 7), 0);  // none is darker
  image.at<std::uint8_t>(2, 2) = 200;             // now one is not: the first of the outer ones
  bits = censusOf(image);
  EXPECT_EQ(bits.low.at<std::uint8_t>(4, 4), 0xFE);
  EXPECT_EQ(censusOf(image + cv::Scalar(30)).low.at<std::uint8_t>(4, 4), 0xFE);  // brightness changes nothing
}

TEST(Census, HalvesOddImagesToo) {
  const cv::Mat image = (cv::Mat_<std::uint8_t>(3, 3) << 10, 20, 31, 30, 40, 51, 70, 90, 100);
  const cv::Mat half = halved(image);
  EXPECT_EQ(half.size(), cv::Size(2, 2));
  EXPECT_EQ(half.at<std::uint8_t>(0, 0), 25);
  EXPECT_EQ(half.at<std::uint8_t>(0, 1), 41);
  EXPECT_EQ(half.at<std::uint8_t>(1, 0), 80);
  EXPECT_EQ(half.at<std::uint8_t>(1, 1), 100);
}

/// Costs of a row of pixels: high everywhere but where a test says.
class Costs {
 public:
  Costs() : costs_(static_cast<std::size_t>(kWidth) * 32, 100) {}
  void set(int x, int d, int cost) {
    costs_[static_cast<std::size_t>(x * 32 + d)] = static_cast<std::uint16_t>(cost);
  }
  [[nodiscard]] std::int32_t chosen(int x, ChoiceParams params = {20, 1}, int range_px = 32) const {
    DisparityChoice choice(kWidth, {32, 0, range_px}, params);
    return choice.choose(costs_.data())[static_cast<std::size_t>(x)];
  }
  static constexpr int kWidth = 64;

 private:
  std::vector<std::uint16_t> costs_;
};

TEST(DisparityChoice, PutsTheMinimumBetweenItsNeighbours) {
  Costs costs;
  costs.set(40, 9, 50);
  costs.set(40, 10, 20);
  costs.set(40, 11, 30);  // the steeper side is 30, the other 10: a third towards it
  EXPECT_EQ(costs.chosen(40), 10 * kDisparityScale + (50 - 30) * 128 / 30);
}

TEST(DisparityChoice, AsksForUniqueness) {
  Costs costs;
  costs.set(40, 10, 20);
  costs.set(40, 20, 24);  // not more than 20 % worse
  EXPECT_EQ(costs.chosen(40), kNoChoice);
  EXPECT_EQ(costs.chosen(40, {19, 1}), 10 * kDisparityScale);
  costs.set(40, 20, 100);
  costs.set(40, 11, 20);  // a neighbour is no rival
  EXPECT_NE(costs.chosen(40), kNoChoice);
}

TEST(DisparityChoice, AsksTheRightImageBack) {
  Costs costs;
  costs.set(40, 10, 20);  // pixel 30 of the right image
  costs.set(45, 15, 10);  // which fits another one better
  EXPECT_EQ(costs.chosen(40), kNoChoice);
  EXPECT_EQ(costs.chosen(45), 15 * kDisparityScale);
  costs.set(45, 15, 100);
  costs.set(41, 11, 10);  // one pixel is allowed
  EXPECT_EQ(costs.chosen(40), 10 * kDisparityScale);
}

TEST(DisparityChoice, StaysInTheImageAndTheRange) {
  Costs costs;
  costs.set(5, 10, 20);
  EXPECT_EQ(costs.chosen(5), kNoChoice);  // pixel -5
  costs.set(40, 10, 20);
  EXPECT_EQ(costs.chosen(40, {20, 1}, 10), kNoChoice);
  Costs same;
  EXPECT_EQ(same.chosen(40), kNoChoice);  // nothing to choose between
}

TEST(Refinement, DoublesAlongSurfacesOnly) {
  cv::Mat half(3, 4, CV_32SC1, cv::Scalar(10 * 256));
  half.col(2).setTo(10 * 256 + 64);
  half.col(3).setTo(30 * 256);  // another surface
  half.at<std::int32_t>(0, 0) = kNoDisparity;
  cv::Mat full(6, 7, CV_32SC1);
  doubled(half, full);
  EXPECT_EQ(full.at<std::int32_t>(0, 0), kNoDisparity);
  EXPECT_EQ(full.at<std::int32_t>(3, 2), 20 * 256);
  EXPECT_EQ(full.at<std::int32_t>(3, 3), 20 * 256 + 32);  // a quarter of the way to the next one
  EXPECT_EQ(full.at<std::int32_t>(3, 5), 20 * 256 + 128);
  EXPECT_EQ(full.at<std::int32_t>(3, 6), 60 * 256);
}

/// From a disparity that is half a pixel off to the right one.
TEST(Refinement, StepsToTheBestPlace) {
  const StereoScene scene = render(
      {256, 64}, [](int) { return 9.4; }, {}, 0.5);
  cv::Mat disparity(scene.left.size(), CV_32SC1, cv::Scalar(static_cast<int>(8.9 * 256)));
  disparity.row(30).setTo(kNoDisparity);
  refine(scene.left, scene.right, disparity);
  std::vector<int> found;
  for (int v = 5; v < 59; ++v)
    for (int u = 20; u < 240; ++u)
      if (v != 30) found.push_back(disparity.at<std::int32_t>(v, u));
  std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2), found.end());
  EXPECT_NEAR(found[found.size() / 2] / 256.0, 9.4, 0.125);  // one step of Newton's leaves a quarter of it
  EXPECT_EQ(disparity.at<std::int32_t>(30, 100), kNoDisparity);
}

}  // namespace
}  // namespace atlas::test
