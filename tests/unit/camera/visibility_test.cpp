// SPDX-License-Identifier: MIT
#include "atlas/camera/visibility.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/core.hpp>

#include "atlas/camera/depth_buffer.hpp"
#include "atlas/camera/gap_filling.hpp"

namespace atlas::test {
namespace {

constexpr int kWidth = 120, kHeight = 90;

cv::Mat nothing() { return {kHeight, kWidth, CV_32FC1, cv::Scalar(kNoDepth)}; }
/// Scan lines every `step` rows from `first`, a point on every second pixel of the columns [from, to).
cv::Mat lines(int first, int step, int from, int to, const std::function<float(int row, int column)>& depth) {
  cv::Mat image = nothing();
  for (int row = first; row < kHeight; row += step) {
    for (int column = from; column < to; column += 2) image.at<float>(row, column) = depth(row, column);
  }
  return image;
}
cv::Mat both(const cv::Mat& a, const cv::Mat& b) {
  cv::Mat joined;
  cv::min(a, b, joined);
  return joined;
}
PixelSet pixelsOf(const cv::Mat& image) {
  PixelSet pixels(image.cols, image.rows);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      if (image.at<float>(row, column) != kNoDepth) pixels.add(row, column);
    }
  }
  return pixels;
}
SparseDepth sparse(const cv::Mat& image) {
  SparseDepth result(image.cols, image.rows);
  result.depth = image.clone();
  result.pixels = pixelsOf(image);
  return result;
}
/// What is left of the image; its pixels are those with a depth.
cv::Mat visibleOf(const cv::Mat& image) {
  SparseDepth seen = sparse(image);
  removeHidden(seen, {14.0, 0.05, 0.2});
  seen.pixels.forEach([&](int row, int column) { EXPECT_NE(seen.depth.at<float>(row, column), kNoDepth); });
  return seen.depth;
}
cv::Mat upToDateOf(const cv::Mat& older, const cv::Mat& recent) {
  SparseDepth left = sparse(older);
  removeOutdated(left, sparse(recent), {14.0, 0.05, 0.2});
  return left.depth;
}
/// Fills in place; the confidence.
cv::Mat filled(cv::Mat& depth, const GapFillingParams& params) {
  cv::Mat confidence(depth.size(), CV_32FC1, cv::Scalar(0));
  fillGaps(depth, confidence, pixelsOf(depth), params);
  return confidence;
}
int countIf(const cv::Mat& image, const std::function<bool(float)>& wanted) {
  int count = 0;
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) count += wanted(image.at<float>(row, column)) ? 1 : 0;
  }
  return count;
}
int countOf(const cv::Mat& image, float depth) {
  return countIf(image, [&](float z) { return z == depth; });
}

// A car at 10 m with a line every 12 px; between its lines the wall behind it, as the lidar on the roof sees
// it. Beside the car the wall stays.
TEST(RemoveHidden, wallBehindTheLinesOfACarGoesAndBesideItStays) {
  const cv::Mat car = lines(0, 12, 40, 80, [](int, int) { return 10.0F; });
  const cv::Mat wall = lines(6, 12, 0, kWidth, [](int, int) { return 25.0F; });
  const cv::Mat seen = visibleOf(both(car, wall));
  EXPECT_EQ(countOf(seen, 10.0F), countOf(car, 10.0F)) << "nothing of the car";
  for (int row = 6; row < kHeight - 12; row += 12) {
    for (int column = 0; column < kWidth; column += 2) {
      const bool behind = column >= 42 && column < 78, beside = column < 30 || column >= 90;
      if (behind) {
        EXPECT_EQ(seen.at<float>(row, column), kNoDepth) << row << " " << column;
      }
      if (beside) {
        EXPECT_EQ(seen.at<float>(row, column), 25.0F) << row << " " << column;
      }
    }
  }
}

// A pole is nearer on one side only of what is next to it; a road comes nearer downwards; a wall along the
// road comes nearer sideways; where two walls meet both neighbours are nearer, by little.
TEST(RemoveHidden, surfacesAndWhatIsBesideAPoleStay) {
  const auto unchanged = [](const cv::Mat& image) {
    const cv::Mat seen = visibleOf(image);
    return countIf(image, [](float z) { return z != kNoDepth; }) -
           countIf(seen, [](float z) { return z != kNoDepth; });
  };
  EXPECT_EQ(unchanged(lines(20, 6, 0, kWidth, [](int row, int) { return 900.0F / static_cast<float>(row); })),
            0);
  EXPECT_EQ(
      unchanged(lines(0, 6, 0, kWidth, [](int, int c) { return 1000.0F / static_cast<float>(20 + c); })), 0);
  EXPECT_EQ(unchanged(lines(0, 6, 0, kWidth,
                            [](int, int c) { return 20.0F - 0.1F * std::abs(static_cast<float>(c - 60)); })),
            0);
  const cv::Mat pole = lines(0, 12, 58, 60, [](int, int) { return 8.0F; });
  const cv::Mat wall = lines(6, 12, 66, kWidth, [](int, int) { return 30.0F; });
  const cv::Mat seen = visibleOf(both(pole, wall));
  EXPECT_EQ(countOf(seen, 30.0F), countOf(wall, 30.0F));
}

// A car has driven away from 10 m to 16 m, another has come from 30 m to 20 m in front of a wall that stands.
TEST(RemoveOutdated, whatHasMovedIsOnlyWhereItIsNow) {
  const auto car = [](float depth) { return [depth](int, int) { return depth; }; };
  const cv::Mat older = both(lines(3, 12, 20, 50, car(10.0F)), lines(3, 12, 70, 100, car(30.0F)));
  const cv::Mat recent = both(lines(0, 12, 20, 50, car(16.0F)), lines(0, 12, 70, 100, car(20.0F)));
  EXPECT_EQ(countIf(upToDateOf(older, recent), [](float z) { return z != kNoDepth; }), 0);
}

TEST(RemoveOutdated, whatStandsStays) {
  const auto road = [](int row, int) { return 900.0F / static_cast<float>(row); };
  cv::Mat before = lines(29, 12, 0, kWidth, road);
  before.row(89).setTo(kNoDepth);  // below the last recent line nothing says how the road goes on
  const cv::Mat older = upToDateOf(before, lines(23, 12, 0, kWidth, road));
  EXPECT_EQ(cv::countNonZero(older != before), 0) << "between its own lines a road is between their depths";
  const cv::Mat alone = upToDateOf(before, nothing());
  EXPECT_EQ(cv::countNonZero(alone != before), 0) << "where nothing is recent there is nothing against it";
}

// The inverse depth of a plane is linear in the image: gaps of a slanted plane are filled exactly.
TEST(FillGaps, planeIsExactAndItsConfidenceFalls) {
  const auto plane = [](int row, int column) {
    return 1.0F / (0.05F + 0.0004F * static_cast<float>(row) + 0.0001F * static_cast<float>(column));
  };
  cv::Mat depth = lines(0, 8, 0, kWidth, plane);
  const cv::Mat confidence = filled(depth, {500.0, 1.0, 10.0, 0.12});
  for (int row = 0; row <= 80; ++row) {
    for (int column = 0; column < kWidth - 1; ++column)
      ASSERT_NEAR(depth.at<float>(row, column), plane(row, column), 1e-4) << row << " " << column;
  }
  EXPECT_EQ(confidence.at<float>(8, 10), 1.0F);
  EXPECT_LT(confidence.at<float>(12, 10), confidence.at<float>(9, 10));
  EXPECT_GE(confidence.at<float>(12, 10), 0.5F);
  EXPECT_EQ(confidence.at<float>(89, 10), 0.0F) << "nothing below the last line";
  EXPECT_EQ(depth.at<float>(89, 10), kNoDepth);
}

TEST(FillGaps, nothingBetweenTwoSurfacesNorOverAnOutline) {
  const cv::Mat near = lines(0, 4, 40, 60, [](int, int) { return 10.0F; });
  cv::Mat depth = both(near, lines(0, 4, 64, kWidth, [](int, int) { return 20.0F; }));
  filled(depth, {500.0, 1.0, 10.0, 0.12});
  for (int row = 0; row <= 88; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const float z = depth.at<float>(row, column);
      if (column >= 40 && column <= 58) {
        ASSERT_EQ(z, 10.0F) << row << " " << column;
      }
      if (column < 40 || (column > 58 && column < 64)) {
        ASSERT_EQ(z, kNoDepth) << row << " " << column;
      }
    }
  }
}

// 0.3 m on the surface: 15 px at 10 m, so a gap of 12 is filled; 5 px at 30 m, so it is not.
TEST(FillGaps, gapGrowsAsTheSurfaceComesNear) {
  for (const float z : {10.0F, 30.0F}) {
    cv::Mat depth = lines(0, 12, 0, kWidth, [z](int, int) { return z; });
    filled(depth, {500.0, 0.3, 14.0, 0.12});
    EXPECT_FLOAT_EQ(depth.at<float>(6, 10), z == 10.0F ? z : kNoDepth);
    EXPECT_FLOAT_EQ(depth.at<float>(12, 11), z) << "along the line";
  }
}

// Which of two images a point went to, and in which order, changes nothing that stands.
TEST(DepthBuffer, recentAndOlderAreOneImage) {
  DepthBuffer buffer(20, 10);
  buffer.add({3.0F, 3.0F, 7.0F}, false);
  buffer.add({3.0F, 3.0F, 5.0F}, true);
  buffer.add({8.0F, 3.0F, 4.0F}, false);
  EXPECT_EQ(buffer.image().at<float>(3, 3), 5.0F);
  EXPECT_EQ(buffer.image().at<float>(3, 8), 4.0F);
  buffer.removeInvisible({4.0, 0.05, 0.2});
  EXPECT_EQ(buffer.image().at<float>(3, 3), 5.0F);
}

// One buffer makes all images of a camera: nothing of one is left in the next.
TEST(DepthBuffer, isEmptyAfterAnImage) {
  DepthBuffer buffer(20, 10);
  for (int column = 2; column < 10; column += 2)
    buffer.add({static_cast<float>(column), 3.0F, 7.0F}, column < 6);
  buffer.removeInvisible({4.0, 0.05, 0.2});
  const DepthBuffer::Images first = buffer.takeFilled({500.0, 1.0, 10.0, 0.12});
  EXPECT_FLOAT_EQ(first.depth.at<float>(3, 5), 7.0F);
  EXPECT_LT(first.confidence.at<float>(3, 5), 1.0F);
  buffer.add({4.0F, 3.0F, 9.0F});  // where the first image had something nearer
  const DepthBuffer::Images second = buffer.takeFilled({500.0, 1.0, 10.0, 0.12});
  EXPECT_EQ(countIf(second.depth, [](float z) { return !std::isnan(z); }), 1);
  EXPECT_EQ(second.depth.at<float>(3, 4), 9.0F);
  EXPECT_EQ(countIf(second.confidence, [](float sure) { return sure != 0.0F; }), 1);
  EXPECT_FLOAT_EQ(first.depth.at<float>(3, 5), 7.0F) << "the first image is still its own";
}

}  // namespace
}  // namespace atlas::test
