// SPDX-License-Identifier: MIT
// The u-disparity grid seen from above, without holes: each cell of a Cartesian grid gathers the columns and
// disparities that it covers, so there is nothing between them. Near the camera many columns and disparities
// fall into one cell: the largest along the disparity counts, and their mean over the columns. Far away one
// bin of disparity covers many cells: between bins the probability is linear, and the evidence of something
// there (the logarithm of its odds) is shared out among the cells, as it is in one of them.
// Frame: below the left camera, x forward, y left.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/stereo/u_disparity.hpp"

namespace atlas {

/// Cells of a grid on the ground, row by row: x grows along a row, y from row to row (as OccupancyGrid).
struct GroundCells {
  double origin_x_m = 0, origin_y_m = 0;  ///< lower corner of the first cell, ground frame of the left camera
  double cell_m = 0.2;
  int columns = 0, rows = 0;  ///< along x, along y
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const GroundCells& cells);

/// The way from u-disparity to the cells, worked out once.
class StereoGround {
 public:
  /// For grids with disparities from 0 to `range_px`.
  StereoGround(const StereoRig& rig, int range_px, const UDisparityParams& params, const GroundCells& cells);

  /// P(occupied) of each cell, [row * columns + column]; 0.5 outside the view and where nothing is known.
  /// Valid until the next call.
  const std::vector<float>& fill(const UDisparityGrid& grid);

 private:
  /// Cells at one distance from the camera, along y.
  struct Slice {
    double first_bin = 0, end_bin = 0;  ///< of disparity, from its far to its near side; none: not in view
    double middle_bin = 0;              ///< of its middle; bin k has its middle at k
  };
  struct Columns {
    std::int16_t first = 0, end = 0;  ///< of the image; none: not in view
  };
  void prepareSlice(int column);
  /// P(occupied) of the image's columns in a slice.
  void lookAlong(const Slice& slice, const UDisparityGrid& grid);

  StereoRig rig_;
  GroundCells cells_;
  int bins_per_px_ = 1, range_bins_ = 0;
  std::vector<Slice> slices_;     ///< by column of cells
  std::vector<float> share_;      ///< by slice and probability: what is left of it for one cell
  std::vector<Columns> columns_;  ///< [column * rows + row]
  std::vector<float> occupancy_;
  std::vector<std::uint16_t> seen_;  ///< by column of the image, in the slice at hand
  std::vector<std::uint32_t> sums_;  ///< of it, up to each column
};

}  // namespace atlas
