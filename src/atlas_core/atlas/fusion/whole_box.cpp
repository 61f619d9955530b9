// SPDX-License-Identifier: MIT
#include <cmath>

#include "atlas/base/geometry.hpp"
#include "atlas/fusion/box_measurement.hpp"

namespace atlas {
namespace {

constexpr double kFastest_mps = 10.0;  ///< standard deviation of the velocity of what was never seen before

LinearRow row(int index, double z, double sigma) {
  LinearRow result;
  result.h(index) = 1.0;
  result.z = z;
  result.variance = sigma * sigma;
  return result;
}

}  // namespace

std::optional<Reason> WholeBox::defect() const {
  if (!box_.center.allFinite() || !box_.size.allFinite() || !std::isfinite(box_.yaw_rad))
    return Reason::kNotFinite;
  if (!(box_.size.minCoeff() > 0.0)) return Reason::kBadLayout;
  return std::nullopt;
}

std::array<double, 8> WholeBox::key() const {
  return {box_.center.x(), box_.center.y(), box_.center.z(), box_.yaw_rad,
          box_.size.x(),   box_.size.y(),   box_.size.z(),   confidence};
}

Rows WholeBox::anchor(const TrackShape&) const {
  Rows rows;
  rows.add(row(kPx, box_.center.x(), noise_.position_m));
  rows.add(row(kPy, box_.center.y(), noise_.position_m));
  return rows;
}

double WholeBox::mismatch(const TrackShape& track) const {
  const double dz = box_.center.z() - track.middle_z_m.value;
  const double dl = (box_.size.x() - track.length()) / (2.0 * noise_.size_m + 0.1 * track.length());
  const double dw = (box_.size.y() - track.width()) / (2.0 * noise_.size_m + 0.1 * track.width());
  return 0.5 * (dz * dz / (0.25 + track.middle_z_m.variance) + dl * dl + dw * dw);
}

Measured WholeBox::measured(const TrackShape&) const {
  Measured result;
  result.rows = anchor({});
  result.rows.add(row(kLength, box_.size.x(), noise_.size_m));
  result.rows.add(row(kWidth, box_.size.y(), 0.5 * noise_.size_m));
  result.yaw = YawReading{box_.yaw_rad, noise_.yaw_rad * noise_.yaw_rad, 1};
  result.middle_z_m = Reading{box_.center.z(), 0.25 * noise_.position_m * noise_.position_m};
  result.height_m = Reading{box_.size.z(), 0.25 * noise_.size_m * noise_.size_m};
  return result;
}

std::optional<TrackBirth> WholeBox::birth() const {
  TrackBirth birth;
  TrackShape& shape = birth.shape;
  shape.state.mean << box_.center.x(), box_.center.y(), 0.0, 0.0, 0.0, box_.size.x(), box_.size.y();
  const double p = noise_.position_m * noise_.position_m, l = noise_.size_m * noise_.size_m;
  const double v = kFastest_mps * kFastest_mps;
  shape.state.covariance = (TrackVector() << p, p, v, v, 0.09, l, 0.25 * l).finished().asDiagonal();
  shape.yaw_rad = wrapAngle(box_.yaw_rad);
  shape.yaw_variance_rad2 = noise_.yaw_rad * noise_.yaw_rad;
  shape.middle_z_m = {box_.center.z(), p};
  shape.height_m = {box_.size.z(), l};
  birth.heading_known = true;
  return birth;
}

}  // namespace atlas
