// SPDX-License-Identifier: MIT
// The paper's positioning (section IV-A): three 1D Kalman filters in east, north, up, an attitude model, and
// a heading filter, put together. State is that of the IMU, not of the antenna: the lever arm is rotated into
// every innovation.
//
// Time: fixes and headings wait for the first IMU sample at or after them, and the filter steps exactly to
// their stamps with the IMU's samples interpolated linearly. Nothing is ever used at a wrong time, and the
// odometry at a sample's stamp contains every fix up to it.
//
// Before heading is known, the axes follow the antenna as a nearly constant velocity without the
// accelerometer; that is enough to take the first heading from the velocity when the receiver gives none.
#pragma once

#include <array>
#include <deque>
#include <variant>

#include "atlas/localization/attitude_model.hpp"
#include "atlas/localization/heading_filter.hpp"
#include "atlas/localization/kalman_1d_axis.hpp"
#include "atlas/localization/positioning_filter.hpp"
#include "atlas/localization/standing_gravity.hpp"

namespace atlas {

class Kalman1dFilter : public PositioningFilter {
 public:
  Kalman1dFilter(const PositioningParams& params, const Eigen::Vector3d& lever_arm_imu,
                 const Geodetic& anchor, Counters& counters);

  void update(Stamp stamp, const Eigen::Vector3d& p_map_antenna, const Eigen::Matrix3d& R_m2) override;
  void updateHeading(Stamp stamp, double yaw_rad, double variance_rad2) override;
  std::optional<Odometry> propagate(const ImuSample& sample) override;
  void finish() override;

 private:
  struct Fix {
    Eigen::Vector3d p_map_antenna;
    Eigen::Vector3d variance_m2;  ///< east, north, up
  };
  struct Heading {
    double yaw_rad;
    double variance;
  };
  struct Pending {
    Stamp stamp;
    std::variant<Fix, Heading> measurement;
  };

  void restart(const ImuSample& first);
  void skipPendingBefore(Stamp stamp, const char* why);
  /// Keeps an IMU that has stopped from piling up fixes: those that no sample can surround any more go.
  void dropUnreachable(Stamp now);
  void usePending(const ImuSample& sample);
  void stepTo(const ImuSample& sample);
  void correctTilt(const ImuSample& sample);

  void use(const Fix& fix);
  void use(const Heading& heading);
  void locate(const Fix& fix);  ///< first fix, or the one after too many outliers
  void headingFromVelocity();
  void beginWithHeading();  ///< from the antenna's to the imu's position and velocity

  [[nodiscard]] bool oriented() const { return attitude_.known() && heading_.known(); }
  [[nodiscard]] Eigen::Vector3d velocity() const;
  [[nodiscard]] Eigen::Vector3d upAt() const;
  [[nodiscard]] Eigen::Matrix3d attitudeCovariance() const;  ///< about map's axes
  [[nodiscard]] Eigen::Vector3d leverVariance() const;
  [[nodiscard]] Eigen::Vector3d biasVariance() const;  ///< of the slow acceleration error
  [[nodiscard]] std::optional<VelocityHeading> velocityHeading() const;
  [[nodiscard]] Odometry odometry(double dt_s) const;

  PositioningParams params_;
  Eigen::Vector3d lever_arm_imu_;  ///< antenna in the imu frame, m
  double gravity_mps2_;
  Counters& counters_;

  std::deque<Pending> pending_;
  std::optional<ImuSample> current_;  ///< the sample (or interpolated one) that the state belongs to
  Stamp last_sample_stamp_ = 0;       ///< of the last real sample
  std::array<Kalman1dAxis, 3> axes_;  ///< east, north, up
  bool located_ = false;              ///< axes_ hold something
  bool velocity_known_ = false;
  int outliers_in_a_row_ = 0;
  int heading_outliers_in_a_row_ = 0;
  AttitudeModel attitude_;
  HeadingFilter heading_;
  StandingGravity standing_;
};

}  // namespace atlas
