// SPDX-License-Identifier: MIT
// The inner loops of the path matcher, over the disparities of each pixel of a row. Costs and sums of one
// pixel lie one after the other (`Lanes` of them), so that these loops become vector instructions.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "atlas/base/avx2_clones.hpp"

namespace atlas::path {

/// Free bytes before and after the lanes of a pixel that the step to d - 1 and d + 1 reads.
constexpr int kMargin = 16;
/// No path sum is as large; P1 can be added to it.
constexpr std::uint8_t kFar = 200;

/// Bits that are set in two bytes.
inline std::uint8_t bitsOf(std::uint8_t a, std::uint8_t b) {
  a = static_cast<std::uint8_t>(a - ((a >> 1) & 0x55));
  b = static_cast<std::uint8_t>(b - ((b >> 1) & 0x55));
  a = static_cast<std::uint8_t>((a & 0x33) + ((a >> 2) & 0x33));
  b = static_cast<std::uint8_t>((b & 0x33) + ((b >> 2) & 0x33));
  const std::uint8_t sum = static_cast<std::uint8_t>(a + b);
  return static_cast<std::uint8_t>((sum & 0x0F) + (sum >> 4));
}

/// A row of the right image's census from right to left, `low[i + d]` belongs to disparity d of pixel
/// width - 1 - i.
struct ReversedRow {
  const std::uint8_t *low, *high;
};

template <int Lanes>
ATLAS_AVX2_CLONES void compare(const std::uint8_t* low, const std::uint8_t* high, ReversedRow right,
                               int width, std::uint8_t* __restrict costs) {
  for (int x = 0; x < width; ++x) {
    const std::uint8_t left_low = low[x], left_high = high[x];
    const std::uint8_t *right_low = right.low + (width - 1 - x), *right_high = right.high + (width - 1 - x);
    std::uint8_t* __restrict cost = costs + static_cast<std::ptrdiff_t>(x) * Lanes;
    for (int d = 0; d < Lanes; ++d)
      cost[d] = bitsOf(static_cast<std::uint8_t>(left_low ^ right_low[d]),
                       static_cast<std::uint8_t>(left_high ^ right_high[d]));
  }
}

/// Half the sum of 3x3 pixels' costs (0..72); `column` has room for a row.
template <int Lanes>
ATLAS_AVX2_CLONES void sumWindows(const std::uint8_t* __restrict above, const std::uint8_t* __restrict middle,
                                  const std::uint8_t* __restrict below, int width,
                                  std::uint8_t* __restrict column, std::uint8_t* __restrict costs) {
  for (int i = 0; i < width * Lanes; ++i)
    column[i] = static_cast<std::uint8_t>(above[i] + middle[i] + below[i]);
  for (int x = 0; x < width; ++x) {
    const std::uint8_t* at = column + static_cast<std::ptrdiff_t>(x) * Lanes;
    const std::uint8_t *left = x > 0 ? at - Lanes : at, *right = x + 1 < width ? at + Lanes : at;
    std::uint8_t* __restrict cost = costs + static_cast<std::ptrdiff_t>(x) * Lanes;
    for (int d = 0; d < Lanes; ++d)
      cost[d] = static_cast<std::uint8_t>(static_cast<std::uint8_t>(left[d] + at[d] + right[d]) >> 1);
  }
}

/// One step along a path, from the pixel before to `next`; returns the least of `next`.
template <int Lanes>
inline std::uint8_t step(const std::uint8_t* __restrict before, std::uint8_t least_before,
                         const std::uint8_t* __restrict cost, std::uint8_t p1, std::uint8_t p2,
                         std::uint8_t* __restrict next) {
  const std::uint8_t jump = static_cast<std::uint8_t>(least_before + p2);
  std::uint8_t least = 0xFF;
  for (int d = 0; d < Lanes; ++d) {
    const std::uint8_t beside = static_cast<std::uint8_t>(std::min(before[d - 1], before[d + 1]) + p1);
    const std::uint8_t from = std::min(std::min(before[d], beside), jump);
    next[d] = static_cast<std::uint8_t>(from - least_before + cost[d]);
    least = std::min(least, next[d]);
  }
  return least;
}

struct Steps {
  std::uint8_t p1, p2;
};

/// The path from above (Shift 0), from above on the left (-1) or on the right (+1). `sums` and `least` are
/// those of the row above, and of this row afterwards. The first path sets the total, the others add to it.
template <int Lanes, int Shift>
ATLAS_AVX2_CLONES void pathFromAbove(const std::uint8_t* costs, Steps steps, int width, std::uint8_t* sums,
                                     std::uint8_t* least, std::uint16_t* total) {
  alignas(32) std::uint8_t next[Lanes];
  constexpr int kStride = Lanes + 2 * kMargin;
  for (int i = 0; i < width; ++i) {
    const int x = Shift < 0 ? width - 1 - i : i;  // so that what is read has not been written yet
    const int from = std::min(std::max(x + Shift, 0), width - 1);
    least[x] = step<Lanes>(sums + static_cast<std::ptrdiff_t>(from) * kStride + kMargin, least[from],
                           costs + static_cast<std::ptrdiff_t>(x) * Lanes, steps.p1, steps.p2, next);
    std::uint8_t* __restrict to = sums + static_cast<std::ptrdiff_t>(x) * kStride + kMargin;
    std::uint16_t* __restrict sum = total + static_cast<std::ptrdiff_t>(x) * Lanes;
    for (int d = 0; d < Lanes; ++d) to[d] = next[d];
    for (int d = 0; d < Lanes; ++d) sum[d] = static_cast<std::uint16_t>((Shift == 0 ? 0 : sum[d]) + next[d]);
  }
}

/// The paths from the left and from the right, side by side as neither waits for the other.
template <int Lanes>
ATLAS_AVX2_CLONES void pathsAlongRow(const std::uint8_t* costs, Steps steps, int width,
                                     std::uint16_t* total) {
  constexpr int kStride = Lanes + 2 * kMargin;
  alignas(32) std::uint8_t buffers[4][kStride];
  for (auto& buffer : buffers) {
    std::fill(buffer, buffer + kStride, kFar);
    std::fill(buffer + kMargin, buffer + kMargin + Lanes, std::uint8_t{0});
  }
  std::uint8_t right_least = 0, left_least = 0;
  for (int i = 0; i < width; ++i) {
    const std::ptrdiff_t to_right = static_cast<std::ptrdiff_t>(i) * Lanes;
    const std::ptrdiff_t to_left = static_cast<std::ptrdiff_t>(width - 1 - i) * Lanes;
    const std::uint8_t *right_from = buffers[i & 1] + kMargin, *left_from = buffers[2 + (i & 1)] + kMargin;
    std::uint8_t *right_next = buffers[(i + 1) & 1] + kMargin,
                 *left_next = buffers[2 + ((i + 1) & 1)] + kMargin;
    right_least = step<Lanes>(right_from, right_least, costs + to_right, steps.p1, steps.p2, right_next);
    left_least = step<Lanes>(left_from, left_least, costs + to_left, steps.p1, steps.p2, left_next);
    std::uint16_t* __restrict right_sum = total + to_right;
    for (int d = 0; d < Lanes; ++d) right_sum[d] = static_cast<std::uint16_t>(right_sum[d] + right_next[d]);
    std::uint16_t* __restrict left_sum = total + to_left;
    for (int d = 0; d < Lanes; ++d) left_sum[d] = static_cast<std::uint16_t>(left_sum[d] + left_next[d]);
  }
}

}  // namespace atlas::path
