// SPDX-License-Identifier: MIT
// The road surface around the vehicle as a grid of heights in map. Each cell proposes its lowest points; a
// proposal is believed when it continues the believed cells nearer to the vehicle: the plane through them
// tells what to expect, and how much the road may bend is limited, not how steep it is. So the estimate
// follows hills, kerbs and speed bumps but does not climb onto a car of which a cell shows only the sill or
// the roof. Idea: the outward growth of Himmelsbach et al. 2010, "Fast segmentation of 3D point clouds for
// ground vehicles", on a square grid that all lidars fill together; local planes as in Lim et al. 2021,
// "Patchwork".
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct GroundParams {
  double cell_m = 1.0;
  double radius_m = 40.0;     ///< around the vehicle
  double tolerance_m = 0.25;  ///< points nearer to the surface than this are ground
  double max_slope = 0.3;     ///< rise over run where no slope is known yet; roads end at about 0.25
  double max_bend = 0.1;      ///< change of slope between neighbouring cells
  double max_step_m = 0.12;   ///< added to both limits: kerbs and noise
};

class GroundGrid {
 public:
  /// points: map, finite; center: the vehicle in map. Points outside the square of the radius are ignored.
  GroundGrid(const std::vector<LidarPoint>& points, const Eigen::Vector3d& center,
             const GroundParams& params);

  /// Height of the ground in map, bilinear between cell centres; NaN outside the grid or when nothing was
  /// seen.
  [[nodiscard]] double heightAt(double x, double y) const;
  /// Cells whose height was measured (the others are interpolated).
  [[nodiscard]] std::size_t believedCells() const;

 private:
  struct Cell {
    double proposal_m = 0;  ///< low percentile of the points, NaN when there are none
    double height_m = 0;
    double doubt_m = 0;  ///< distance to the nearest believed cell that the height rests on
    bool believed = false, visited = false;
  };
  struct PointsOfCells;
  [[nodiscard]] PointsOfCells sortIntoCells(const std::vector<LidarPoint>& points) const;
  void propose(PointsOfCells& in_cells);
  [[nodiscard]] double seedHeight() const;
  void grow();
  void visit(int ix, int iy, double seed_m);
  [[nodiscard]] std::vector<std::uint32_t> outwards() const;
  void fill();
  void center(const std::vector<LidarPoint>& points, const PointsOfCells& in_cells);
  [[nodiscard]] bool cellOf(double x, double y, int& ix, int& iy) const;
  [[nodiscard]] std::size_t indexOf(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(ix);
  }
  [[nodiscard]] const Cell& cell(int ix, int iy) const { return cells_[indexOf(ix, iy)]; }
  [[nodiscard]] Cell& cell(int ix, int iy) { return cells_[indexOf(ix, iy)]; }
  /// Calls use(cell, distance in m) for the visited or all cells within `reach` cells of (ix, iy), without
  /// itself.
  template <class Use>
  void forNeighbours(int ix, int iy, int reach, Use&& use) const;

  GroundParams params_;
  int side_ = 0;  ///< cells
  double cells_per_m_ = 0;
  double origin_x_ = 0,
         origin_y_ = 0;  ///< corner of cell (0, 0), on multiples of the cell: the grid does not swim
  double vehicle_x_ = 0, vehicle_y_ = 0;  ///< cells
  std::vector<Cell> cells_;
  std::vector<double> guessed_;  ///< of visit(), kept for its memory
};

}  // namespace atlas
