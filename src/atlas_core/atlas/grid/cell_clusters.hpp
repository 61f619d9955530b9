// SPDX-License-Identifier: MIT
// Occupied cells that touch (all eight neighbours) and move alike are one cluster. Velocities are compared
// between neighbours only: front and rear of a turning car differ by metres per second, two cells side by
// side by centimetres, so a car that turns stays whole while a bicycle that passes it is cut off.
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/grid/cell_estimates.hpp"
#include "atlas/grid/grid_geometry.hpp"

namespace atlas {

/// A cell of a cluster with what the tracker asks of it. Mean velocity whether it stands or moves, and the
/// uncertainty of that.
struct ClusterCell {
  Eigen::Vector2d position;  ///< m, map
  Eigen::Vector2d velocity;  ///< m/s, map
  double variance = 0;       ///< m^2/s^2, of both components together
  double weight = 0;         ///< P(occupied)
  float static_share = 0;
  float top_m = 0;          ///< NaN: unknown
  bool seen = false;        ///< a sensor says so now; else it is remembered
  std::uint32_t index = 0;  ///< in the grid
};
using Cluster = std::vector<ClusterCell>;

struct CellClusters {
  std::vector<std::int32_t> cluster_of_cell;  ///< 1 + index in `clusters`, 0 = none
  std::vector<Cluster> clusters;              ///< in raster order of their first cells
};

struct ClusteringInput {
  const GridGeometry& geometry;
  const CellEstimates& cells;
  const std::vector<float>& evidence;  ///< P(occupied | Z) of this time
  const std::vector<float>& top_m;     ///< highest return above the road, NaN where there is none
};

[[nodiscard]] CellClusters clusterCells(const ClusteringInput& input, double occupied,
                                        double velocity_gate_mps);

/// A rectangle on the ground.
struct GroundBox {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double yaw_rad = 0, length = 0, width = 0;
};
/// The box of the cells along a direction.
[[nodiscard]] GroundBox boxAlong(const Cluster& cells, double yaw_rad, double cell_m);
/// The same along the cells' principal axis, length >= width.
[[nodiscard]] GroundBox principalBox(const Cluster& cells, double cell_m);
/// The same along the sides that the sensor sees (lidar/oriented_box.hpp): of two sides of a car, an L, the
/// principal axis is the diagonal. The principal box of a few cells.
[[nodiscard]] GroundBox outlineBox(const Cluster& cells, const Eigen::Vector2d& seen_from_map, double cell_m);

}  // namespace atlas
