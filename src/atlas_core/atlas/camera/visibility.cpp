// SPDX-License-Identifier: MIT
#include "atlas/camera/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace atlas {
namespace {

constexpr int kCell_px = 2;          // of the coarse image: about the distance of two points on a line
constexpr double kAlongLine = 0.35;  // of line_gap_px: points of a line are closer to each other than lines

/// Smallest (sign +1) depth of every cell, or largest (-1, all depths negated); kNoDepth where nothing is.
cv::Mat coarse(const cv::Mat& depth, float sign) {
  cv::Mat cells((depth.rows + kCell_px - 1) / kCell_px, (depth.cols + kCell_px - 1) / kCell_px, CV_32FC1,
                cv::Scalar(kNoDepth));
  for (int row = 0; row < depth.rows; ++row) {
    const float* from = depth.ptr<float>(row);
    float* to = cells.ptr<float>(row / kCell_px);
    for (int column = 0; column < depth.cols; ++column) {
      float& cell = to[column / kCell_px];
      if (from[column] != kNoDepth) cell = std::min(cell, sign * from[column]);
    }
  }
  return cells;
}

/// Smallest value among the `count` cells before (or after) each cell, along x or y, without the cell itself.
cv::Mat smallestBeside(const cv::Mat& cells, int count, bool along_x, bool before) {
  const cv::Size size = along_x ? cv::Size(count, 1) : cv::Size(1, count);
  const int end = before ? count - 1 : 0;
  cv::Mat including, result(cells.size(), CV_32FC1, cv::Scalar(kNoDepth));
  cv::erode(cells, including, cv::Mat::ones(size, CV_8UC1), along_x ? cv::Point(end, 0) : cv::Point(0, end));
  const int w = cells.cols - (along_x ? 1 : 0), h = cells.rows - (along_x ? 0 : 1);
  const cv::Rect low(0, 0, w, h), high(cells.cols - w, cells.rows - h, w, h);
  including(before ? low : high).copyTo(result(before ? high : low));
  return result;
}

/// The depth in front of each cell: nearer points lie on both of two opposite sides.
cv::Mat frontOf(const cv::Mat& cells, int along, int across) {
  cv::Mat sideways, upright, front;
  cv::max(smallestBeside(cells, along, true, true), smallestBeside(cells, along, true, false), sideways);
  cv::max(smallestBeside(cells, across, false, true), smallestBeside(cells, across, false, false), upright);
  cv::min(sideways, upright, front);
  return front;
}

int cellsOf(double px) { return std::max(1, static_cast<int>(std::lround(px / kCell_px))); }

/// Forgets the pixels that `gone(depth, row, column of the cell)` says are not seen.
template <class Gone>
void forget(cv::Mat& depth, const Gone& gone) {
  for (int row = 0; row < depth.rows; ++row) {
    float* pixels = depth.ptr<float>(row);
    for (int column = 0; column < depth.cols; ++column) {
      if (pixels[column] != kNoDepth && gone(pixels[column], row / kCell_px, column / kCell_px))
        pixels[column] = kNoDepth;
    }
  }
}

/// For every cell the value of the nearest cell above (or below) it that has one, itself included, up to
/// `reach` cells away, joined to `joined` by the minimum.
void joinNearestLine(const cv::Mat& cells, int reach, bool downwards, cv::Mat& joined) {
  std::vector<float> last(static_cast<std::size_t>(cells.cols), kNoDepth);
  std::vector<int> age(static_cast<std::size_t>(cells.cols), 0);
  for (int i = 0; i < cells.rows; ++i) {
    const int row = downwards ? i : cells.rows - 1 - i;
    const float* values = cells.ptr<float>(row);
    float* to = joined.ptr<float>(row);
    for (std::size_t c = 0; c < last.size(); ++c) {
      const bool here = values[c] != kNoDepth;
      age[c] = here ? 0 : age[c] + 1;
      last[c] = here ? values[c] : age[c] > reach ? kNoDepth : last[c];
      to[c] = std::min(to[c], last[c]);
    }
  }
}

/// Smallest depth (sign +1) on the nearest lines above and below each cell, or largest (-1, negated).
cv::Mat onNearestLines(const cv::Mat& depth, int along, int across, float sign) {
  cv::Mat band, joined;
  cv::erode(coarse(depth, sign), band, cv::Mat::ones(1, 2 * along + 1, CV_8UC1));
  joined = cv::Mat(band.size(), CV_32FC1, cv::Scalar(kNoDepth));
  joinNearestLine(band, across, true, joined);
  joinNearestLine(band, across, false, joined);
  return joined;
}

}  // namespace

void removeHidden(cv::Mat& depth, const VisibilityParams& params) {
  const cv::Mat cells = coarse(depth, 1.0F);
  if (cells.cols < 2 || cells.rows < 2) return;
  const cv::Mat front = frontOf(cells, cellsOf(kAlongLine * params.line_gap_px), cellsOf(params.line_gap_px));
  const auto scale = static_cast<float>(1.0 + params.relative_step);
  const auto step_m = static_cast<float>(params.absolute_step_m);
  forget(depth, [&](float z, int row, int column) {
    const float nearer = front.ptr<float>(row)[column];
    return nearer != kNoDepth && z > nearer * scale + step_m;
  });
}

void removeOutdated(cv::Mat& older, const cv::Mat& recent, const VisibilityParams& params) {
  const int along = cellsOf(kAlongLine * params.line_gap_px), across = cellsOf(params.line_gap_px);
  const cv::Mat nearest = onNearestLines(recent, along, across, 1.0F);
  const cv::Mat farthest = onNearestLines(recent, along, across, -1.0F);
  const auto scale = static_cast<float>(1.0 + params.relative_step);
  const auto step_m = static_cast<float>(params.absolute_step_m);
  forget(older, [&](float z, int row, int column) {
    const float low = nearest.ptr<float>(row)[column], high = -farthest.ptr<float>(row)[column];
    return low != kNoDepth && (z * scale + step_m < low || z > high * scale + step_m);
  });
}

}  // namespace atlas
