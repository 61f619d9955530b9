// SPDX-License-Identifier: MIT
#include "atlas/camera/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace atlas {
namespace {

constexpr int kSmallestCell_px = 2;   // of the coarse image: about the distance of two points on a line
constexpr double kCellsPerGap = 7.0;  // the distance of two points on a line is a small part of that of lines
constexpr double kAlongLine = 0.35;   // of line_gap_px: points of a line are closer to each other than lines

/// The coarse image: cells of some pixels.
class Cells {
 public:
  Cells(const cv::Mat& depth, const VisibilityParams& params)
      : px_(std::max(kSmallestCell_px, static_cast<int>(std::lround(params.line_gap_px / kCellsPerGap)))),
        size_((depth.cols + px_ - 1) / px_, (depth.rows + px_ - 1) / px_),
        along_(count(kAlongLine * params.line_gap_px)),
        across_(count(params.line_gap_px)) {
    for (int column = 0; column < depth.cols; ++column) of_column_.push_back(column / px_);
  }
  [[nodiscard]] cv::Size size() const { return size_; }
  [[nodiscard]] int row(int row_px) const { return row_px / px_; }
  [[nodiscard]] int column(int column_px) const { return of_column_[static_cast<std::size_t>(column_px)]; }
  [[nodiscard]] int along() const { return along_; }    ///< cells between two points of a line, at most
  [[nodiscard]] int across() const { return across_; }  ///< cells between two lines, at most

 private:
  [[nodiscard]] int count(double px) const { return std::max(1, static_cast<int>(std::lround(px / px_))); }

  int px_;
  cv::Size size_;
  int along_, across_;
  std::vector<int> of_column_;
};

/// Smallest (sign +1) depth of every cell, or largest (-1, all depths negated); kNoDepth where nothing is.
cv::Mat coarse(const SparseDepth& image, const Cells& cells, float sign) {
  cv::Mat result(cells.size(), CV_32FC1, cv::Scalar(kNoDepth));
  for (int row = 0; row < image.depth.rows; ++row) {
    const float* from = image.depth.ptr<float>(row);
    float* to = result.ptr<float>(cells.row(row));
    image.pixels.forEachInRow(row, [&](int column) {
      float& cell = to[cells.column(column)];
      cell = std::min(cell, sign * from[column]);
    });
  }
  return result;
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

/// Forgets the pixels that `gone(depth, row, column of the cell)` says are not seen.
template <class Gone>
void forget(SparseDepth& image, const Cells& cells, const Gone& gone) {
  for (int row = 0; row < image.depth.rows; ++row) {
    float* depth = image.depth.ptr<float>(row);
    image.pixels.forEachInRow(row, [&](int column) {
      if (!gone(depth[column], cells.row(row), cells.column(column))) return;
      depth[column] = kNoDepth;
      image.pixels.remove(row, column);
    });
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
cv::Mat onNearestLines(const SparseDepth& image, const Cells& cells, float sign) {
  cv::Mat band, joined;
  cv::erode(coarse(image, cells, sign), band, cv::Mat::ones(1, 2 * cells.along() + 1, CV_8UC1));
  joined = cv::Mat(band.size(), CV_32FC1, cv::Scalar(kNoDepth));
  joinNearestLine(band, cells.across(), true, joined);
  joinNearestLine(band, cells.across(), false, joined);
  return joined;
}

}  // namespace

void removeHidden(SparseDepth& image, const VisibilityParams& params) {
  const Cells cells(image.depth, params);
  if (cells.size().width < 2 || cells.size().height < 2) return;
  const cv::Mat front = frontOf(coarse(image, cells, 1.0F), cells.along(), cells.across());
  const auto scale = static_cast<float>(1.0 + params.relative_step);
  const auto step_m = static_cast<float>(params.absolute_step_m);
  forget(image, cells, [&](float z, int row, int column) {
    const float nearer = front.ptr<float>(row)[column];
    return nearer != kNoDepth && z > nearer * scale + step_m;
  });
}

void removeOutdated(SparseDepth& older, const SparseDepth& recent, const VisibilityParams& params) {
  const Cells cells(recent.depth, params);
  const cv::Mat nearest = onNearestLines(recent, cells, 1.0F);
  const cv::Mat farthest = onNearestLines(recent, cells, -1.0F);
  const auto scale = static_cast<float>(1.0 + params.relative_step);
  const auto step_m = static_cast<float>(params.absolute_step_m);
  forget(older, cells, [&](float z, int row, int column) {
    const float low = nearest.ptr<float>(row)[column], high = -farthest.ptr<float>(row)[column];
    return low != kNoDepth && (z * scale + step_m < low || z > high * scale + step_m);
  });
}

}  // namespace atlas
