// SPDX-License-Identifier: MIT
#include "atlas/stereo/refinement.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "atlas/base/avx2_clones.hpp"
#include "atlas/stereo/disparity_choice.hpp"
#include "atlas/stereo/disparity_image.hpp"

namespace atlas {
namespace {

constexpr int kReach = 3;  // of the window, px
constexpr int kWindow = 2 * kReach + 1;
constexpr int kSameSurface =
    256;                     // half pixels' disparities that differ by less are of one surface, 1/256 px
constexpr int kNoise = 350;  // of the sum of squared slopes (4 g)^2 of a window without texture

using Row16 = std::vector<std::int16_t>;
using Row32 = std::vector<std::int32_t>;

/// A neighbour's disparity when it is of the same surface, else the pixel's own.
inline int sameSurface(int neighbour, int own) {
  const int away = neighbour - own;
  return away <= kSameSurface && away >= -kSameSurface && neighbour >= 0 ? neighbour : own;
}

/// Both pixels of the doubled row for each pixel of the `near` row; `far` is the row on their other side.
ATLAS_AVX2_CLONES void doubleRow(const std::int32_t* __restrict near, const std::int32_t* __restrict far,
                                 int width, std::int32_t* __restrict doubled) {
  for (int x = 0; x < width; ++x) {
    const int own = near[x], beside = sameSurface(far[x], own);
    for (int side = 0; side < 2; ++side) {
      const int towards = x + 2 * side - 1;
      const int along = sameSurface(near[towards], own), across = sameSurface(far[towards], own);
      const int sum = (9 * own + 3 * beside + 3 * along + across) / 8;
      doubled[2 * x + side] = own < 0 ? kNoDisparity : sum;
    }
  }
}

/// A quarter of the horizontal Sobel gradient.
ATLAS_AVX2_CLONES void gradientRow(const std::uint8_t* __restrict above, const std::uint8_t* __restrict row,
                                   const std::uint8_t* __restrict below, int width,
                                   std::int16_t* __restrict gradient) {
  for (int x = 1; x < width - 1; ++x) {
    const int after = above[x + 1] + 2 * row[x + 1] + below[x + 1];
    const int before = above[x - 1] + 2 * row[x - 1] + below[x - 1];
    gradient[x] = static_cast<std::int16_t>((after - before) / 4);
  }
  gradient[0] = gradient[1];
  gradient[width - 1] = gradient[width - 2];
}

void gradientOf(const cv::Mat& image, int v, Row16& gradient) {
  gradientRow(image.ptr<std::uint8_t>(std::max(v - 1, 0)), image.ptr<std::uint8_t>(v),
              image.ptr<std::uint8_t>(std::min(v + 1, image.rows - 1)), image.cols, gradient.data());
}

/// What a pixel adds to the sums of its window: (4 g)^2 and 4 g (l - r); nothing where it is not seen.
void comparePixels(const Row16& left, const Row16& right, const std::int32_t* disparity, Row32& squares,
                   Row32& products) {
  const int width = static_cast<int>(left.size());
  const std::int16_t *l = left.data(), *r = right.data();
  for (int x = 0; x < width; ++x) {
    const std::size_t at = static_cast<std::size_t>(x);
    squares[at] = products[at] = 0;
    if (disparity[x] < 0 || x == 0 || x == width - 1) continue;
    const int place = x * kDisparityScale - disparity[x];
    const int pixel = place >> 8, ratio = place & (kDisparityScale - 1);
    if (pixel < 1 || pixel + 2 >= width) continue;
    const int value = r[pixel] * (kDisparityScale - ratio) + r[pixel + 1] * ratio;
    const int slope =
        (r[pixel + 1] - r[pixel - 1]) * (kDisparityScale - ratio) + (r[pixel + 2] - r[pixel]) * ratio;
    const int sum = (slope >> 8) + l[x + 1] - l[x - 1];
    squares[at] = sum * sum;
    products[at] = sum * (l[x] - (value >> 8));
  }
}

/// Adds the row that comes into the windows and takes away the one that leaves them.
ATLAS_AVX2_CLONES void moveWindow(const std::int32_t* __restrict in, const std::int32_t* __restrict out,
                                  int width, std::int32_t* __restrict sum) {
  for (int x = 0; x < width; ++x) sum[x] += in[x] - out[x];
}

/// `squares` and `products` begin kReach pixels before the row.
ATLAS_AVX2_CLONES void stepRow(const std::int32_t* __restrict squares,
                               const std::int32_t* __restrict products, int width,
                               std::int32_t* __restrict disparity) {
  constexpr int kMost = kDisparityScale;
  for (int x = 0; x < width; ++x) {
    int square = 0, product = 0;
    for (int k = 0; k < kWindow; ++k) {
      square += squares[x + k];
      product += products[x + k];
    }
    int step = static_cast<int>(static_cast<float>(product) * (-4.0F * kDisparityScale) /
                                static_cast<float>(square + kNoise));
    step = step > kMost ? kMost : step;
    step = step < -kMost ? -kMost : step;
    const int moved = disparity[x] + step;
    disparity[x] = disparity[x] < 0 ? kNoDisparity : (moved < 0 ? 0 : moved);
  }
}

}  // namespace

void doubled(const cv::Mat& half, cv::Mat& full) {
  const std::size_t width = static_cast<std::size_t>(half.cols);
  Row32 near(width + 2, kNoDisparity), far(width + 2, kNoDisparity), row(2 * width);
  for (int v = 0; v < full.rows; ++v) {
    const int at = v / 2, beside = std::clamp(v % 2 == 0 ? at - 1 : at + 1, 0, half.rows - 1);
    std::copy_n(half.ptr<std::int32_t>(at), width, near.begin() + 1);
    std::copy_n(half.ptr<std::int32_t>(beside), width, far.begin() + 1);
    doubleRow(near.data() + 1, far.data() + 1, half.cols, row.data());
    std::copy_n(row.begin(), full.cols, full.ptr<std::int32_t>(v));
  }
}

void refine(const cv::Mat& left, const cv::Mat& right, cv::Mat& disparity) {
  if (left.cols < kWindow || left.rows < 2) return;
  const std::size_t width = static_cast<std::size_t>(left.cols);
  Row16 left_gradient(width), right_gradient(width);
  struct Products {
    Row32 squares, products;
  };
  std::array<Products, kWindow + 1> rows;  // ring: those of the window and the one that leaves it
  for (auto& row : rows) row = {Row32(width), Row32(width)};
  Row32 squares(width + 2 * kReach), products(width + 2 * kReach);
  for (int ahead = 0; ahead < left.rows + kReach; ++ahead) {
    Products& in = rows[static_cast<std::size_t>(ahead) % rows.size()];
    const Products& out = rows[static_cast<std::size_t>(ahead + 1) % rows.size()];
    if (ahead < left.rows) {
      gradientOf(left, ahead, left_gradient);
      gradientOf(right, ahead, right_gradient);
      comparePixels(left_gradient, right_gradient, disparity.ptr<std::int32_t>(ahead), in.squares,
                    in.products);
    } else {
      std::fill(in.squares.begin(), in.squares.end(), 0);
      std::fill(in.products.begin(), in.products.end(), 0);
    }
    moveWindow(in.squares.data(), out.squares.data(), left.cols, squares.data() + kReach);
    moveWindow(in.products.data(), out.products.data(), left.cols, products.data() + kReach);
    if (ahead >= kReach)
      stepRow(squares.data(), products.data(), left.cols, disparity.ptr<std::int32_t>(ahead - kReach));
  }
}

}  // namespace atlas
