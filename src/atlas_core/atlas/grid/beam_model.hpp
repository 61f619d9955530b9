// SPDX-License-Identifier: MIT
// Occupancy of the cells as one lidar tells it: the inverse beam model (Thrun, Burgard, Fox 2005,
// "Probabilistic Robotics", chapters 6.3 and 9), each layer on its own, then the product of the layers
// (Paromtchik, Perrollaz, Laugier 2011, II-A). Of a beam that measured z, a cell at range r says
//   P(occ | z, r) = 1/2                                              r > z + a   (in its shadow)
//                 = 1/2 + (p_hit - 1/2) exp(-(r - z)^2 / (2 s^2))    |r - z| <= a
//                 = 1/2 - (1/2 - p_free) (1 - r / r_max) w(h)        r < z - a   (seen through)
//   s^2 = range_sigma^2 + cell^2 / 12,  a = max(cell / 2, 2 s)
// h is the beam's height above the road there: a beam over the bonnet of a car does not say that the place is
// free, so w falls from 1 to 0 between two heights. A return from the road is no obstacle; how sure that is
// falls with the distance, as the road is taken as flat. A cell asks all beams that cross its width, and a
// hit counts before a beam that passes: between two beams there is no hole at any range.
#pragma once

#include <cmath>
#include <vector>

#include "atlas/grid/grid_geometry.hpp"
#include "atlas/grid/lidar_layers.hpp"
#include "atlas/grid/row_workers.hpp"

namespace atlas {

struct BeamParams {
  double hit = 0.85;            ///< P(occupied) where a beam ended
  double free = 0.25;           ///< P(occupied) where a beam passed, close to the lidar
  double range_sigma_m = 0.06;  ///< noise of a range
  double max_range_m = 60.0;    ///< free says nothing beyond
  double trusted_m = 20.0;      ///< up to here a beam without return passed
  double min_height_m = 0.25;   ///< above the road: lower returns are the road's
  double slope_sigma = 0.01;    ///< the road's height is this uncertain per metre of distance
  double max_height_m = 2.0;    ///< above the road: higher returns are no obstacle
  double sure_free_height_m =
      0.7;                    ///< beams up to here above the road say free in full, at max_height_m nothing
  double layer_weight = 1.0;  ///< exponent of each layer in the product; less where layers err together
  double min_probability = 0.02, max_probability = 0.98;  ///< of one lidar at one time
};
void validate(const BeamParams& params);

/// The road as a plane in map: z at (x, y) = height + slope . (x, y).
struct RoadPlane {
  double height_m = 0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  [[nodiscard]] double heightAt(double x, double y) const { return height_m + slope.x() * x + slope.y() * y; }
};

/// What a lidar says of each cell.
struct LidarEvidence {
  std::vector<float> occupied;  ///< P(occupied | its layers); 0.5 = nothing known
  std::vector<float> top_m;     ///< highest return in the cell above the road, NaN without one
};

/// Azimuths of the polar cells.
namespace polar {
constexpr int kAzimuths = 1440;
constexpr float kAzimuthsPerRad = static_cast<float>(kAzimuths / (2.0 * M_PI));
/// The same azimuth within [0, kAzimuths), of one that is at most a turn beyond.
constexpr int wrapped(int azimuth) {
  return azimuth < 0 ? azimuth + kAzimuths : azimuth >= kAzimuths ? azimuth - kAzimuths : azimuth;
}
}  // namespace polar

/// Keeps its buffers between sweeps. The evidence is added up in polar cells around the lidar (0.25 deg by
/// half a cell), as the logarithm of the odds, and each cell of the grid gathers those that it covers.
class BeamModel {
 public:
  explicit BeamModel(const BeamParams& params);
  /// Valid until the next call.
  const LidarEvidence& evaluate(const LidarLayers& lidar, const RoadPlane& road, const GridGeometry& geometry,
                                RowWorkers& workers);

 private:
  /// One layer by azimuth.
  struct Bins {
    std::vector<float> seen_to_m;      ///< up to here beams passed, 0: none was sent
    std::vector<float> start_m, rise;  ///< height above the road of the beam: start + rise * range
    std::vector<float> span_m;         ///< half of what the surface covers of the range within the azimuth
    std::vector<float> end_m, hit;     ///< range of an obstacle, 0: none; how surely it is one, 0..1
  };
  struct Ray {
    double bin = 0;  ///< azimuth
    double range = 0, rise = 0, sure = 0;
    double slope_up = 0, slope_down = 0;  ///< of the range per bin towards higher and lower azimuths
    bool returned = false;
  };
  [[nodiscard]] std::vector<Ray> raysOf(const LidarLayer& layer, const Pose& T_map_lidar,
                                        const RoadPlane& road) const;
  static void bridge(std::vector<Ray>& rays, double spacing_bins);
  void fillBins(const LidarLayer& layer, const Pose& T_map_lidar, const RoadPlane& road);
  [[nodiscard]] double rangeSigma() const;  ///< s of the equations, m
  [[nodiscard]] double hitReach() const;    ///< a of the equations, m
  void addPassed(int ranges, RowWorkers& workers);
  void addHits(int ranges);
  void gather(int row, const GridGeometry& geometry, const Eigen::Vector2d& lidar_map, int ranges);
  void noteTops(const LidarLayers& lidar, const RoadPlane& road, const GridGeometry& geometry);

  BeamParams params_;
  double step_m_ = 0;  ///< of the polar cells
  Bins bins_;
  std::vector<float> log_odds_;  ///< [range * azimuths + azimuth]
  LidarEvidence evidence_;
};

}  // namespace atlas
