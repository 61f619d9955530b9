// SPDX-License-Identifier: MIT
// Measurements of a direction and a distance to the near surface: camera frustums and radar targets.
#pragma once

#include "atlas/fusion/class_belief.hpp"
#include "atlas/fusion/measurement.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

/// A detection with a distance: direction of the box's centre, distance of the front, class.
class FrustumMeasurement : public Measurement {
 public:
  explicit FrustumMeasurement(const Frustum& frustum);
  [[nodiscard]] std::optional<Reason> defect() const override;
  [[nodiscard]] Eigen::Vector3d place() const override { return frustum_.position; }
  [[nodiscard]] std::array<double, 8> key() const override;
  [[nodiscard]] Rows anchor(const TrackShape& track) const override;
  [[nodiscard]] double mismatch(const TrackShape& track) const override;
  [[nodiscard]] Measured measured(const TrackShape& track) const override;
  [[nodiscard]] std::optional<TrackBirth> birth() const override;

 private:
  [[nodiscard]] Rows rows(const TrackShape& track, double depth_sigma_m, double across_sigma_m) const;
  Frustum frustum_;
  Eigen::Vector2d direction_ = Eigen::Vector2d::UnitX();  ///< from the camera, in the plane
  double width_m_ = 0.0, top_m_ = 0.0;                    ///< of the box at the near plane; top in map
};

/// A radar target; the velocity is that of the target in map along the line of sight, away from the radar.
class RadarMeasurement : public Measurement {
 public:
  RadarMeasurement(const Eigen::Vector3d& target_map, const Eigen::Vector3d& radar_map,
                   std::optional<double> velocity_mps);
  [[nodiscard]] std::optional<Reason> defect() const override;
  [[nodiscard]] Eigen::Vector3d place() const override { return target_; }
  [[nodiscard]] std::array<double, 8> key() const override;
  [[nodiscard]] Rows anchor(const TrackShape& track) const override;
  [[nodiscard]] double mismatch(const TrackShape& track) const override;
  [[nodiscard]] Measured measured(const TrackShape& track) const override;
  [[nodiscard]] std::optional<TrackBirth> birth() const override;

 private:
  [[nodiscard]] Rows rows(const TrackShape& track, double across_sigma_m) const;
  Eigen::Vector3d target_;
  std::optional<double> velocity_mps_;
  Eigen::Vector2d direction_;
};

}  // namespace atlas
