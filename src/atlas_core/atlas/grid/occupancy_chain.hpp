// SPDX-License-Identifier: MIT
// The second paper's system from the sensors' layers to the risk: lidar layers and stereo grid -> one opinion
// of each cell -> Bayesian Occupancy Filter -> objects -> collision risk. Frame: map.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/counters.hpp"
#include "atlas/grid/beam_model.hpp"
#include "atlas/grid/collision_risk.hpp"
#include "atlas/grid/fast_clustering.hpp"
#include "atlas/grid/occupancy_filter.hpp"
#include "atlas/grid/pooling.hpp"
#include "atlas/sensor/sensor_grid.hpp"

namespace atlas {

struct OccupancyParams {
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};
  std::vector<std::string> stereo;  ///< stereo pairs whose grids are taken in, by the name of their topics
  double group_s = 0.02;            ///< measurements so close in time are one update of the filter
  double max_gap_s = 1.0;           ///< longer without any measurement: the grid begins anew
  double max_odometry_age_s = 0.1;  ///< of the vehicle's motion, for the risk
  double road_below_imu_m = 0.9;    ///< height of base_link above the road
  double unknown_above = 0.5;  ///< a cell whose belief rests on no measurement by more is told as unknown
  int threads = 1;             ///< results do not depend on it
  GridParams grid;
  LayerParams layers;
  BeamParams beams;
  Pooling pooling = Pooling::kProduct;
  FilterParams filter;
  ClusterTrackParams tracking;
  RiskParams risk;
};
void validate(const OccupancyParams& params);

/// A stereo grid and where it lies.
struct PlacedGrid {
  SensorGridPtr grid;
  Pose T_map_grid;
};

/// Measurements of one time; any of them may be missing.
struct OccupancyInput {
  Stamp stamp = 0;
  Pose T_map_imu;
  std::optional<Odometry> motion;  ///< none: no risk can be told
  std::vector<LidarLayers> lidars;
  std::vector<PlacedGrid> grids;
};

/// What the chain answers. Without a pose of the vehicle there are no cells.
struct OccupancyFrame {
  Stamp stamp = 0;
  GridGeometry geometry;
  double road_m = 0;                           ///< z of the road in map under the vehicle
  std::shared_ptr<const CellEstimates> cells;  ///< null: nothing is known
  Objects objects;
  std::optional<CollisionRisk> risk;  ///< none: the vehicle's motion is not known
  std::uint32_t lidars_used = 0, grids_used = 0;
};
using OccupancyFramePtr = std::shared_ptr<const OccupancyFrame>;

class OccupancyChain {
 public:
  explicit OccupancyChain(const OccupancyParams& params);

  /// Stamps must not fall; one that does is counted and answered without cells. With no measurement at all
  /// the belief is only predicted.
  [[nodiscard]] OccupancyFramePtr update(const OccupancyInput& input, Counters& counters);
  /// Forgets everything; ids go on.
  void reset();

 private:
  [[nodiscard]] RoadPlane roadUnder(const Pose& T_map_imu, double dt_s);
  void look(const OccupancyInput& input, const RoadPlane& road, OccupancyFrame& frame, Counters& counters);

  OccupancyParams params_;
  RowWorkers workers_;
  BeamModel beams_;
  PooledGrid pooled_;
  std::unique_ptr<OccupancyFilter> filter_;
  ClusterTracker tracker_;
  std::optional<Stamp> last_;
  std::optional<Eigen::Vector2d> road_slope_;
  std::vector<float> top_m_;
};

}  // namespace atlas
