// SPDX-License-Identifier: MIT
#include "atlas/stereo/u_disparity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene.hpp"

namespace atlas::test {
namespace {

/// Some of each: road with noise, a thing, what is unknown, and anything at all.
DisparityImage randomImage(const StereoRig& rig, const RoadProfile& road, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.3);
  DisparityImage image{cv::Mat(rig.height_px, rig.width_px, CV_16UC1, cv::Scalar(0)),
                       cv::Mat(rig.height_px, rig.width_px, CV_8UC1, cv::Scalar(0)), road};
  for (int v = 0; v < rig.height_px; ++v) {
    for (int u = 0; u < rig.width_px; ++u) {
      const auto kind = random() % 10;
      if (kind == 0) continue;
      double d = road.disparityAt(v) + noise(random);
      SurfaceLabel label = SurfaceLabel::kRoad;
      if (u > 5 && u < 15 && d < 9.0) d = 9.0 + noise(random), label = SurfaceLabel::kObstacle;
      if (kind == 1)
        d = static_cast<double>(random() % 3000) / 200.0, label = static_cast<SurfaceLabel>(1 + random() % 2);
      if (d <= 0.01 || d > 15.9) continue;
      image.disparity.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(d * kDisparityScale);
      image.surface.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(label);
    }
  }
  return image;
}

/// Equation (1) from its definition: for each cell all rows of its column are looked at.
class Definition {
 public:
  Definition(const StereoRig& rig, const UDisparityParams& params, const DisparityImage& image, int range_px)
      : rig_(rig), params_(params), image_(image), bins_(range_px * params.bins_per_px) {
    const double sigma = params.disparity_sigma_px * params.bins_per_px;
    reach_ = static_cast<int>(std::ceil(2.5 * sigma));
    for (int k = -reach_; k <= reach_; ++k)
      kernel_.push_back(sigma > 0.0 ? std::exp(-0.5 * k * k / sigma / sigma) : 1.0);
    double sum = 0;
    for (const double weight : kernel_) sum += weight;
    for (double& weight : kernel_) weight /= sum;
  }

  [[nodiscard]] double occupancy(int u, int bin) const {
    double possible = 0, visible = 0, things = 0, roads = 0, road_rows = 0;
    for (int v = 0; v < rig_.height_px; ++v) {
      if (!isPossible(v, bin)) continue;
      ++possible;
      const int measured = binAt(v, u);
      if (measured >= 0 && measured <= bin) ++visible;
    }
    for (int k = -reach_; k <= reach_; ++k) {
      if (bin + k < 0 || bin + k >= bins_) continue;
      const double weight = kernel_[static_cast<std::size_t>(k + reach_)];
      things += weight * counted(u, bin + k, SurfaceLabel::kObstacle);
      roads += weight * counted(u, bin + k, SurfaceLabel::kRoad);
      road_rows += weight * roadRows(bin + k);
    }
    const double p_visible = possible > 0 ? visible / possible : 0.0;
    const double p_confident = 1.0 - std::exp(-things / std::max(visible, 1.0) / params_.obstacle_share);
    const double p_road =
        road_rows < 1e-3 ? 0.0 : 1.0 - std::exp(-roads / (road_rows + things) / params_.road_share);
    const double p = (p_visible * p_confident * (1.0 - params_.false_positive) +
                      p_visible * (1.0 - p_confident) * params_.false_negative + (1.0 - p_visible) * 0.5) *
                     (1.0 - p_road);
    return std::clamp(p, params_.min_probability, params_.max_probability);
  }

 private:
  [[nodiscard]] int binAt(int v, int u) const {
    const int d = image_.disparity.at<std::uint16_t>(v, u);
    return d == 0 ? -1 : d * params_.bins_per_px / kDisparityScale;
  }
  /// v_t <= v <= v_0 at the middle of the bin.
  [[nodiscard]] bool isPossible(int v, int bin) const {
    const double d = (bin + 0.5) / params_.bins_per_px,
                 foot = image_.road->horizon_row + d / image_.road->slope_px;
    return v <= foot + 1e-9 && v >= foot - d * params_.max_height_m / rig_.baseline_m - 1e-9;
  }
  /// Pixels of a label in a bin; road that is measured under the road counts at the road.
  [[nodiscard]] int counted(int u, int bin, SurfaceLabel label) const {
    int count = 0;
    for (int v = 0; v < rig_.height_px; ++v) {
      if (image_.surface.at<std::uint8_t>(v, u) != static_cast<std::uint8_t>(label)) continue;
      int at = binAt(v, u);
      if (at < 0) continue;
      if (label == SurfaceLabel::kRoad)
        while (at < bins_ && !isPossible(v, at) &&
               v > image_.road->horizon_row + (at + 0.5) / params_.bins_per_px / image_.road->slope_px)
          ++at;
      if (at == bin && isPossible(v, at)) ++count;
    }
    return count;
  }
  [[nodiscard]] double roadRows(int bin) const {
    const double rows_a_bin = 1.0 / params_.bins_per_px / image_.road->slope_px;
    const double from = image_.road->horizon_row + bin * rows_a_bin;
    return std::max(0.0, std::min(from + rows_a_bin, rig_.height_px - 0.5) - std::max(from, -0.5));
  }

  const StereoRig& rig_;
  const UDisparityParams& params_;
  const DisparityImage& image_;
  int bins_, reach_ = 0;
  std::vector<double> kernel_;
};

/// Cameras lower and higher than what may stand on the road, with and without spread of the counts.
TEST(UDisparity, IsEquationOneOfItsDefinition) {
  StereoRig rig = lexusRig();
  rig.width_px = 24;
  rig.height_px = 200;
  for (const double max_height_m : {2.0, 0.9}) {
    for (const double sigma_px : {0.25, 0.0}) {
      UDisparityParams params;
      params.max_height_m = max_height_m;
      params.disparity_sigma_px = sigma_px;
      const DisparityImage image = randomImage(rig, {90.3, 0.1719}, 3);
      const Definition definition(rig, params, image, 16);
      UDisparity u_disparity(rig, 16, params);
      const UDisparityGrid& grid = u_disparity.compute(image);
      ASSERT_EQ(grid.bins, 64);
      for (int bin = 0; bin < grid.bins; ++bin)
        for (int u = 0; u < grid.columns; ++u)
          ASSERT_NEAR(
              grid.occupancy[static_cast<std::size_t>(bin * grid.columns + u)] / double(kProbabilityOne),
              definition.occupancy(u, bin), 2e-4)
              << "bin " << bin << " column " << u << " height " << max_height_m << " sigma " << sigma_px;
    }
  }
}

/// P(V) = 1/2 without anything known; a thing hides what is behind it.
TEST(UDisparity, WhatIsHiddenIsUnknown) {
  const StereoRig rig = lexusRig();
  DisparityImage image{cv::Mat(320, 512, CV_16UC1, cv::Scalar(0)), cv::Mat(320, 512, CV_8UC1, cv::Scalar(0)),
                       lexusRoad()};
  image.disparity.colRange(100, 200).setTo(20 * kDisparityScale + 128);
  image.surface.colRange(100, 200).setTo(static_cast<int>(SurfaceLabel::kObstacle));
  UDisparity u_disparity(rig, 64, {});
  const UDisparityGrid& grid = u_disparity.compute(image);
  const auto at = [&](int u, double d) {
    return grid.occupancy[static_cast<std::size_t>(static_cast<int>(d * grid.bins_per_px) * grid.columns +
                                                   u)] /
           static_cast<double>(kProbabilityOne);
  };
  EXPECT_NEAR(at(50, 20.6), 0.5, 1e-3);    // nothing is known
  EXPECT_GT(at(150, 20.6), 0.9);           // the thing
  EXPECT_NEAR(at(150, 10.0), 0.5, 0.02);   // behind it
  EXPECT_NEAR(at(150, 30.0), 0.05, 0.01);  // before it: seen through, P_fn
}

TEST(UDisparity, RefusesWhatItCannotJudge) {
  UDisparity u_disparity(lexusRig(), 64, {});
  DisparityImage image{cv::Mat(320, 512, CV_16UC1), cv::Mat(320, 512, CV_8UC1), std::nullopt};
  EXPECT_THROW(u_disparity.compute(image), std::invalid_argument);
  image.road = RoadProfile{156.0, 0.0};
  EXPECT_THROW(u_disparity.compute(image), std::invalid_argument);
  image.road = lexusRoad();
  image.surface = cv::Mat(320, 500, CV_8UC1);
  EXPECT_THROW(u_disparity.compute(image), std::invalid_argument);
  UDisparityParams wrong;
  wrong.false_positive = 0.6;
  EXPECT_THROW(UDisparity(lexusRig(), 64, wrong), std::invalid_argument);
  EXPECT_THROW(UDisparity(lexusRig(), 300, {}), std::invalid_argument);
}

}  // namespace
}  // namespace atlas::test
