// SPDX-License-Identifier: MIT
// Occupancy in the plane of column and disparity, with visibility (Perrollaz, Yoder, Laugier 2010;
// Paromtchik, Perrollaz, Laugier 2011, eq. (1)):
//   P(O) = [P(V) P(C) (1 - P_fp) + P(V) (1 - P(C)) P_fn + (1 - P(V)) / 2] (1 - P(R))
// A cell is a column u and a bin of disparities. Of the rows in which a thing of at most max_height_m that
// stands on the road there would be seen (N_P), those count as visible (N_V) whose measured disparity is not
// greater than the cell's (nothing nearer hides it) and known. P(V) = N_V / N_P; P(C) and P(R) saturate with
// the share of the visible rows that are obstacle there, and of the road's rows that are road there:
//   P(C) = 1 - exp(-N_O / N_V / obstacle_share),  P(R) = 1 - exp(-N_R / (N_R* + N_O) / road_share)
// N_R* = rows that the road has in a bin; N_O beside it, because the cell at the foot of a thing holds road
// and thing. N_O and N_R are spread over the bins by the matcher's error.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/stereo/disparity_image.hpp"
#include "atlas/stereo/stereo_rig.hpp"

namespace atlas {

struct UDisparityParams {
  double false_positive = 0.01;      ///< P_fp of the matcher
  double false_negative = 0.05;      ///< P_fn
  double max_height_m = 2.0;         ///< what is higher above the road is no obstacle
  double obstacle_share = 0.15;      ///< see P(C)
  double road_share = 0.15;          ///< see P(R)
  int bins_per_px = 4;               ///< of disparity
  double disparity_sigma_px = 0.25;  ///< standard deviation of a matched disparity
  double min_probability = 0.02;     ///< no single image is surer that a cell is empty
  double max_probability = 0.98;     ///< or occupied
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const UDisparityParams& params);

/// A probability of 1 in a grid.
constexpr int kProbabilityOne = 1 << 14;

/// Probability of occupation by column and bin of disparity; a half where nothing is known.
struct UDisparityGrid {
  int columns = 0;  ///< those of the image
  int bins = 0;     ///< bin k holds disparities [k, k + 1) / bins_per_px
  int bins_per_px = 1;
  std::vector<std::uint16_t> occupancy;  ///< [bin * columns + column], 0..kProbabilityOne
};

/// Makes the grids of one rig's images; keeps its buffers between images. Not for use by two threads at once.
class UDisparity {
 public:
  /// Disparities from 0 to `range_px` have bins.
  UDisparity(const StereoRig& rig, int range_px, const UDisparityParams& params);

  /// Valid until the next call. Throws std::invalid_argument for an image of another size or without road:
  /// heights above the road are not known then.
  const UDisparityGrid& compute(const DisparityImage& image);

 private:
  void prepareRows(const RoadProfile& road);
  void count(const DisparityImage& image);
  void evaluate();

  StereoRig rig_;
  UDisparityParams params_;
  UDisparityGrid grid_;
  std::vector<float> kernel_;  ///< share of a count at 0, 1, 2 ... bins from where it was counted
  std::vector<std::uint16_t> first_, end_;  ///< by row: bins in which the row is one of the possible ones
  std::vector<std::uint16_t> possible_;     ///< N_P by bin
  std::vector<float> road_rows_;            ///< N_R* by bin
  std::vector<std::uint16_t> obstacle_;     ///< pixels that are obstacle there, with a margin of bins around
  std::vector<std::uint16_t> way_;          ///< that are road there, same
  std::vector<std::uint16_t> beyond_;       ///< that are farther: their row is visible from this bin on, same
  std::vector<std::uint16_t> visible_;      ///< N_V of the bin at hand, by column
};

}  // namespace atlas
