// SPDX-License-Identifier: MIT
#include "atlas/stereo/window_matcher.hpp"

#include <algorithm>
#include <cstdint>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "atlas/base/avx2_clones.hpp"
#include "atlas/stereo/road_view.hpp"

namespace atlas {
namespace {

constexpr int kClip = 31;        // of a gradient; windows at edges are not ruled by them
constexpr int kRoadLanes = 32;   // disparities around the road's
constexpr int kRoadMiddle = 16;  // the lane of the road's own
using Bytes = std::vector<std::uint8_t>;
using Sums = std::vector<std::uint16_t>;

[[noreturn]] void reject(const std::string& field, const std::string& need, int value) {
  throw std::invalid_argument("window matcher: " + field + " must be " + need + ", got " +
                              std::to_string(value));
}

/// Horizontal Sobel gradient / 4, clipped, from 0 to 2 kClip.
ATLAS_AVX2_CLONES void clippedGradient(const std::uint8_t* __restrict above,
                                       const std::uint8_t* __restrict row,
                                       const std::uint8_t* __restrict below, int width,
                                       std::uint8_t* __restrict gradient) {
  for (int x = 0; x < width; ++x) {
    const int after = above[x + 2] + 2 * row[x + 2] + below[x + 2];
    const int value = (after - above[x] - 2 * row[x] - below[x]) / 4;
    const int low = value < -kClip ? -kClip : value;
    gradient[x] = static_cast<std::uint8_t>((low > kClip ? kClip : low) + kClip);
  }
}

cv::Mat gradientOf(const cv::Mat& grey) {
  cv::Mat padded, gradient(grey.size(), CV_8UC1);
  cv::copyMakeBorder(grey, padded, 1, 1, 1, 1, cv::BORDER_REPLICATE);
  for (int v = 0; v < grey.rows; ++v)
    clippedGradient(padded.ptr<std::uint8_t>(v), padded.ptr<std::uint8_t>(v + 1),
                    padded.ptr<std::uint8_t>(v + 2), grey.cols, gradient.ptr<std::uint8_t>(v));
  return gradient;
}

/// `right` from right to left: [width - 1 - x + d] belongs to disparity d of pixel x.
template <int Lanes>
ATLAS_AVX2_CLONES void differences(const std::uint8_t* left, const std::uint8_t* right, int width,
                                   std::uint8_t* __restrict costs) {
  for (int x = 0; x < width; ++x) {
    const std::uint8_t value = left[x], *other = right + (width - 1 - x);
    std::uint8_t* __restrict cost = costs + static_cast<std::ptrdiff_t>(x) * Lanes;
    for (int d = 0; d < Lanes; ++d)
      cost[d] = static_cast<std::uint8_t>(std::max(value, other[d]) - std::min(value, other[d]));
  }
}

ATLAS_AVX2_CLONES void moveColumns(const std::uint8_t* __restrict in, const std::uint8_t* __restrict out,
                                   int count, std::uint16_t* __restrict sums) {
  for (int i = 0; i < count; ++i) sums[i] = static_cast<std::uint16_t>(sums[i] + in[i] - out[i]);
}

template <int Lanes>
ATLAS_AVX2_CLONES void slideAlong(const std::uint16_t* columns, int reach, int width,
                                  std::uint16_t* windows) {
  alignas(32) std::uint16_t sum[Lanes] = {};
  const auto column = [&](int x) {
    return columns + static_cast<std::ptrdiff_t>(std::min(std::max(x, 0), width - 1)) * Lanes;
  };
  for (int x = -reach; x < reach; ++x)
    for (int d = 0; d < Lanes; ++d) sum[d] = static_cast<std::uint16_t>(sum[d] + column(x)[d]);
  for (int x = 0; x < width; ++x) {
    const std::uint16_t *in = column(x + reach), *out = column(x - reach);
    std::uint16_t* __restrict window = windows + static_cast<std::ptrdiff_t>(x) * Lanes;
    for (int d = 0; d < Lanes; ++d) {
      window[d] = static_cast<std::uint16_t>(sum[d] + in[d]);
      sum[d] = static_cast<std::uint16_t>(window[d] - out[d]);
    }
  }
}

/// One hypothesis: the costs of windows, row by row, and what they choose.
template <int Lanes>
class Hypothesis {
 public:
  Hypothesis(cv::Size size, int of_zero, int allowed, const WindowParams& params)
      : size_(size),
        reach_(params.side_px / 2),
        of_zero_(of_zero),
        choice_(size.width, {Lanes, of_zero, allowed}, params.choice) {
    const std::size_t count = static_cast<std::size_t>(size.width) * Lanes;
    ring_.assign(static_cast<std::size_t>(params.side_px) + 1, Bytes(count));
    columns_.resize(count);
    windows_.resize(count);
  }
  void start(const cv::Mat& left, const cv::Mat& right) {
    left_ = left;
    right_ = right;
    std::fill(columns_.begin(), columns_.end(), std::uint16_t{0});
    for (auto& row : ring_) std::fill(row.begin(), row.end(), std::uint8_t{0});
    next_ = 0;
    for (int v = -reach_; v < reach_; ++v) comeIn(v);
  }
  /// The rows are asked for in order.
  const std::vector<std::int32_t>& choose(int v) {
    comeIn(v + reach_);
    slideAlong<Lanes>(columns_.data(), reach_, size_.width, windows_.data());
    return choice_.choose(windows_.data());
  }
  [[nodiscard]] const Sums& costs() const { return choice_.costs(); }

 private:
  /// The row that comes into the windows, and away goes the one that leaves them.
  void comeIn(int v) {
    const int row = std::clamp(v, 0, size_.height - 1);
    const std::uint8_t* right = right_.ptr<std::uint8_t>(row);
    reversed_.resize(static_cast<std::size_t>(of_zero_ + size_.width + Lanes));
    auto* to = std::fill_n(reversed_.data(), of_zero_, right[size_.width - 1]);
    to = std::reverse_copy(right, right + size_.width, to);
    std::fill_n(to, Lanes, right[0]);
    Bytes &in = ring_[next_ % ring_.size()], &out = ring_[(next_ + 1) % ring_.size()];
    differences<Lanes>(left_.ptr<std::uint8_t>(row), reversed_.data(), size_.width, in.data());
    moveColumns(in.data(), out.data(), size_.width * Lanes, columns_.data());
    ++next_;
  }

  cv::Size size_;
  int reach_, of_zero_;
  DisparityChoice choice_;
  cv::Mat left_, right_;
  std::vector<Bytes> ring_;
  std::size_t next_ = 0;
  Bytes reversed_;
  Sums columns_, windows_;
};

}  // namespace

void validate(const WindowParams& params) {
  if (params.side_px < 3 || params.side_px > 31 || params.side_px % 2 == 0)
    reject("side_px", "odd and in 3..31", params.side_px);
  validate(params.choice);
}

class WindowMatcher::Frontal {
 public:
  virtual ~Frontal() = default;
  virtual void start(const cv::Mat& left, const cv::Mat& right) = 0;
  virtual const std::vector<std::int32_t>& choose(int v) = 0;
  [[nodiscard]] virtual const Sums& costs() const = 0;
};

template <int Lanes>
class WindowMatcher::FrontalOf : public WindowMatcher::Frontal {
 public:
  FrontalOf(cv::Size size, int range_px, const WindowParams& params)
      : hypothesis_(size, 0, range_px, params) {}
  void start(const cv::Mat& left, const cv::Mat& right) override { hypothesis_.start(left, right); }
  const std::vector<std::int32_t>& choose(int v) override { return hypothesis_.choose(v); }
  [[nodiscard]] const Sums& costs() const override { return hypothesis_.costs(); }

 private:
  Hypothesis<Lanes> hypothesis_;
};

class WindowMatcher::Road : public Hypothesis<kRoadLanes> {
 public:
  using Hypothesis<kRoadLanes>::Hypothesis;
};

WindowMatcher::WindowMatcher(cv::Size size, int range_px, const WindowParams& params) : size_(size) {
  validate(params);
  if (range_px < 1 || range_px > 256) reject("range_px", "in 1..256", range_px);
  if (size.width < 1 || size.height < 1)
    reject("width and height", "positive", std::min(size.width, size.height));
  if (range_px <= 32)
    frontal_ = std::make_unique<FrontalOf<32>>(size, range_px, params);
  else if (range_px <= 64)
    frontal_ = std::make_unique<FrontalOf<64>>(size, range_px, params);
  else if (range_px <= 128)
    frontal_ = std::make_unique<FrontalOf<128>>(size, range_px, params);
  else
    frontal_ = std::make_unique<FrontalOf<256>>(size, range_px, params);
  road_ = std::make_unique<Road>(size, kRoadMiddle, kRoadLanes, params);
}

WindowMatcher::~WindowMatcher() = default;

WindowMatch WindowMatcher::match(const cv::Mat& left, const cv::Mat& right, const RoadProfile* road) {
  const cv::Mat left_gradient = gradientOf(left);
  frontal_->start(left_gradient, gradientOf(right));
  if (road != nullptr) road_->start(left_gradient, gradientOf(shearedByRoad(right, *road)));
  WindowMatch result{cv::Mat(size_, CV_32SC1), cv::Mat(size_, CV_8UC1)};
  for (int v = 0; v < size_.height; ++v) {
    const auto& things = frontal_->choose(v);
    const auto* roads = road == nullptr ? nullptr : &road_->choose(v);
    const double road_px = road == nullptr ? -1.0 : road->disparityAt(v);
    const int on_road = static_cast<int>(road_px * kDisparityScale);
    std::int32_t* disparity = result.disparity.ptr<std::int32_t>(v);
    std::uint8_t* surface = result.surface.ptr<std::uint8_t>(v);
    for (std::size_t u = 0; u < things.size(); ++u) {
      const bool is_road = road_px >= 0.0 && road_->costs()[u] <= frontal_->costs()[u];
      const std::int32_t chosen = is_road ? (*roads)[u] : things[u];
      const SurfaceLabel label = is_road ? SurfaceLabel::kRoad : SurfaceLabel::kObstacle;
      const std::int32_t found = is_road && chosen != kNoChoice ? chosen + on_road : chosen;
      disparity[u] = chosen == kNoChoice ? kNoDisparity : std::max(found, 0);
      surface[u] = static_cast<std::uint8_t>(chosen == kNoChoice ? SurfaceLabel::kUnknown : label);
    }
  }
  return result;
}

}  // namespace atlas
