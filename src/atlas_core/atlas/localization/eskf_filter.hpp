// SPDX-License-Identifier: MIT
// The error-state Kalman filter as a positioning filter: state and equations in eskf_state.hpp,
// eskf_motion.hpp and eskf_measurement.hpp. This file says when what is used and what is believed.
//
// Time: fixes and headings wait for the first IMU sample at or after them, and the filter steps exactly to
// their stamps with the IMU's samples interpolated linearly. The odometry at a sample's stamp contains
// everything up to it.
//
// Belief: every measurement passes a chi-square gate. A source that is rejected for `recovery_s` is right and
// the filter is not: its uncertainty is raised so far that the next fix is taken, and this is counted; if
// that does not help, the filter starts anew. In a gap of the IMU the motion is unknown, so the uncertainty
// grows as a vehicle may accelerate and turn.
#pragma once

#include <optional>

#include "atlas/localization/eskf_history.hpp"
#include "atlas/localization/eskf_measurement.hpp"
#include "atlas/localization/eskf_start.hpp"
#include "atlas/localization/imu_monitor.hpp"
#include "atlas/localization/measurement_queue.hpp"
#include "atlas/localization/positioning_filter.hpp"
#include "atlas/localization/tally.hpp"

namespace atlas {

class EskfFilter : public PositioningFilter {
 public:
  EskfFilter(const PositioningParams& params, const Eigen::Vector3d& lever_arm_imu, const Geodetic& anchor,
             Counters& counters);

  void update(Stamp stamp, const Eigen::Vector3d& p_map_antenna, const Eigen::Matrix3d& R_m2) override;
  void updateHeading(Stamp stamp, double yaw_rad, double variance_rad2) override;
  void updateHeight(Stamp stamp, double z_map_m, double variance_m2) override;
  std::optional<Odometry> propagate(const ImuSample& sample) override;
  void distrust(double velocity_variance, double turn_variance) override;
  void finish() override;
  [[nodiscard]] std::optional<ImuBias> imuBias() const override;
  bool record(eskf::History* history) override;

 private:
  using Entry = MeasurementQueue::Entry;

  void enqueue(const Entry& entry);
  void skipPendingBefore(Stamp stamp, Tally EskfFilter::*fix_tally, Tally EskfFilter::*heading_tally);
  void restart(const ImuSample& first);
  void usePending(const ImuSample& sample);
  void stepTo(const ImuSample& sample, double gap_s);
  void use(Stamp stamp, const MeasurementQueue::Fix& fix);
  void use(Stamp stamp, const MeasurementQueue::Heading& heading);
  void use(Stamp stamp, const MeasurementQueue::Height& height);
  void skip(const Entry& entry, Tally EskfFilter::*fix_tally, Tally EskfFilter::*heading_tally);
  void tryStart();
  void begin(const eskf::Start::Result& result);
  void checkYaw(const MeasurementQueue::Fix& fix);
  void learnFixScale(Stamp stamp);
  void recoverPosition(Stamp stamp, const Eigen::Vector3d& innovation_m);

  // eskf_constraints.cpp: what standing, the wheels and the IMU's own orientation say, once a block
  void constrain(const ImuMonitor::Block& block, const ImuSample& sample);
  [[nodiscard]] bool looksStill(const ImuMonitor::Block& block) const;
  void useStanding(const ImuMonitor::Block& block);
  void useWheels();
  void useUp(const Eigen::Quaterniond& R_enu_imu);

  /// Gates, corrects, records, reports; true when it was used.
  template <int M>
  bool apply(const char* source, const eskf::Measurement<M>& z, double gate_mahalanobis_sq);
  [[nodiscard]] Eigen::Vector3d rate() const;  ///< of the present sample, bias taken out
  [[nodiscard]] Odometry odometry(double dt_s) const;

  PositioningParams params_;
  Eigen::Vector3d lever_arm_imu_;
  eskf::Earth earth_;
  eskf::Start start_;
  ImuMonitor monitor_;
  MeasurementQueue pending_;
  eskf::History* history_ = nullptr;

  std::optional<ImuSample> current_;  ///< the sample (or interpolated one) that the state belongs to
  bool running_ = false;
  bool yaw_checked_ = false;  ///< against the accelerometers; until then start_ goes on
  eskf::State state_;
  eskf::Matrix P_ = eskf::Matrix::Zero();
  double period_s_ = 0.0;  ///< usual time between two samples
  double last_mahalanobis_sq_ = 0.0;

  Stamp last_fix_ = kBeginOfTime, last_used_fix_ = 0, last_used_heading_ = 0, rejecting_since_ = 0;
  int rejected_ = 0, recoveries_ = 0;  ///< in a row
  Stamp last_scaled_fix_ = 0;
  double fix_misfit_ = 1.0, fix_scale_ = 1.0;  ///< how much worse than they say the fixes are (variance)
  double mean_misfit_ = 1.0;                   ///< of the last fixes
  Eigen::Matrix3d slow_fix_m2_ = Eigen::Matrix3d::Zero();  ///< covariance of their slow error
  int still_blocks_ = 0;
  double still_force_spread_ = 0.0, still_gyro_spread_ = 0.0;  ///< seen while surely standing
  std::optional<ImuMonitor::Block> block_before_;
  double wheels_scale_ = 1.0;  ///< how much more than assumed the axle slips
  Stamp next_up_ = 0;

  Counters& counters_;
  Tally imu_late_{"skipped imu: stamp not after the one before"}, gaps_{"bridged: imu gap"},
      restarts_{"restarted: imu gap"};
  Tally fix_used_{"fix used"}, fix_outlier_{"skipped fix: outlier"},
      fix_duplicate_{"skipped fix: same stamp"}, fix_alone_{"skipped fix: no imu samples around it"},
      fix_after_{"skipped fix: after the last imu sample"};
  Tally heading_used_{"heading used"}, heading_outlier_{"skipped heading: outlier"},
      heading_alone_{"skipped heading: no imu samples around it"},
      heading_after_{"skipped heading: after the last imu sample"};
  Tally height_used_{"pressure used"}, height_outlier_{"skipped pressure: outlier"},
      height_alone_{"skipped pressure: no imu samples around it"};
  Tally started_gnss_{"heading initialized from gnss heading"},
      started_velocity_{"heading initialized from velocity"},
      turned_{"heading set anew: the accelerations come from another side"},
      mounted_{"imu does not look forward, or the car began in reverse"};
  Tally recovered_{"position re-initialized after outliers"},
      heading_recovered_{"heading re-initialized after outliers"},
      started_anew_{"restarted: position rejected again and again"};
  Tally wheels_used_{"velocity heading used"}, wheels_outlier_{"skipped velocity heading: outlier"},
      standing_used_{"standing used"}, standing_outlier_{"skipped standing: outlier"},
      up_used_{"imu orientation used"}, up_outlier_{"skipped imu orientation: outlier"};
};

template <int M>
bool EskfFilter::apply(const char* source, const eskf::Measurement<M>& z, double gate_mahalanobis_sq) {
  const eskf::Innovation<M> innovation = eskf::innovation<M>(P_, z);
  last_mahalanobis_sq_ = innovation.mahalanobis_sq;
  const bool used = innovation.mahalanobis_sq <= gate_mahalanobis_sq;
  if (on_innovation) {
    InnovationRecord record{current_->stamp, source, M, {}, {}, innovation.mahalanobis_sq, used};
    record.innovation.setZero();
    record.sigma.setZero();
    record.innovation.head<M>() = z.y;
    record.sigma.head<M>() = innovation.S.diagonal().cwiseSqrt();
    on_innovation(record);
  }
  if (!used) return false;
  const eskf::Vector error = eskf::correct<M>(P_, z, innovation);
  eskf::inject(state_, error);
  if (history_ != nullptr) history_->corrected<M>(current_->stamp, z, innovation, error, P_);
  return true;
}

}  // namespace atlas
