// SPDX-License-Identifier: MIT
// Matching with both hypotheses of the double correlation, with costs gathered along paths (semi-global
// matching, Hirschmueller 2008) instead of in one large window: the cost of a disparity is that of a 3x3
// window of census comparisons, in the image as it is or in the view of the road, whichever is less, and
//   L(p, d) = C(p, d) + min(L(q, d), L(q, d +- 1) + P1, min L(q) + P2) - min L(q)
// sums along five paths, from the left, the right and the three pixels above. One pass over the rows, whole
// numbers only.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "atlas/stereo/census.hpp"
#include "atlas/stereo/disparity_choice.hpp"
#include "atlas/stereo/disparity_image.hpp"

namespace atlas {

struct PathParams {
  int small_step_cost = 6;   ///< P1, for a disparity that changes by one; a match costs 0..72
  int large_step_cost = 30;  ///< P2, for a greater change
  ChoiceParams choice;
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const PathParams& params);

struct PathMatch {
  cv::Mat disparity;  ///< CV_32SC1, 1/256 px, or kNoDisparity
  cv::Mat surface;    ///< CV_8UC1 of SurfaceLabel; without road everything is an obstacle
};

/// The second hypothesis: the census of the right image in the view of the road.
struct RoadCensus {
  CensusImage right;
  RoadProfile road;
};

/// Keeps its buffers between images of one size. Not for use by two threads at once.
class PathMatcher {
 public:
  /// Disparities 0 <= d < range_px, at most 256.
  PathMatcher(cv::Size size, int range_px, const PathParams& params);
  ~PathMatcher();

  /// `road`: null when it is unknown.
  PathMatch match(const CensusImage& left, const CensusImage& right, const RoadCensus* road);

 private:
  class Rows;
  template <int Lanes>
  class RowsOf;
  std::unique_ptr<Rows> rows_;
};

}  // namespace atlas
