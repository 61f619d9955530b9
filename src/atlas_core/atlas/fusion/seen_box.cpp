// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "atlas/base/geometry.hpp"
#include "atlas/fusion/box_measurement.hpp"

namespace atlas {
namespace {

constexpr double kSide_m = 0.1;       ///< of a side that faces the sensor: range noise, uneven surface ...
constexpr double kSidePer_m = 0.003;  ///< ... and a share of the range, for the beams' distance
constexpr double kEnd_m = 0.2;        ///< of an end of a side: the last beam that hits it
constexpr double kEndPer_m = 0.006;   ///< gap between beams on a surface seen head-on
constexpr double kBound_m = 0.3;      ///< of an end that is only known not to be nearer
constexpr double kFacing_m = 0.1;     ///< the sensor is so far outside of a side that it sees it
constexpr double kThin_m = 0.35, kLine_m = 1.2,
                 kLineEnd_m = 0.6;   ///< a line is a piece of a wall: it ends anywhere
constexpr double kLateral = 0.5;     ///< sine of the angle to the sight from which an end lies left or right
constexpr double kLeastSine = 0.15;  ///< a side seen flatter than this shows no far end
constexpr double kHasYaw_m = 1.2;    ///< outlines of smaller things have no direction
constexpr double kLongAxis_m = 2.4;  ///< a longer side is the length of a vehicle
constexpr double kElongated = 1.5;   ///< times as long as wide: the long side is the length, ...
constexpr double kAxis = 0.5;        ///< ... log odds of one box, as boxes repeat their errors
constexpr double kYaw_rad = 0.06;
constexpr double kFastest_mps = 8.0;
constexpr double kAnchor_m = 0.25;  ///< clusters differ from sweep to sweep
constexpr double kGap_m = 0.3;      ///< in height, between a track and a cluster that belongs to it

LinearRow along(const Eigen::Vector2d& axis, double z, int side, double half, double sigma) {
  LinearRow row;
  row.h.head<2>() = axis;
  if (half != 0.0) row.h(side) = half;
  row.z = z;
  row.variance = sigma * sigma;
  return row;
}

}  // namespace

std::optional<Reason> SeenBox::defect() const {
  if (!box_.center.allFinite() || !box_.size.allFinite() || !std::isfinite(box_.yaw_rad))
    return Reason::kNotFinite;
  if (box_.size.minCoeff() < 0.0) return Reason::kBadLayout;
  return std::nullopt;
}

std::array<double, 8> SeenBox::key() const {
  return {box_.center.x(), box_.center.y(), box_.center.z(), box_.yaw_rad,
          box_.size.x(),   box_.size.y(),   box_.size.z(),   static_cast<double>(box_.points)};
}

SeenBox::Fitted SeenBox::fitted(const TrackShape& track) const {
  const double turn = box_.yaw_rad - track.yaw_rad, c = std::abs(std::cos(turn)),
               s = std::abs(std::sin(turn));
  const double l = box_.size.x(), w = box_.size.y();
  if (!track.steers || std::max(l, w) < kHasYaw_m)
    return {l * c + w * s, l * s + w * c, track.yaw_rad, false};
  if (c >= s) return {l, w, box_.yaw_rad, true};
  return {w, l, box_.yaw_rad + 0.5 * M_PI, true};
}

void SeenBox::addSides(const TrackShape& track, const Fitted& box, bool lengthwise, Rows& rows) const {
  const Eigen::Vector2d center = box_.center.head<2>(), to_sensor = seen_from_.head<2>() - center;
  const Eigen::Vector2d axis = lengthwise ? track.along() : track.across();
  const Eigen::Vector2d other = lengthwise ? track.across() : track.along();
  const double half = 0.5 * (lengthwise ? box.length : box.width);
  const double other_half = 0.5 * (lengthwise ? box.width : box.length);
  const int side = lengthwise ? kLength : kWidth;
  const double ahead = axis.dot(to_sensor), beside = std::abs(other.dot(to_sensor)) - other_half;
  const double range = to_sensor.norm();
  const double sine =
      std::max(beside, 0.0) / std::max(range, 1e-6);  // of the angle at which the other side is seen
  const double end_sigma = kEnd_m + kEndPer_m * range / std::max(sine, kLeastSine);
  const bool line = 2.0 * other_half < kThin_m && 2.0 * half > kLine_m;
  for (const double sign : {1.0, -1.0}) {
    const double z = axis.dot(center) + sign * half;
    const Eigen::Vector2d sight = -to_sensor, end = sign * axis;  // left of the sight: counter-clockwise
    const double turn = (sight.x() * end.y() - sight.y() * end.x()) / std::max(range, 1e-6);
    const bool hidden = std::abs(turn) > kLateral && (turn > 0.0 ? hidden_.left : hidden_.right);
    if (sign * ahead > half + kFacing_m && !hidden) {
      rows.add(along(axis, z, side, 0.5 * sign, kSide_m + kSidePer_m * range));
      continue;
    }
    const bool shown = sine > kLeastSine && !hidden;
    const double expected =
        axis.dot(track.position()) + sign * 0.5 * (lengthwise ? track.length() : track.width());
    if (shown) {
      rows.add(along(axis, z, side, 0.5 * sign, line ? kLineEnd_m + end_sigma : end_sigma));
    } else if (sign * (z - expected) > 0.0) {
      rows.add(along(axis, z, side, 0.5 * sign, kBound_m));
    }
  }
}

Rows SeenBox::anchor(const TrackShape& track) const {
  const Fitted box = fitted(track);
  const Eigen::Vector2d center = box_.center.head<2>(), to_sensor = seen_from_.head<2>() - center;
  Rows rows;
  for (const bool lengthwise : {true, false}) {
    const Eigen::Vector2d axis = lengthwise ? track.along() : track.across();
    const double half = 0.5 * (lengthwise ? box.length : box.width), ahead = axis.dot(to_sensor);
    const double sign = std::abs(ahead) <= half + kFacing_m ? 0.0 : ahead > 0.0 ? 1.0 : -1.0;
    rows.add(
        along(axis, axis.dot(center) + sign * half, lengthwise ? kLength : kWidth, 0.5 * sign, kAnchor_m));
  }
  return rows;
}

double SeenBox::mismatch(const TrackShape& track) const {
  const Fitted box = fitted(track);
  const auto excess = [&](double seen, double known, int side) {
    const double sigma = std::sqrt(track.state.covariance(side, side)) + 0.3 + 0.1 * known;
    return std::max(0.0, seen - known) / sigma;
  };
  const double gap_m =
      std::abs(box_.center.z() - track.middle_z_m.value) - 0.5 * (box_.size.z() + track.height_m.value);
  const double l = excess(box.length, track.length(), kLength), w = excess(box.width, track.width(), kWidth);
  const double g = std::max(0.0, gap_m) / kGap_m;
  return 0.5 * (l * l + w * w + g * g);
}

Measured SeenBox::measured(const TrackShape& track) const {
  const Fitted box = fitted(track);
  Measured result;
  addSides(track, box, true, result.rows);
  addSides(track, box, false, result.rows);
  if (box.has_yaw) {
    const double longer = std::max(box.length, box.width);
    const double sigma = kYaw_rad * std::max(1.0, kLongAxis_m / longer);
    result.yaw = YawReading{box.yaw_rad, sigma * sigma, 2};
    const bool tells = longer > kLongAxis_m && longer > kElongated * std::min(box.length, box.width);
    if (tells) result.axis_log_odds = box.length > box.width ? kAxis : -kAxis;
  }
  // the top is seen when nothing hides it, the bottom ends above the ground
  const double top = box_.center.z() + 0.5 * box_.size.z();
  const double known_top = track.middle_z_m.value + 0.5 * track.height_m.value;
  const double sigma = top >= known_top ? 0.1 : 0.5;
  result.middle_z_m = Reading{box_.center.z(), 0.04 + sigma * sigma};
  result.height_m = Reading{box_.size.z(), sigma * sigma};
  return result;
}

std::optional<TrackBirth> SeenBox::birth() const {
  TrackBirth birth;
  TrackShape& shape = birth.shape;
  const double l = box_.size.x(), w = box_.size.y();
  shape.yaw_rad = box_.yaw_rad;
  const bool is_long = l > kLongAxis_m;
  shape.yaw_variance_rad2 = is_long ? kYaw_rad * kYaw_rad : 0.3;
  shape.state.mean << box_.center.x(), box_.center.y(), 0.0, 0.0, 0.0, std::max(l, 0.1), std::max(w, 0.1);
  const double v = kFastest_mps * kFastest_mps;
  shape.state.covariance = (TrackVector() << 2.25, 2.25, v, v, 0.09, 6.25, 1.5).finished().asDiagonal();
  shape.middle_z_m = {box_.center.z(), 0.1};
  shape.height_m = {box_.size.z(), 0.2};
  const Measured first = measured(shape);
  for (std::size_t i = 0; i < first.rows.size(); ++i) {  // the box is where it is: only certainty is gained
    const LinearRow& row = first.rows[i];
    const TrackVector Ph = shape.state.covariance * row.h;
    shape.state.covariance -= Ph * Ph.transpose() / (row.h.dot(Ph) + row.variance);
  }
  return birth;
}

}  // namespace atlas
