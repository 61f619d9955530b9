// SPDX-License-Identifier: MIT
// How time passes and measurements enter; what comes out is in kalman_1d_odometry.cpp.
#include "atlas/localization/kalman_1d_filter.hpp"

#include <cmath>

#include "atlas/base/check.hpp"
#include "atlas/base/geometry.hpp"

namespace atlas {
namespace {

constexpr double kUnknownSpeed_mps = 30.0;  // standard deviation of a velocity nobody measured yet
constexpr double kKnownSpeed_mps = 1.0;     // the velocity counts as known below this standard deviation
constexpr double kCoarseNoise_sq = 1.0;     // (m/s^2)^2/Hz: a car's acceleration, before there is a heading
constexpr double kMaxFirstCourse_rad = 0.2618;  // 15 deg: a worse course does not start a heading
constexpr double kMaxFirstLever_rad = 0.05;     // change of that course between antenna and imu in a turn
constexpr int kHeadingPatience = 10;  // GNSS headings come in correlated runs: so many times more patience
constexpr double kAccelerationCorrelation_s = 1.0;  // how long braking or turning lasts

AttitudeParams attitudeParams(const PositioningParams& p) {
  return {p.tilt_time_constant_s, p.tilt_sigma_rad, p.gyroscope_noise_radps_sqrt_hz, p.gyroscope_bias_radps};
}

HeadingParams headingParams(const PositioningParams& p) {
  return {p.gnss_heading_slow_share,  p.gnss_heading_slow_time_s,           p.gyroscope_noise_radps_sqrt_hz,
          p.gyroscope_bias_radps,     p.gyroscope_bias_walk_radps2_sqrt_hz, p.imu_to_rear_axle_m,
          p.imu_to_rear_axle_sigma_m, p.velocity_heading_slip_rad,          p.heading_gate_mahalanobis_sq};
}

ImuSample interpolateAt(Stamp stamp, const ImuSample& a, const ImuSample& b) {
  const double ratio = static_cast<double>(stamp - a.stamp) / static_cast<double>(b.stamp - a.stamp);
  ImuSample sample;
  sample.stamp = stamp;
  sample.angular_velocity_radps = (1.0 - ratio) * a.angular_velocity_radps + ratio * b.angular_velocity_radps;
  sample.linear_acceleration_mps2 =
      (1.0 - ratio) * a.linear_acceleration_mps2 + ratio * b.linear_acceleration_mps2;
  return sample;
}

}  // namespace

Kalman1dFilter::Kalman1dFilter(const PositioningParams& params, const Eigen::Vector3d& lever_arm_imu,
                               const Geodetic& anchor, Counters& counters)
    : params_(params),
      lever_arm_imu_(lever_arm_imu),
      gravity_mps2_(normalGravity(anchor.latitude_deg, anchor.altitude_m)),
      counters_(counters),
      attitude_(attitudeParams(params)),
      heading_(headingParams(params)) {}

void Kalman1dFilter::update(Stamp stamp, const Eigen::Vector3d& p_map_antenna, const Eigen::Matrix3d& R_m2) {
  dropUnreachable(stamp);
  // Three independent filters: correlations between east, north and up are not used.
  pending_.push_back({stamp, Fix{p_map_antenna, R_m2.diagonal()}});
}

void Kalman1dFilter::updateHeading(Stamp stamp, double yaw_rad, double variance_rad2) {
  dropUnreachable(stamp);
  pending_.push_back({stamp, Heading{yaw_rad, variance_rad2}});
}

std::optional<Odometry> Kalman1dFilter::propagate(const ImuSample& sample) {
  if (current_ && sample.stamp <= current_->stamp) {
    counters_.skip("imu", Reason::kOutOfOrder);
    return std::nullopt;
  }
  const Duration period = current_ ? sample.stamp - current_->stamp : 0;
  const bool gap = toSeconds(period) > params_.max_imu_gap_s;
  if (gap) counters_.add("restarted: imu gap");
  if (!current_ || gap) restart(sample);
  usePending(sample);
  stepTo(sample);
  correctTilt(sample);
  usePending(sample);  // those at this very stamp
  if (!located_ || !velocity_known_ || !oriented()) return std::nullopt;
  return odometry(toSeconds(period));
}

void Kalman1dFilter::finish() { skipPendingBefore(kEndOfTime, "after the last imu sample"); }

void Kalman1dFilter::restart(const ImuSample& first) {
  skipPendingBefore(first.stamp, "no imu samples around it");
  attitude_ = AttitudeModel(attitudeParams(params_));
  heading_.forget();
  standing_.clear();
  located_ = velocity_known_ = false;
  outliers_in_a_row_ = heading_outliers_in_a_row_ = 0;
  current_ = first;
  last_sample_stamp_ = first.stamp;
  correctTilt(first);
}

void Kalman1dFilter::skipPendingBefore(Stamp stamp, const char* why) {
  while (!pending_.empty() && pending_.front().stamp < stamp) {
    const bool fix = std::holds_alternative<Fix>(pending_.front().measurement);
    counters_.add(std::string("skipped ") + (fix ? "fix" : "heading") + ": " + why);
    pending_.pop_front();
  }
}

void Kalman1dFilter::dropUnreachable(Stamp now) {
  // The next sample is not older than `now`: it will be the first one, or the one after a gap, and restarts.
  const bool next_restarts = !current_ || toSeconds(now - current_->stamp) > params_.max_imu_gap_s;
  if (next_restarts) skipPendingBefore(now, "no imu samples around it");
}

void Kalman1dFilter::usePending(const ImuSample& sample) {
  while (!pending_.empty() && pending_.front().stamp <= sample.stamp) {
    const Pending next = pending_.front();
    ATLAS_CHECK(next.stamp >= current_->stamp, "positioning: measurement older than the state");
    if (next.stamp == sample.stamp && current_->stamp != sample.stamp)
      return;  // after the step to the sample
    pending_.pop_front();
    if (next.stamp > current_->stamp) stepTo(interpolateAt(next.stamp, *current_, sample));
    std::visit([this](const auto& measurement) { use(measurement); }, next.measurement);
  }
}

void Kalman1dFilter::stepTo(const ImuSample& sample) {
  const double dt = toSeconds(sample.stamp - current_->stamp);
  Eigen::Vector3d first_mps2 = attitude_.R_map_imu() * current_->linear_acceleration_mps2;
  if (attitude_.known() && dt > 0.0) {
    attitude_.setBiasZ(heading_.biasZ());
    attitude_.integrate(current_->angular_velocity_radps, sample.angular_velocity_radps, dt);
  }
  if (heading_.known() && dt > 0.0) heading_.predict(dt);
  if (located_ && dt > 0.0) {
    const Eigen::Vector3d second_mps2 = attitude_.R_map_imu() * sample.linear_acceleration_mps2;
    const Eigen::Vector3d a = 0.5 * (first_mps2 + second_mps2) - gravity_mps2_ * upAt();
    const double yaw_noise = 2.0 * kAccelerationCorrelation_s * heading_.yawVariance();
    const double fine_sq =
        params_.accelerometer_noise_mps2_sqrt_hz * params_.accelerometer_noise_mps2_sqrt_hz;
    // A wrong yaw turns the acceleration sideways: a_x errs by a_y dyaw and the reverse.
    const Eigen::Vector3d q =
        Eigen::Vector3d::Constant(fine_sq) + yaw_noise * Eigen::Vector3d(a.y() * a.y(), a.x() * a.x(), 0.0);
    const Eigen::Vector3d bias = biasVariance();
    for (int i = 0; i < 3; ++i) {
      const Kalman1dAxis::Input coarse{0.0, kCoarseNoise_sq, 0.0, params_.accelerometer_bias_time_s};
      const Kalman1dAxis::Input fine{a(i), q(i), bias(i), params_.accelerometer_bias_time_s};
      axes_[static_cast<std::size_t>(i)].predict(dt, oriented() ? fine : coarse);
    }
  }
  current_ = sample;
}

void Kalman1dFilter::correctTilt(const ImuSample& sample) {
  // "Up" in the imu frame is all that is taken of the IMU's own orientation: its yaw does not enter.
  const double dt = toSeconds(sample.stamp - last_sample_stamp_);
  last_sample_stamp_ = sample.stamp;
  if (sample.orientation) {
    const Eigen::Vector3d up_imu = sample.orientation->conjugate() * Eigen::Vector3d::UnitZ();
    if (attitude_.known()) {
      attitude_.correctTilt(up_imu, upAt(), dt);
    } else {
      attitude_.initialize(up_imu);
    }
    return;
  }
  std::optional<double> speed;
  if (velocity_known_) speed = velocity().head<2>().norm();
  const auto up = standing_.add(sample, speed, gravity_mps2_);
  if (!up) return;
  if (attitude_.known()) {
    attitude_.correctTilt(up->direction_imu, upAt(), up->span_s);
  } else {
    attitude_.initialize(up->direction_imu);
  }
}

void Kalman1dFilter::use(const Heading& heading) {
  if (!attitude_.known()) {
    counters_.add("skipped heading: roll and pitch unknown");
    return;
  }
  if (!heading_.known()) {
    attitude_.setYaw(heading.yaw_rad);
    heading_.initializeFromGnss(heading.variance);
    counters_.add("heading initialized from gnss heading");
    beginWithHeading();
    return;
  }
  const Outcome<double> turn = heading_.correctByGnss(attitude_.yaw(), heading.yaw_rad, heading.variance);
  if (turn) {
    attitude_.turn(*turn);
    heading_outliers_in_a_row_ = 0;
    counters_.add("heading used");
    return;
  }
  counters_.add("skipped heading: outlier");
  if (++heading_outliers_in_a_row_ < kHeadingPatience * params_.max_consecutive_rejections) return;
  attitude_.setYaw(heading.yaw_rad);
  heading_.initializeFromGnss(heading.variance);
  heading_outliers_in_a_row_ = 0;
  counters_.add("heading re-initialized after outliers");
}

void Kalman1dFilter::use(const Fix& fix) {
  if (!located_) {
    locate(fix);
    counters_.add("fix used");
    return;
  }
  // Innovation of the antenna: z - (p + R l), written as (z - R l) - p for the axes, which hold the imu.
  Eigen::Vector3d measured = fix.p_map_antenna;
  Eigen::Vector3d variance = fix.variance_m2;
  if (oriented()) {
    measured -= attitude_.R_map_imu() * lever_arm_imu_;
    variance += leverVariance();
  }
  double mahalanobis_sq = 0.0;
  for (std::size_t i = 0; i < 3; ++i) mahalanobis_sq += axes_[i].mahalanobisSq(measured(i), variance(i));
  const bool outlier = mahalanobis_sq > params_.gate_mahalanobis_sq;
  if (on_innovation) {
    InnovationRecord record{current_->stamp, "fix", 3, {}, {}, mahalanobis_sq, !outlier};
    for (int i = 0; i < 3; ++i) {
      const Kalman1dAxis& axis = axes_[static_cast<std::size_t>(i)];
      record.innovation(i) = measured(i) - axis.position();
      record.sigma(i) = std::sqrt(axis.covariance()(0, 0) + variance(i));
    }
    on_innovation(record);
  }
  if (outlier) {
    counters_.add("skipped fix: outlier");
    if (++outliers_in_a_row_ < params_.max_consecutive_rejections) return;
    locate(fix);
    counters_.add("position re-initialized after outliers");
    return;
  }
  outliers_in_a_row_ = 0;
  bool known = true;
  for (std::size_t i = 0; i < 3; ++i) {
    axes_[i].correct(measured(i), variance(i));
    known = known && axes_[i].covariance()(1, 1) < kKnownSpeed_mps * kKnownSpeed_mps;
  }
  velocity_known_ = velocity_known_ || known;
  counters_.add("fix used");
  headingFromVelocity();
}

void Kalman1dFilter::locate(const Fix& fix) {
  Eigen::Vector3d p = fix.p_map_antenna;
  Eigen::Vector3d variance = fix.variance_m2;
  if (oriented()) {
    p -= attitude_.R_map_imu() * lever_arm_imu_;
    variance += leverVariance();
  }
  const Eigen::Vector3d v =
      located_ ? velocity() : Eigen::Vector3d::Zero();  // with a variance that says "unknown"
  const Eigen::Vector3d bias = oriented() ? biasVariance() : Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    axes_[i].initialize(p(i), variance(i), v(i), kUnknownSpeed_mps * kUnknownSpeed_mps, bias(i));
  }
  outliers_in_a_row_ = 0;
  located_ = true;
}

void Kalman1dFilter::headingFromVelocity() {
  const std::optional<VelocityHeading> velocity = velocityHeading();
  if (!velocity || !attitude_.known()) return;
  if (heading_.known()) {
    const Outcome<double> turn = heading_.correctByVelocity(attitude_.yaw(), *velocity);
    counters_.add(turn ? "velocity heading used" : "skipped velocity heading: outlier");
    if (turn) attitude_.turn(*turn);
    return;
  }
  const double lever_rad = velocity->yaw_rate_radps * lever_arm_imu_.norm() / velocity->speed_mps;
  if (std::abs(lever_rad) > kMaxFirstLever_rad) return;  // the axes still hold the antenna
  if (heading_.varianceOf(*velocity) > kMaxFirstCourse_rad * kMaxFirstCourse_rad) return;
  attitude_.setYaw(heading_.yawOf(*velocity));
  heading_.initializeFromVelocity(*velocity, params_.gnss_heading_sigma_rad * params_.gnss_heading_sigma_rad);
  counters_.add("heading initialized from velocity");
  beginWithHeading();
}

void Kalman1dFilter::beginWithHeading() {
  if (!located_) return;
  attitude_.setBiasZ(heading_.biasZ());
  const Eigen::Vector3d rate = current_->angular_velocity_radps - attitude_.bias_radps();
  const Eigen::Vector3d p = -(attitude_.R_map_imu() * lever_arm_imu_);
  const Eigen::Vector3d v = -(attitude_.R_map_imu() * rate.cross(lever_arm_imu_));
  const Eigen::Vector3d variance = leverVariance(), bias = biasVariance();
  for (std::size_t i = 0; i < 3; ++i) axes_[i].shift(p(i), variance(i), v(i), bias(i));
}

}  // namespace atlas
