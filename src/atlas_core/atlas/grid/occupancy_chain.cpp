// SPDX-License-Identifier: MIT
#include "atlas/grid/occupancy_chain.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace atlas {
namespace {

constexpr double kRoadTime_s =
    5.0;  ///< the road's slope is the vehicle's tilt over this time: braking is none

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("occupancy: " + what + ", got " + std::to_string(value));
}

bool isSound(const SensorGrid& grid) {
  return grid.columns > 0 && grid.rows > 0 && grid.cell_m > 0.0 &&
         grid.occupied.size() == static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
}

/// A sensor's grid read at the cells of the map, linear between its cells; 0.5 beyond it.
std::vector<float> laidInto(const GridGeometry& geometry, const PlacedGrid& placed) {
  const SensorGrid& grid = *placed.grid;
  std::vector<float> occupied(geometry.cells(), 0.5F);
  const double yaw = toRollPitchYaw(placed.T_map_grid.rotation).yaw, c = std::cos(yaw), s = std::sin(yaw);
  const Eigen::Vector2d origin = placed.T_map_grid.translation.head<2>();
  const auto at = [&](int column, int row) {
    const bool inside = column >= 0 && row >= 0 && column < grid.columns && row < grid.rows;
    const float p = inside ? grid.occupied[static_cast<std::size_t>(row) * grid.columns + column] : 0.5F;
    return p >= 0.0F && p <= 1.0F ? static_cast<double>(p) : 0.5;
  };
  for (int row = 0; row < geometry.rows; ++row) {
    for (int column = 0; column < geometry.columns; ++column) {
      const Eigen::Vector2d d = geometry.middleOf(column, row) - origin;
      const double x = (c * d.x() + s * d.y() - grid.origin_x_m) / grid.cell_m - 0.5;
      const double y = (c * d.y() - s * d.x() - grid.origin_y_m) / grid.cell_m - 0.5;
      if (!(x > -1.0 && y > -1.0 && x < grid.columns && y < grid.rows)) continue;
      const int left = static_cast<int>(std::floor(x)), low = static_cast<int>(std::floor(y));
      const double u = x - left, v = y - low;
      const double p = (1.0 - v) * ((1.0 - u) * at(left, low) + u * at(left + 1, low)) +
                       v * ((1.0 - u) * at(left, low + 1) + u * at(left + 1, low + 1));
      occupied[geometry.indexOf(column, row)] = static_cast<float>(p);
    }
  }
  return occupied;
}

}  // namespace

void validate(const OccupancyParams& p) {
  if (p.lidars.empty() && p.stereo.empty())
    throw std::invalid_argument("occupancy: lidars or stereo must name at least one sensor");
  need(p.group_s >= 0.0 && p.group_s <= 1.0, "group_s must lie in [0, 1]", p.group_s);
  need(p.max_gap_s > 0.0, "max_gap_s must be positive", p.max_gap_s);
  need(p.max_odometry_age_s > 0.0, "max_odometry_age_s must be positive", p.max_odometry_age_s);
  need(std::abs(p.road_below_imu_m) <= 10.0, "road_below_imu_m must lie in [-10, 10]", p.road_below_imu_m);
  need(p.threads >= 1 && p.threads <= 64, "threads must lie in [1, 64]", p.threads);
  validate(p.grid);
  validate(p.layers);
  validate(p.beams);
  validate(p.filter);
  validate(p.tracking);
  validate(p.risk);
}

OccupancyChain::OccupancyChain(const OccupancyParams& params)
    : params_((validate(params), params)),
      workers_(params.threads),
      beams_(params.beams),
      pooled_(params.pooling),
      filter_(makeFilter(params.filter)),
      tracker_(params.tracking) {}

void OccupancyChain::reset() {
  last_.reset();
  road_slope_.reset();
  filter_->reset();
  tracker_.reset();
}

RoadPlane OccupancyChain::roadUnder(const Pose& T_map_imu, double dt_s) {
  const Eigen::Vector3d up = T_map_imu.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector2d tilt = -up.head<2>() / up.z();
  if (!road_slope_) road_slope_ = tilt;
  *road_slope_ += dt_s / (dt_s + kRoadTime_s) * (tilt - *road_slope_);
  const Eigen::Vector3d below = T_map_imu.translation - params_.road_below_imu_m * up;
  return {below.z() - road_slope_->dot(below.head<2>()), *road_slope_};
}

/// P(occupied | all sensors) of each cell, and the highest return in it.
void OccupancyChain::look(const OccupancyInput& input, const RoadPlane& road, OccupancyFrame& frame,
                          Counters& counters) {
  pooled_.reset(frame.geometry.cells());
  top_m_.assign(frame.geometry.cells(), std::numeric_limits<float>::quiet_NaN());
  for (const LidarLayers& lidar : input.lidars) {
    if (lidar.layers.empty()) {
      counters.skip("grid lidar", Reason::kEmpty);
      continue;
    }
    const LidarEvidence& evidence = beams_.evaluate(lidar, road, frame.geometry, workers_);
    pooled_.add(evidence.occupied);
    for (std::size_t i = 0; i < top_m_.size(); ++i) {
      if (!(evidence.top_m[i] <= top_m_[i]) && evidence.top_m[i] == evidence.top_m[i])
        top_m_[i] = evidence.top_m[i];
    }
    ++frame.lidars_used;
  }
  for (const PlacedGrid& placed : input.grids) {
    if (!placed.grid || !isSound(*placed.grid)) {
      counters.skip("grid of stereo", Reason::kBadLayout);
      continue;
    }
    pooled_.add(laidInto(frame.geometry, placed));
    ++frame.grids_used;
  }
}

OccupancyFramePtr OccupancyChain::update(const OccupancyInput& input, Counters& counters) {
  auto frame = std::make_shared<OccupancyFrame>();
  frame->stamp = frame->objects.stamp = input.stamp;
  if (!input.T_map_imu.translation.allFinite() || !input.T_map_imu.rotation.coeffs().allFinite()) {
    counters.skip("grid update", Reason::kNotFinite);
    return frame;
  }
  if (last_ && input.stamp < *last_) {
    counters.skip("grid update", Reason::kOutOfOrder);
    return frame;
  }
  if (last_ && toSeconds(input.stamp - *last_) > params_.max_gap_s) {
    counters.add("grid begun anew after a gap");
    reset();
  }
  const double dt_s = last_ ? toSeconds(input.stamp - *last_) : 0.0;
  last_ = input.stamp;

  const double yaw = toRollPitchYaw(input.T_map_imu.rotation).yaw;
  const Eigen::Vector2d vehicle = input.T_map_imu.translation.head<2>();
  frame->geometry = placeGrid(params_.grid, vehicle, yaw);
  const RoadPlane road = roadUnder(input.T_map_imu, dt_s);
  frame->road_m = road.heightAt(vehicle.x(), vehicle.y());
  look(input, road, *frame, counters);
  const std::vector<float>& evidence = pooled_.result();
  filter_->update(frame->geometry, evidence, dt_s, workers_);
  Eigen::Vector2d seen_from = vehicle;
  if (!input.lidars.empty()) seen_from = input.lidars.front().T_map_lidar.translation.head<2>();
  tracker_.update(
      {input.stamp, frame->geometry, filter_->cells(), evidence, top_m_, seen_from, frame->road_m}, counters);
  frame->objects = tracker_.report();
  frame->objects.T_map_imu = input.T_map_imu;
  frame->cells = std::make_shared<CellEstimates>(filter_->cells());
  if (input.motion) {
    const EgoMotion ego{vehicle, yaw, input.motion->velocity_imu_mps.x(),
                        input.motion->angular_velocity_imu_radps.z()};
    frame->risk = collisionRisk(ego, frame->objects, frame->geometry, filter_->cells(),
                                tracker_.clusterOfCell(), params_.risk);
  } else {
    counters.skip("collision risk", Reason::kNoPoseYet);
  }
  counters.add("grid updates");
  counters.add("grid objects", frame->objects.objects.size());
  return frame;
}

}  // namespace atlas
