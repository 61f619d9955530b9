// SPDX-License-Identifier: MIT
#include "atlas/stereo/path_matcher.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "atlas/stereo/path_kernels.hpp"

namespace atlas {
namespace {

constexpr int kRoadLanes = 16;   // disparities around the road's that its hypothesis is tried at
constexpr int kRoadMiddle = 8;   // the lane that has the road's own disparity
constexpr int kRatioSteps = 16;  // of a disparity, between two lanes
constexpr std::uint8_t kNever = 0xFF;

using Bytes = std::vector<std::uint8_t>;

[[noreturn]] void reject(const std::string& field, const std::string& need, int value) {
  throw std::invalid_argument("path matcher: " + field + " must be " + need + ", got " +
                              std::to_string(value));
}

/// A census row from right to left with `before` and `after` more pixels as they are at its ends.
void reverseRow(const std::uint8_t* row, int width, int before, int after, Bytes& reversed) {
  reversed.resize(static_cast<std::size_t>(before + width + after));
  auto* to = std::fill_n(reversed.data(), before, row[width - 1]);
  to = std::reverse_copy(row, row + width, to);
  std::fill_n(to, after, row[0]);
}

/// Costs of the road's hypothesis at whole disparities: lane m is disparity m - kRoadMiddle + the whole part
/// of the road's, between the lanes m - 1 and m of `costs`. Lanes that `never` fills are not used.
ATLAS_AVX2_CLONES void shiftRoadLanes(const std::uint8_t* __restrict costs,
                                      const std::uint8_t* __restrict never, int ratio, int width,
                                      std::uint8_t* __restrict shifted) {
  for (int x = 0; x < width; ++x) {
    const std::uint8_t* cost = costs + static_cast<std::ptrdiff_t>(x) * kRoadLanes;
    std::uint8_t* __restrict to = shifted + static_cast<std::ptrdiff_t>(x) * kRoadLanes;
    for (int m = 0; m < kRoadLanes; ++m) {
      const int between =
          (cost[m - 1] * ratio + cost[m] * (kRatioSteps - ratio) + kRatioSteps / 2) / kRatioSteps;
      to[m] = static_cast<std::uint8_t>(between | never[m]);
    }
  }
}

/// The lesser cost of the two hypotheses; `first` is the disparity of the road's lane 0.
template <int Lanes>
ATLAS_AVX2_CLONES void takeLesser(const std::uint8_t* __restrict road, int first, int width,
                                  std::uint8_t* costs) {
  for (int x = 0; x < width; ++x) {
    const std::uint8_t* __restrict of_road = road + static_cast<std::ptrdiff_t>(x) * kRoadLanes;
    std::uint8_t* __restrict cost = costs + static_cast<std::ptrdiff_t>(x) * Lanes + first;
    for (int m = 0; m < kRoadLanes; ++m) cost[m] = std::min(cost[m], of_road[m]);
  }
}

}  // namespace

void validate(const PathParams& params) {
  if (params.small_step_cost < 0 || params.small_step_cost > 30)
    reject("small_step_cost", "in 0..30", params.small_step_cost);
  if (params.large_step_cost < params.small_step_cost || params.large_step_cost > 100)
    reject("large_step_cost", "in small_step_cost..100", params.large_step_cost);
  if (params.choice.uniqueness_percent < 0 || params.choice.uniqueness_percent > 100)
    reject("uniqueness_percent", "in 0..100", params.choice.uniqueness_percent);
  if (params.choice.max_left_right_px < 0)
    reject("max_left_right_px", "at least 0", params.choice.max_left_right_px);
}

class PathMatcher::Rows {
 public:
  virtual ~Rows() = default;
  virtual PathMatch match(const CensusImage& left, const CensusImage& right, const RoadCensus* road) = 0;
};

template <int Lanes>
class PathMatcher::RowsOf : public PathMatcher::Rows {
 public:
  RowsOf(cv::Size size, int range_px, const PathParams& params)
      : size_(size),
        steps_{static_cast<std::uint8_t>(params.small_step_cost),
               static_cast<std::uint8_t>(params.large_step_cost)},
        choice_(size.width, Lanes, range_px, params.choice) {
    const std::size_t width = static_cast<std::size_t>(size.width);
    for (auto& row : raw_) row.resize(width * Lanes);
    for (auto& row : road_raw_) row.resize(width * kRoadLanes);
    column_.resize(width * std::max(Lanes, kRoadLanes));
    frontal_.resize(width * Lanes);
    lesser_.resize(width * Lanes + 2 * kRoadLanes);
    road_window_.resize(width * kRoadLanes + 1);
    road_.resize(width * kRoadLanes);
    total_.resize(width * Lanes);
  }

  PathMatch match(const CensusImage& left, const CensusImage& right, const RoadCensus* road) override {
    start();
    PathMatch result{cv::Mat(size_, CV_32SC1), cv::Mat(size_, CV_8SC1, cv::Scalar(kNotRoad))};
    for (int v = 0; v < size_.height; ++v) {
      for (int ahead = v == 0 ? 0 : v + 1; ahead <= std::min(v + 1, size_.height - 1); ++ahead)
        compareRow(left, right, road, ahead);
      const bool on_road = costsOfRow(road, v);
      const std::uint8_t* costs = on_road ? lesser_.data() + kRoadLanes : frontal_.data();
      path::pathFromAbove<Lanes, 0>(costs, steps_, size_.width, sums_[0].data(), least_[0].data(),
                                    total_.data());
      path::pathFromAbove<Lanes, -1>(costs, steps_, size_.width, sums_[1].data(), least_[1].data(),
                                     total_.data());
      path::pathFromAbove<Lanes, 1>(costs, steps_, size_.width, sums_[2].data(), least_[2].data(),
                                    total_.data());
      path::pathsAlongRow<Lanes>(costs, steps_, size_.width, total_.data());
      const auto& chosen = choice_.choose(total_.data());
      std::copy(chosen.begin(), chosen.end(), result.disparity.ptr<std::int32_t>(v));
      if (on_road) compareHypotheses(chosen, result.road_evidence.ptr<std::int8_t>(v));
    }
    return result;
  }

 private:
  void start() {
    constexpr std::size_t kStride = Lanes + 2 * path::kMargin;
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      least_[k].assign(static_cast<std::size_t>(size_.width), 0);
      sums_[k].assign(static_cast<std::size_t>(size_.width) * kStride, path::kFar);
      for (int x = 0; x < size_.width; ++x)
        std::fill_n(sums_[k].data() + static_cast<std::size_t>(x) * kStride + path::kMargin, Lanes,
                    std::uint8_t{0});
    }
  }

  /// Costs of single pixels of a row, by both hypotheses.
  void compareRow(const CensusImage& left, const CensusImage& right, const RoadCensus* road, int v) {
    const std::uint8_t *low = left.low.ptr<std::uint8_t>(v), *high = left.high.ptr<std::uint8_t>(v);
    const std::size_t ring = static_cast<std::size_t>(v) % raw_.size();
    reverseRow(right.low.ptr<std::uint8_t>(v), size_.width, 0, Lanes, reversed_low_);
    reverseRow(right.high.ptr<std::uint8_t>(v), size_.width, 0, Lanes, reversed_high_);
    path::compare<Lanes>(low, high, {reversed_low_.data(), reversed_high_.data()}, size_.width,
                         raw_[ring].data());
    if (road == nullptr) return;
    reverseRow(road->right.low.ptr<std::uint8_t>(v), size_.width, kRoadMiddle, kRoadLanes, reversed_low_);
    reverseRow(road->right.high.ptr<std::uint8_t>(v), size_.width, kRoadMiddle, kRoadLanes, reversed_high_);
    path::compare<kRoadLanes>(low, high, {reversed_low_.data(), reversed_high_.data()}, size_.width,
                              road_raw_[ring].data());
  }

  /// Costs of the windows of a row; whether the road's hypothesis is among them.
  bool costsOfRow(const RoadCensus* road, int v) {
    const auto row = [&](auto& rows, int y) {
      return rows[static_cast<std::size_t>(std::clamp(y, 0, size_.height - 1)) % rows.size()].data();
    };
    path::sumWindows<Lanes>(row(raw_, v - 1), row(raw_, v), row(raw_, v + 1), size_.width, column_.data(),
                            frontal_.data());
    if (road == nullptr) return false;
    const double road_px = road->road.disparityAt(v);
    if (road_px < 0.0) return false;
    const int whole = static_cast<int>(road_px);
    first_ = whole - kRoadMiddle;
    if (first_ >= Lanes) return false;
    path::sumWindows<kRoadLanes>(row(road_raw_, v - 1), row(road_raw_, v), row(road_raw_, v + 1), size_.width,
                                 column_.data(), road_window_.data() + 1);
    std::array<std::uint8_t, kRoadLanes> never{};
    for (int m = 0; m < kRoadLanes; ++m) {
      const bool inside = m > 0 && first_ + m >= 0 && first_ + m < Lanes;
      never[static_cast<std::size_t>(m)] = inside ? 0 : kNever;
    }
    shiftRoadLanes(road_window_.data() + 1, never.data(), static_cast<int>((road_px - whole) * kRatioSteps),
                   size_.width, road_.data());
    std::copy(frontal_.begin(), frontal_.end(), lesser_.begin() + kRoadLanes);
    takeLesser<Lanes>(road_.data(), first_, size_.width, lesser_.data() + kRoadLanes);
    return true;
  }

  void compareHypotheses(const std::vector<std::int32_t>& chosen, std::int8_t* evidence) const {
    for (std::size_t x = 0; x < chosen.size(); ++x) {
      if (chosen[x] == kNoDisparity) continue;
      const int d = (chosen[x] + kDisparityScale / 2) / kDisparityScale, lane = d - first_;
      if (lane < 0 || lane >= kRoadLanes || d >= Lanes) continue;
      const std::uint8_t of_road = road_[x * kRoadLanes + static_cast<std::size_t>(lane)];
      if (of_road != kNever)
        evidence[x] = static_cast<std::int8_t>(frontal_[x * Lanes + static_cast<std::size_t>(d)] - of_road);
    }
  }

  cv::Size size_;
  path::Steps steps_;
  DisparityChoice choice_;
  int first_ = 0;                        ///< disparity of the road's lane 0 in the row at hand
  std::array<Bytes, 3> raw_, road_raw_;  ///< the last rows
  Bytes column_, frontal_, lesser_, road_window_, road_;
  Bytes reversed_low_, reversed_high_;
  std::array<Bytes, 3> sums_, least_;  ///< by path from above
  std::vector<std::uint16_t> total_;
};

PathMatcher::PathMatcher(cv::Size size, int range_px, const PathParams& params) {
  validate(params);
  if (range_px < 1 || range_px > 256) reject("range_px", "in 1..256", range_px);
  if (size.width < 1 || size.height < 1)
    reject("width and height", "positive", std::min(size.width, size.height));
  if (range_px <= 16)
    rows_ = std::make_unique<RowsOf<16>>(size, range_px, params);
  else if (range_px <= 32)
    rows_ = std::make_unique<RowsOf<32>>(size, range_px, params);
  else if (range_px <= 64)
    rows_ = std::make_unique<RowsOf<64>>(size, range_px, params);
  else if (range_px <= 128)
    rows_ = std::make_unique<RowsOf<128>>(size, range_px, params);
  else
    rows_ = std::make_unique<RowsOf<256>>(size, range_px, params);
}

PathMatcher::~PathMatcher() = default;

PathMatch PathMatcher::match(const CensusImage& left, const CensusImage& right, const RoadCensus* road) {
  return rows_->match(left, right, road);
}

}  // namespace atlas
