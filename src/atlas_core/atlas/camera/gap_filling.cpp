// SPDX-License-Identifier: MIT
#include "atlas/camera/gap_filling.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "atlas/camera/visibility.hpp"

namespace atlas {
namespace {

/// One filled pixel at the end of a gap.
struct End {
  int at = 0;
  float depth = kNoDepth;
  float confidence = 0.0F;
};

/// Fills between ends that belong together.
class Filler {
 public:
  explicit Filler(const GapFillingParams& params)
      : focal_gap_(static_cast<float>(params.focal_px * params.largest_gap_m)),
        largest_gap_px_(static_cast<float>(params.largest_gap_px)),
        step_(static_cast<float>(1.0 + params.relative_step)) {}

  [[nodiscard]] bool belongTogether(const End& a, const End& b) const {
    const float nearer = std::min(a.depth, b.depth), farther = std::max(a.depth, b.depth);
    return farther <= nearer * step_ && static_cast<float>(b.at - a.at) * farther <= focal_gap_;
  }
  /// Gaps longer than this are never filled, whatever the depth.
  [[nodiscard]] int reach() const { return static_cast<int>(largest_gap_px_); }

  /// Calls set(at, depth, confidence) for all between the ends.
  template <class Set>
  void between(const End& a, const End& b, const Set& set) const {
    const float length = static_cast<float>(b.at - a.at);
    const float from = 1.0F / a.depth, slope = (1.0F / b.depth - from) / length;
    const float sure = std::min(a.confidence, b.confidence);
    for (int at = a.at + 1; at < b.at; ++at) {
      const int away = std::min(at - a.at, b.at - at);
      set(at, 1.0F / (from + slope * static_cast<float>(at - a.at)),
          sure * (1.0F - static_cast<float>(away) / largest_gap_px_));
    }
  }

 private:
  float focal_gap_, largest_gap_px_, step_;
};

/// Returns the pixels that hold a depth now.
PixelSet fillRows(cv::Mat& depth, cv::Mat& confidence, const PixelSet& measured, const Filler& filler) {
  PixelSet filled = measured;
  for (int row = 0; row < depth.rows; ++row) {
    float *z = depth.ptr<float>(row), *sure = confidence.ptr<float>(row);
    End last;
    measured.forEachInRow(row, [&](int column) {
      const End here{column, z[column], 1.0F};
      sure[column] = 1.0F;
      const int gap = here.at - last.at;
      if (last.depth != kNoDepth && gap > 1 && gap <= filler.reach() && filler.belongTogether(last, here)) {
        filler.between(last, here, [&](int at, float value, float how_sure) {
          z[at] = value;
          sure[at] = how_sure;
          filled.add(row, at);
        });
      }
      last = here;
    });
  }
  return filled;
}

void fillColumns(cv::Mat& depth, cv::Mat& confidence, const PixelSet& filled, const Filler& filler) {
  std::vector<End> last(static_cast<std::size_t>(depth.cols));
  for (int row = 0; row < depth.rows; ++row) {
    const float *z = depth.ptr<float>(row), *sure = confidence.ptr<float>(row);
    filled.forEachEndInRow(row, -1, [&](int column) {  // below a gap
      const End& above = last[static_cast<std::size_t>(column)];
      const End here{row, z[column], sure[column]};
      if (above.depth == kNoDepth || row - above.at > filler.reach() || !filler.belongTogether(above, here))
        return;
      filler.between(above, here, [&](int at, float value, float how_sure) {
        depth.ptr<float>(at)[column] = value;
        confidence.ptr<float>(at)[column] = how_sure;
      });
    });
    filled.forEachEndInRow(row, 1, [&](int column) {  // above one
      last[static_cast<std::size_t>(column)] = {row, z[column], sure[column]};
    });
  }
}

}  // namespace

void fillGaps(cv::Mat& depth, cv::Mat& confidence, const PixelSet& measured, const GapFillingParams& params) {
  const Filler filler(params);
  fillColumns(depth, confidence, fillRows(depth, confidence, measured, filler), filler);
}

}  // namespace atlas
