// SPDX-License-Identifier: MIT
#include "atlas/stereo/census.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <opencv2/core.hpp>

#include "atlas/base/avx2_clones.hpp"

namespace atlas {
namespace {

struct Neighbour {
  int x, y;
};
constexpr int kReach = 3;  // of the neighbours, px
constexpr std::array<Neighbour, 8> kOuter{
    {{-2, -2}, {0, -2}, {2, -2}, {-2, 0}, {2, 0}, {-2, 2}, {0, 2}, {2, 2}}};
constexpr std::array<Neighbour, 8> kInner{
    {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}, {-1, 0}, {1, 0}, {-3, 0}, {3, 0}}};

using Neighbours = std::array<const std::uint8_t*, 8>;  // of the first pixel of a row

ATLAS_AVX2_CLONES void compareRow(const std::uint8_t* __restrict centre, const Neighbours& neighbours,
                                  int width, std::uint8_t* __restrict bits) {
  const Neighbours n = neighbours;
  for (int x = 0; x < width; ++x) {
    unsigned result = 0;
    for (unsigned k = 0; k < 8; ++k) result |= n[k][x] < centre[x] ? 1U << k : 0U;
    bits[x] = static_cast<std::uint8_t>(result);
  }
}

cv::Mat compared(const cv::Mat& padded, cv::Size size, const std::array<Neighbour, 8>& neighbours) {
  cv::Mat bits(size, CV_8UC1);
  for (int y = 0; y < size.height; ++y) {
    Neighbours rows{};
    for (std::size_t k = 0; k < neighbours.size(); ++k)
      rows[k] = padded.ptr<std::uint8_t>(y + kReach + neighbours[k].y) + kReach + neighbours[k].x;
    compareRow(padded.ptr<std::uint8_t>(y + kReach) + kReach, rows, size.width, bits.ptr<std::uint8_t>(y));
  }
  return bits;
}

ATLAS_AVX2_CLONES void meanOfFour(const std::uint8_t* __restrict above, const std::uint8_t* __restrict below,
                                  int width, std::uint8_t* __restrict mean) {
  for (int x = 0; x < width; ++x)
    mean[x] = static_cast<std::uint8_t>(
        (above[2 * x] + above[2 * x + 1] + below[2 * x] + below[2 * x + 1] + 2) / 4);
}

}  // namespace

CensusImage censusOf(const cv::Mat& grey) {
  cv::Mat padded;
  cv::copyMakeBorder(grey, padded, kReach, kReach, kReach, kReach, cv::BORDER_REPLICATE);
  return {compared(padded, grey.size(), kOuter), compared(padded, grey.size(), kInner)};
}

cv::Mat halved(const cv::Mat& grey) {
  cv::Mat half((grey.rows + 1) / 2, (grey.cols + 1) / 2, CV_8UC1);
  for (int y = 0; y < half.rows; ++y) {
    const std::uint8_t* above = grey.ptr<std::uint8_t>(2 * y);
    const std::uint8_t* below = grey.ptr<std::uint8_t>(std::min(2 * y + 1, grey.rows - 1));
    std::uint8_t* mean = half.ptr<std::uint8_t>(y);
    meanOfFour(above, below, grey.cols / 2, mean);
    if (grey.cols % 2 != 0)
      mean[half.cols - 1] = static_cast<std::uint8_t>((above[grey.cols - 1] + below[grey.cols - 1] + 1) / 2);
  }
  return half;
}

}  // namespace atlas
