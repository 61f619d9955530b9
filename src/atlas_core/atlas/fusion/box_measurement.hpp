// SPDX-License-Identifier: MIT
// Boxes. A detector that knows whole objects gives whole boxes; the box of a lidar cluster holds what was
// seen, so only its near sides are where the object's are, and its far ends are not nearer than they seem.
#pragma once

#include "atlas/fusion/measurement.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

/// A box of a whole object.
class WholeBox : public Measurement {
 public:
  struct Noise {
    double position_m = 0.25, size_m = 0.3, yaw_rad = 0.15;
  };
  /// `box.yaw_rad` is forward, now and then by half a turn off.
  WholeBox(const Obstacle& box, const Noise& noise) : box_(box), noise_(noise) {}
  [[nodiscard]] std::optional<Reason> defect() const override;
  [[nodiscard]] Eigen::Vector3d place() const override { return box_.center; }
  [[nodiscard]] std::array<double, 8> key() const override;
  [[nodiscard]] Rows anchor(const TrackShape& track) const override;
  [[nodiscard]] double mismatch(const TrackShape& track) const override;
  [[nodiscard]] Measured measured(const TrackShape& track) const override;
  [[nodiscard]] std::optional<TrackBirth> birth() const override;

 private:
  Obstacle box_;
  Noise noise_;
};

/// The box of a lidar cluster.
class SeenBox : public Measurement {
 public:
  /// Towards the left and right of the box, seen from the sensor, something nearer hides what follows.
  struct Hidden {
    bool left = false, right = false;
  };
  SeenBox(const Obstacle& box, const Eigen::Vector3d& seen_from, const Hidden& hidden)
      : box_(box), seen_from_(seen_from), hidden_(hidden) {}
  [[nodiscard]] std::optional<Reason> defect() const override;
  [[nodiscard]] Eigen::Vector3d place() const override { return box_.center; }
  [[nodiscard]] std::array<double, 8> key() const override;
  [[nodiscard]] Rows anchor(const TrackShape& track) const override;
  [[nodiscard]] double mismatch(const TrackShape& track) const override;
  [[nodiscard]] Measured measured(const TrackShape& track) const override;
  [[nodiscard]] std::optional<TrackBirth> birth() const override;

 private:
  /// The box in the track's axes.
  struct Fitted {
    double length = 0, width = 0;  ///< along and across the track
    double yaw_rad = 0;            ///< of the length axis, up to half a turn
    bool has_yaw = false;          ///< large enough for its yaw to mean something
  };
  [[nodiscard]] Fitted fitted(const TrackShape& track) const;
  void addSides(const TrackShape& track, const Fitted& box, bool lengthwise, Rows& rows) const;

  Obstacle box_;
  Eigen::Vector3d seen_from_;
  Hidden hidden_;
};

}  // namespace atlas
