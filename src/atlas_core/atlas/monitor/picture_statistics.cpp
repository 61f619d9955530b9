// SPDX-License-Identifier: MIT
#include "atlas/monitor/picture_statistics.hpp"

#include <algorithm>
#include <cstdlib>

namespace atlas {
namespace {
constexpr std::uint8_t kOverexposed = 250;
constexpr int kCells = 8, kCellWidth = kRasterWidth / kCells, kCellHeight = kRasterHeight / kCells;
constexpr int kDark = 30, kFlat = 12;  // grey
constexpr int kRows = 48, kSpan = 4;
constexpr int kEdge = 24;  // grey over kSpan pixels: well above noise and artefacts of compression
constexpr int kLeastEdges = 200;

/// The byte of a pixel that stands for its brightness, and the bytes from one pixel to the next.
struct Layout {
  int offset = 0, step = 1;
};
std::optional<Layout> layoutOf(const cv::Mat& pixels) {
  if (pixels.rows < kRasterHeight || pixels.cols < kRasterWidth) return std::nullopt;
  if (pixels.type() == CV_8UC1) return Layout{0, 1};
  if (pixels.type() == CV_8UC3) return Layout{1, 3};
  if (pixels.type() == CV_16UC1) return Layout{1, 2};  // little endian
  return std::nullopt;
}

bool darkAndFlat(const PictureRaster& raster, int cell_x, int cell_y) {
  int low = 255, high = 0;
  for (int y = cell_y * kCellHeight; y < (cell_y + 1) * kCellHeight; ++y) {
    const auto* row = raster.data() + static_cast<std::ptrdiff_t>(y) * kRasterWidth + cell_x * kCellWidth;
    const auto [darkest, brightest] = std::minmax_element(row, row + kCellWidth);
    low = std::min<int>(low, *darkest);
    high = std::max<int>(high, *brightest);
  }
  return high < kDark && high - low < kFlat;
}
}  // namespace

std::optional<PictureRaster> rasterOf(const cv::Mat& pixels) {
  const auto layout = layoutOf(pixels);
  if (!layout) return std::nullopt;
  PictureRaster raster;
  std::size_t i = 0;
  for (int y = 0; y < kRasterHeight; ++y) {
    const auto* row = pixels.ptr<std::uint8_t>((2 * y + 1) * pixels.rows / (2 * kRasterHeight));
    for (int x = 0; x < kRasterWidth; ++x) {
      const int column = (2 * x + 1) * pixels.cols / (2 * kRasterWidth);
      raster[i++] = row[static_cast<std::ptrdiff_t>(column) * layout->step + layout->offset];
    }
  }
  return raster;
}

PictureStatistics statisticsOf(const PictureRaster& raster) {
  std::array<int, 256> histogram{};
  PictureStatistics result;
  for (const std::uint8_t grey : raster) ++histogram[grey];
  const auto total = static_cast<double>(raster.size());
  double sum = 0.0;
  int below = 0;
  result.low = result.high = 255.0;
  bool low_found = false, high_found = false;
  for (int grey = 0; grey < 256; ++grey) {
    sum += static_cast<double>(grey) * histogram[grey];
    below += histogram[grey];
    if (!low_found && below >= 0.02 * total) {
      result.low = grey;
      low_found = true;
    }
    if (!high_found && below >= 0.98 * total) {
      result.high = grey;
      high_found = true;
    }
  }
  result.mean = sum / total;
  const auto lower = raster.begin() + static_cast<std::ptrdiff_t>(raster.size() / 3);
  const auto bright =
      std::count_if(lower, raster.end(), [](std::uint8_t grey) { return grey >= kOverexposed; });
  result.glare_share = static_cast<double>(bright) / static_cast<double>(raster.end() - lower);
  int dark = 0;
  for (int cell = 0; cell < kCells * kCells; ++cell)
    dark += darkAndFlat(raster, cell % kCells, cell / kCells) ? 1 : 0;
  result.dark_share = static_cast<double>(dark) / (kCells * kCells);
  return result;
}

std::optional<double> sharpnessOf(const cv::Mat& pixels) {
  const auto layout = layoutOf(pixels);
  if (!layout) return std::nullopt;
  double sum = 0.0;
  int edges = 0;
  for (int r = 0; r < kRows; ++r) {
    const auto* row = pixels.ptr<std::uint8_t>((2 * r + 1) * pixels.rows / (2 * kRows)) + layout->offset;
    const auto grey = [&](int x) {
      return static_cast<int>(row[static_cast<std::ptrdiff_t>(x) * layout->step]);
    };
    for (int x = 0; x + kSpan < pixels.cols; ++x) {
      const int rise = std::abs(grey(x + kSpan) - grey(x));
      if (rise < kEdge) continue;
      int step = 0;
      for (int i = 0; i < kSpan; ++i) step = std::max(step, std::abs(grey(x + i + 1) - grey(x + i)));
      sum += std::min(1.0, static_cast<double>(step) / rise);
      ++edges;
    }
  }
  if (edges < kLeastEdges) return std::nullopt;
  return sum / edges;
}

}  // namespace atlas
