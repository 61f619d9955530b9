// SPDX-License-Identifier: MIT
#include "atlas/fusion/point_measurement.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {
namespace {

constexpr double kFront_m = 0.5;     ///< the front that lidar points through a box give, against a flat one
constexpr double kBoxCentre = 0.25;  ///< of the width: boxes are cut by borders and by what is before them
constexpr double kLeastAcross_m = 0.2;
constexpr double kHeightGap_m = 1.0;  ///< between the middle of a detection and that of a track
constexpr double kWider = 0.4;        ///< log of how much wider than a track a detection of it may be
constexpr double kTallerFree_m = 0.4, kTaller_m = 0.4;  ///< a track rises above a detection of it
constexpr double kRadarRange_m = 0.35;
constexpr double kRadarAcross_m = 0.5;
constexpr double kRadarVelocity_mps = 0.3;
constexpr double kRadarHeightGap_m = 2.0;  ///< elevation is hardly measured
constexpr double kMovesFor_mps = 1.5;      ///< a radar target alone is something only when it moves
constexpr double kFastest_mps = 8.0;

/// Near surface along the direction and middle across it.
Rows surfaceRows(const TrackShape& track, const Eigen::Vector2d& direction, const Eigen::Vector2d& point,
                 double along_sigma, double across_sigma) {
  LinearRow along, across;
  along.h.head<2>() = direction;
  addNearSurface(track, direction, along.h);
  along.z = direction.dot(point);
  along.variance = along_sigma * along_sigma;
  across.h.head<2>() << -direction.y(), direction.x();
  across.z = across.h.head<2>().dot(point);
  across.variance = across_sigma * across_sigma;
  Rows rows;
  rows.add(along);
  rows.add(across);
  return rows;
}

double widthAcross(const TrackShape& track, const Eigen::Vector2d& direction) {
  const double c = std::abs(direction.dot(track.along())), s = std::abs(direction.dot(track.across()));
  return track.length() * s + track.width() * c;
}

TrackBirth birthAt(const Eigen::Vector2d& middle, const Eigen::Vector3d& size,
                   const Eigen::Vector3d& size_sigma, const Eigen::Vector2d& direction, double z) {
  TrackBirth birth;
  TrackShape& shape = birth.shape;
  shape.state.mean << middle.x(), middle.y(), 0.0, 0.0, 0.0, size.x(), size.y();
  const double v = kFastest_mps * kFastest_mps, p = 1.0;
  shape.state.covariance =
      (TrackVector() << p, p, v, v, 0.09, size_sigma.x() * size_sigma.x(), size_sigma.y() * size_sigma.y())
          .finished()
          .asDiagonal();
  shape.yaw_rad = std::atan2(direction.y(), direction.x());
  shape.yaw_variance_rad2 = 1.0;
  shape.middle_z_m = {z, 0.5};
  shape.height_m = {size.z(), size_sigma.z() * size_sigma.z()};
  return birth;
}

}  // namespace

FrustumMeasurement::FrustumMeasurement(const Frustum& frustum) : frustum_(frustum) {
  coco_class = frustum.detection.class_id;
  confidence = frustum.detection.confidence;
  index = frustum.detection_index;
  const auto& corners = frustum.corners;  // near TL, TR, BR, BL, then far: rays of the four from one centre
  width_m_ = (corners[1] - corners[0]).norm();
  top_m_ = 0.5 * (corners[0].z() + corners[1].z());
  const Eigen::Vector3d near = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  const Eigen::Vector3d far = 0.25 * (corners[4] + corners[5] + corners[6] + corners[7]);
  const Eigen::Vector2d ahead = (far - near).head<2>();
  if (ahead.norm() > 0.0) direction_ = ahead.normalized();
}

std::optional<Reason> FrustumMeasurement::defect() const {
  const bool finite = frustum_.position.allFinite() && direction_.allFinite() &&
                      std::isfinite(width_m_ + top_m_) && std::isfinite(frustum_.depth_sigma_m) &&
                      std::isfinite(confidence);
  return finite ? std::nullopt : std::make_optional(Reason::kNotFinite);
}

std::array<double, 8> FrustumMeasurement::key() const {
  const Detection2d& box = frustum_.detection;
  const Eigen::Vector3d& p = frustum_.position;
  return {p.x(), p.y(), p.z(), static_cast<double>(coco_class), box.x_min, box.y_min, box.x_max, box.y_max};
}

Rows FrustumMeasurement::rows(const TrackShape& track, double depth_sigma_m, double across_sigma_m) const {
  return surfaceRows(track, direction_, frustum_.position.head<2>(), depth_sigma_m, across_sigma_m);
}
Rows FrustumMeasurement::anchor(const TrackShape& track) const {
  return rows(track, std::hypot(frustum_.depth_sigma_m, kFront_m), kLeastAcross_m + kBoxCentre * width_m_);
}

double FrustumMeasurement::mismatch(const TrackShape& track) const {
  const double dz =
      (frustum_.position.z() - track.middle_z_m.value) / (kHeightGap_m + 0.3 * track.height_m.value);
  // a box narrower than what it should show is cut; a wider one shows something else
  const double known_m = widthAcross(track, direction_) + std::sqrt(track.state.covariance(kLength, kLength));
  const double wide = std::max(0.0, std::log(width_m_ / std::max(known_m, 0.3)) / kWider);
  const bool cut = frustum_.detection.y_min < 1.0;  // by the image's upper border
  const double top = track.middle_z_m.value + 0.5 * track.height_m.value;
  const double tall = cut ? 0.0 : std::max(0.0, top - top_m_ - kTallerFree_m) / kTaller_m;
  return 0.5 * (dz * dz + wide * wide + tall * tall);
}

Measured FrustumMeasurement::measured(const TrackShape& track) const {
  Measured result;
  result.rows = anchor(track);
  return result;
}

std::optional<TrackBirth> FrustumMeasurement::birth() const {
  const ClassPhysics physics = physicsOf(coco_class);
  const double half = 0.5 * std::min(physics.size.x(), 2.0 * physics.size.y());
  TrackBirth birth = birthAt(frustum_.position.head<2>() + half * direction_, physics.size,
                             physics.size_sigma, direction_, frustum_.position.z());
  birth.existence = 0.25 * confidence;
  return birth;
}

RadarMeasurement::RadarMeasurement(const Eigen::Vector3d& target_map, const Eigen::Vector3d& radar_map,
                                   std::optional<double> velocity_mps)
    : target_(target_map),
      velocity_mps_(velocity_mps),
      direction_((target_map - radar_map).head<2>().normalized()) {
  existence_ratio = 1.5;  // a radar sees poles and manholes as well
}

std::optional<Reason> RadarMeasurement::defect() const {
  const bool finite =
      target_.allFinite() && direction_.allFinite() && (!velocity_mps_ || std::isfinite(*velocity_mps_));
  return finite ? std::nullopt : std::make_optional(Reason::kNotFinite);
}

std::array<double, 8> RadarMeasurement::key() const {
  return {target_.x(), target_.y(), target_.z(), velocity_mps_.value_or(0.0), 0.0, 0.0, 0.0, 0.0};
}

Rows RadarMeasurement::rows(const TrackShape& track, double across_sigma_m) const {
  Rows rows = surfaceRows(track, direction_, target_.head<2>(), kRadarRange_m, across_sigma_m);
  if (!velocity_mps_) return rows;
  LinearRow speed;
  speed.h.segment<2>(kVx) = direction_;
  speed.z = *velocity_mps_;
  speed.variance = kRadarVelocity_mps * kRadarVelocity_mps;
  rows.add(speed);
  return rows;
}
Rows RadarMeasurement::anchor(const TrackShape& track) const {
  return rows(track, kRadarAcross_m + 0.25 * widthAcross(track, direction_));
}

double RadarMeasurement::mismatch(const TrackShape& track) const {
  const double dz = (target_.z() - track.middle_z_m.value) / (kRadarHeightGap_m + 0.5 * track.height_m.value);
  return 0.5 * dz * dz;
}

Measured RadarMeasurement::measured(const TrackShape& track) const {
  Measured result;
  result.rows = anchor(track);
  return result;
}

std::optional<TrackBirth> RadarMeasurement::birth() const {
  if (!velocity_mps_ || std::abs(*velocity_mps_) < kMovesFor_mps) return std::nullopt;
  const ClassPhysics physics = physicsOf(-1);
  TrackBirth birth = birthAt(target_.head<2>() + 0.5 * direction_, physics.size, physics.size_sigma,
                             direction_, target_.z());
  birth.shape.state.mean.segment<2>(kVx) = *velocity_mps_ * direction_;
  birth.existence = 0.05;
  return birth;
}

}  // namespace atlas
