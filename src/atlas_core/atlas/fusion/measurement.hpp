// SPDX-License-Identifier: MIT
// What a sensor tells of an object, seen by the tracker through this interface alone: another sensor is one
// more class derived from it. Everything is in map.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "atlas/base/outcome.hpp"
#include "atlas/fusion/track_filter.hpp"

namespace atlas {

/// One number with its uncertainty.
struct Reading {
  double value = 0.0, variance = 1.0;
};
/// The track as a measurement model needs it.
struct TrackShape {
  TrackState state;
  double yaw_rad = 0.0, yaw_variance_rad2 = 1.0;
  bool steers = true;  ///< has a length axis that can be told from the width
  Reading middle_z_m, height_m;

  [[nodiscard]] Eigen::Vector2d along() const { return {std::cos(yaw_rad), std::sin(yaw_rad)}; }
  [[nodiscard]] Eigen::Vector2d across() const { return {-std::sin(yaw_rad), std::cos(yaw_rad)}; }
  [[nodiscard]] Eigen::Vector2d position() const { return state.mean.head<2>(); }
  [[nodiscard]] double length() const { return state.mean(kLength); }
  [[nodiscard]] double width() const { return state.mean(kWidth); }
};
/// Yaw up to 1/period_parts of a turn: 1 = forward is known, 2 = an axis.
struct YawReading {
  double yaw_rad = 0.0, variance_rad2 = 1.0;
  int period_parts = 2;
};
/// What a measurement says of a track that it belongs to.
struct Measured {
  Rows rows;
  std::optional<YawReading> yaw;
  double axis_log_odds = 0.0;  ///< that the track's length is its longer side, and not its width
  std::optional<Reading> middle_z_m, height_m;
};
/// How a track begins.
struct TrackBirth {
  TrackShape shape;
  bool heading_known = false;
  double existence = 0.3;
};

class Measurement {
 public:
  virtual ~Measurement() = default;
  /// Why it cannot be used: not finite, no size.
  [[nodiscard]] virtual std::optional<Reason> defect() const = 0;
  /// Where it is looked for, m.
  [[nodiscard]] virtual Eigen::Vector3d place() const = 0;
  /// A total order of the measurements of a scan, whatever order they came in.
  [[nodiscard]] virtual std::array<double, 8> key() const = 0;
  /// Two rows whose distance decides whether it belongs to the track.
  [[nodiscard]] virtual Rows anchor(const TrackShape& track) const = 0;
  /// Further reasons against it, in halves of a squared sigma.
  [[nodiscard]] virtual double mismatch(const TrackShape& track) const = 0;
  [[nodiscard]] virtual Measured measured(const TrackShape& track) const = 0;
  /// Nothing when an object is not believed to be there because of this alone.
  [[nodiscard]] virtual std::optional<TrackBirth> birth() const = 0;

  std::uint32_t index = 0;       ///< in its message
  std::int32_t coco_class = -1;  ///< -1: says nothing about the class
  double confidence = 1.0;       ///< of the class
  double existence_ratio = 4.0;  ///< likelihood of it with an object there, to that without
  std::optional<double> score;   ///< as its detector gave it
};
using MeasurementPtr = std::unique_ptr<const Measurement>;

/// Distance from the middle of the track's box to its surface on the line along `direction` (unit) as a row
/// part: `h` gets -1/2 of the side that is hit, as the surface towards the sensor is meant.
void addNearSurface(const TrackShape& track, const Eigen::Vector2d& direction, TrackVector& h);

}  // namespace atlas
