// SPDX-License-Identifier: MIT
#include "atlas/stereo/path_matcher.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "atlas/stereo/hypothesis_windows.hpp"
#include "atlas/stereo/path_kernels.hpp"

namespace atlas {
namespace {

constexpr int kRatioSteps = 16;                         // of a disparity, between two lanes
constexpr std::size_t kRing = 2 * kLabelReachRows + 2;  // rows whose costs are kept
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
  validate(params.choice);
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
        choice_(size.width, {Lanes, 0, range_px}, params.choice),
        windows_(size.width, Lanes) {
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
    constexpr auto kThing = static_cast<std::uint8_t>(SurfaceLabel::kObstacle);
    PathMatch result{cv::Mat(size_, CV_32SC1), cv::Mat(size_, CV_8UC1, cv::Scalar(0))};
    for (int ahead = 0; ahead < size_.height + kLabelReachRows; ++ahead) {
      if (ahead < size_.height) compareRow(left, right, road, ahead);
      const int v = ahead - 1;  // the row above and below are there
      if (v >= 0 && v < size_.height) {
        const auto& chosen = matchRow(road, v);
        std::transform(chosen.begin(), chosen.end(), result.disparity.ptr<std::int32_t>(v),
                       [](std::int32_t d) { return d == kNoChoice ? kNoDisparity : std::max(d, 0); });
      }
      if (road != nullptr) moveWindows(ahead);
      const int middle = ahead - kLabelReachRows;
      if (middle < 0) continue;
      const std::int32_t* disparity = result.disparity.ptr<std::int32_t>(middle);
      std::uint8_t* surface = result.surface.ptr<std::uint8_t>(middle);
      const double road_px = road == nullptr ? -1.0 : road->road.disparityAt(middle);
      if (road_px >= 0.0)
        windows_.label(disparity, road_px, surface);
      else
        for (int x = 0; x < size_.width; ++x) surface[x] = disparity[x] < 0 ? 0 : kThing;
    }
    return result;
  }

 private:
  void start() {
    windows_.clear();
    constexpr std::size_t kStride = Lanes + 2 * path::kMargin;
    for (std::size_t k = 0; k < sums_.size(); ++k) {
      least_[k].assign(static_cast<std::size_t>(size_.width), 0);
      sums_[k].assign(static_cast<std::size_t>(size_.width) * kStride, path::kFar);
      for (int x = 0; x < size_.width; ++x)
        std::fill_n(sums_[k].data() + static_cast<std::size_t>(x) * kStride + path::kMargin, Lanes,
                    std::uint8_t{0});
    }
  }

  const std::vector<std::int32_t>& matchRow(const RoadCensus* road, int v) {
    const bool on_road = costsOfRow(road, v);
    const std::uint8_t* costs = on_road ? lesser_.data() + kRoadLanes : frontal_.data();
    path::pathFromAbove<Lanes, 0>(costs, steps_, size_.width, sums_[0].data(), least_[0].data(),
                                  total_.data());
    path::pathFromAbove<Lanes, -1>(costs, steps_, size_.width, sums_[1].data(), least_[1].data(),
                                   total_.data());
    path::pathFromAbove<Lanes, 1>(costs, steps_, size_.width, sums_[2].data(), least_[2].data(),
                                  total_.data());
    path::pathsAlongRow<Lanes>(costs, steps_, size_.width, total_.data());
    return choice_.choose(total_.data());
  }

  /// The windows whose last row is `last`.
  void moveWindows(int last) {
    const auto row = [](auto& rows, int v) { return rows[static_cast<std::size_t>(v) % kRing].data(); };
    if (last < size_.height) windows_.add(row(raw_, last), row(road_raw_, last));
    const int gone = last - 2 * kLabelReachRows - 1;
    if (gone >= 0) windows_.remove(row(raw_, gone), row(road_raw_, gone));
  }

  /// Costs of single pixels of a row, by both hypotheses.
  void compareRow(const CensusImage& left, const CensusImage& right, const RoadCensus* road, int v) {
    const std::uint8_t *low = left.low.ptr<std::uint8_t>(v), *high = left.high.ptr<std::uint8_t>(v);
    const std::size_t ring = static_cast<std::size_t>(v) % kRing;
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
      return rows[static_cast<std::size_t>(std::clamp(y, 0, size_.height - 1)) % kRing].data();
    };
    path::sumWindows<Lanes>(row(raw_, v - 1), row(raw_, v), row(raw_, v + 1), size_.width, column_.data(),
                            frontal_.data());
    if (road == nullptr) return false;
    const double road_px = road->road.disparityAt(v);
    if (road_px < 0.0) return false;
    const int whole = static_cast<int>(road_px);
    const int first = whole - kRoadMiddle;
    if (first >= Lanes) return false;
    path::sumWindows<kRoadLanes>(row(road_raw_, v - 1), row(road_raw_, v), row(road_raw_, v + 1), size_.width,
                                 column_.data(), road_window_.data() + 1);
    std::array<std::uint8_t, kRoadLanes> never{};
    for (int m = 0; m < kRoadLanes; ++m) {
      const bool inside = m > 0 && first + m >= 0 && first + m < Lanes;
      never[static_cast<std::size_t>(m)] = inside ? 0 : kNever;
    }
    shiftRoadLanes(road_window_.data() + 1, never.data(), static_cast<int>((road_px - whole) * kRatioSteps),
                   size_.width, road_.data());
    std::copy(frontal_.begin(), frontal_.end(), lesser_.begin() + kRoadLanes);
    takeLesser<Lanes>(road_.data(), first, size_.width, lesser_.data() + kRoadLanes);
    return true;
  }

  cv::Size size_;
  path::Steps steps_;
  DisparityChoice choice_;
  std::array<Bytes, kRing> raw_, road_raw_;  ///< costs of the last rows
  HypothesisWindows windows_;
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
  if (range_px <= 32)
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
