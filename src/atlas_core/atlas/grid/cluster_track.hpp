// SPDX-License-Identifier: MIT
// One object of the occupancy grid over time: a Kalman filter with constant velocity for (x, y, vx, vy) of
// the middle of its box (Welch and Bishop, "An Introduction to the Kalman Filter"), and the box. Which part
// of an object is seen changes; its side towards the sensor is what is measured, and the middle lies half of
// the known size behind it.
#pragma once

#include <deque>
#include <functional>
#include <optional>

#include "atlas/base/time.hpp"
#include "atlas/grid/cell_clusters.hpp"
#include "atlas/sensor/object.hpp"

namespace atlas {

class ClusterTrack {
 public:
  ClusterTrack(std::uint32_t id, Stamp stamp, const Cluster& cells, const Eigen::Vector2d& seen_from_map,
               double cell_m);

  void predict(Stamp stamp, double acceleration_mps2);
  /// Cells of this object at the time predicted to; `seen_free` tells of a place whether it is seen to be
  /// empty.
  void update(const Cluster& cells, const Eigen::Vector2d& seen_from_map, double cell_m,
              const std::function<bool(const Eigen::Vector2d&)>& seen_free);
  /// No cells; `detectability`: how surely its place is seen, 0 = hidden.
  void miss(double detectability);
  /// The other is the same thing: states weighted by their information, boxes together.
  void absorb(const ClusterTrack& other);

  [[nodiscard]] std::uint32_t id() const { return id_; }
  [[nodiscard]] const Eigen::Vector4d& state() const { return state_; }
  [[nodiscard]] const Eigen::Matrix4d& covariance() const { return covariance_; }
  [[nodiscard]] Eigen::Vector2d velocity() const { return state_.tail<2>(); }
  [[nodiscard]] GroundBox box() const;
  /// The box with three standard deviations of the position and `margin_m` more.
  [[nodiscard]] GroundBox region(double margin_m) const;
  /// That it was last seen with.
  [[nodiscard]] std::size_t cells() const { return cells_; }
  [[nodiscard]] bool confirmed() const { return confirmed_; }
  void confirm(int hits, int of);
  [[nodiscard]] double unseenFor_s() const { return toSeconds(stamp_ - last_seen_); }
  [[nodiscard]] double detectability() const { return detectability_; }
  [[nodiscard]] bool isStatic(double static_speed_mps) const;
  [[nodiscard]] Object report(double road_m, double static_speed_mps) const;

 private:
  void turnBox(const Cluster& cells, const Eigen::Vector2d& seen_from_map, double cell_m);
  [[nodiscard]] bool headingKnown() const;

  std::uint32_t id_ = 0;
  Stamp stamp_ = 0, first_seen_ = 0, last_seen_ = 0;
  Eigen::Vector4d state_ = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance_ = Eigen::Matrix4d::Identity();
  double yaw_rad_ = 0, length_ = 0, width_ = 0;
  bool by_heading_ = false;         ///< the box lies along the velocity
  std::optional<double> height_m_;  ///< above the road
  double static_share_ = 0.5;
  std::size_t cells_ = 0;
  double detectability_ = 1.0;
  std::deque<bool> recent_;  ///< observed or not, newest last
  bool confirmed_ = false;
};

/// Distance between two boxes along the line of their middles: 0 when they overlap there.
[[nodiscard]] double gapBetween(const GroundBox& a, const GroundBox& b);
[[nodiscard]] bool contains(const GroundBox& box, const Eigen::Vector2d& point);

}  // namespace atlas
