// SPDX-License-Identifier: MIT
#include "atlas/localization/localization_stage.hpp"

#include <cmath>
#include <stdexcept>

#include "atlas/localization/eskf_history.hpp"

namespace atlas {
namespace {
constexpr double kMaxNormError = 1e-2;  // quaternions recorded with six digits, with room
}  // namespace

void validate(const LocalizationParams& params) {
  Counters counters;
  makePositioningFilter(params.filter, params.positioning, Eigen::Vector3d::Zero(), {}, counters);
}

LocalizationStage::LocalizationStage(const LocalizationParams& params)
    : Stage("localization", {"tf_static", "gnss/fix", "gnss/heading", "imu"}), params_(params) {
  validate(params_);
}

LocalizationStage::~LocalizationStage() = default;

void LocalizationStage::push(Stamp stamp, const StaticTransforms& transforms) {
  enqueue(kTfStatic, stamp, [this, transforms] { rig_.add(transforms); });
}
void LocalizationStage::push(const GnssFix& fix) {
  enqueue(kGnssFix, fix.stamp, [this, fix] { use(fix); });
}
void LocalizationStage::push(const GnssHeading& heading) {
  enqueue(kGnssHeading, heading.stamp, [this, heading] { use(heading); });
}
void LocalizationStage::push(const ImuSample& sample) {
  enqueue(kImu, sample.stamp, [this, sample] { use(sample); });
}

Outcome<Eigen::Vector3d> LocalizationStage::leverArm(const GnssFix& fix) const {
  const std::string& frame = params_.gnss_antenna_frame.empty() ? fix.frame : params_.gnss_antenna_frame;
  if (frame.empty()) return Eigen::Vector3d(Eigen::Vector3d::Zero());  // nobody says that it is elsewhere
  const Outcome<Pose> T_imu_antenna = rig_.T_imu(frame);
  if (!T_imu_antenna) return T_imu_antenna.reason();
  return T_imu_antenna->translation;
}

Eigen::Matrix3d LocalizationStage::covarianceOf(const GnssFix& fix) {
  const double horizontal = std::pow(params_.positioning.gnss_horizontal_sigma_m, 2);
  const double vertical = std::pow(params_.positioning.gnss_vertical_sigma_m, 2);
  const Eigen::Matrix3d assumed = Eigen::Vector3d(horizontal, horizontal, vertical).asDiagonal();
  if (!fix.covariance_enu_m2) return assumed;
  const Eigen::Matrix3d given =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(fix.covariance_enu_m2->data());
  if (given.allFinite() && given.diagonal().minCoeff() > 0.0) return given;
  counters_.add("fix covariance unusable, parameter taken");
  return assumed;
}

void LocalizationStage::use(const GnssFix& fix) {
  counters_.add("fix");
  const Geodetic& g = fix.position;
  if (!std::isfinite(g.latitude_deg) || !std::isfinite(g.longitude_deg) || !std::isfinite(g.altitude_m)) {
    counters_.skip("fix", Reason::kNotFinite);
    return;
  }
  if (std::abs(g.latitude_deg) > 90.0 || std::abs(g.longitude_deg) > 360.0) {
    counters_.skip("fix", Reason::kBadLayout);
    return;
  }
  if (!map_) {
    map_.emplace(g);
    if (on_anchor) on_anchor({fix.stamp, g});
  }
  if (params_.smoothed) return;
  if (!filter_) {
    const Outcome<Eigen::Vector3d> lever_arm_imu = leverArm(fix);
    if (!lever_arm_imu) {
      counters_.skip("fix", lever_arm_imu.reason());
      return;
    }
    filter_ =
        makePositioningFilter(params_.filter, params_.positioning, *lever_arm_imu, map_->anchor(), counters_);
    if (history_ != nullptr) filter_->record(history_);
    if (on_innovation) filter_->on_innovation = on_innovation;
    if (last_imu_) filter_->propagate(*last_imu_);
  }
  filter_->update(fix.stamp, map_->toMap(g), covarianceOf(fix));
}

void LocalizationStage::use(const GnssHeading& heading) {
  counters_.add("heading");
  if (params_.smoothed) return;
  if (!std::isfinite(heading.yaw_rad)) {
    counters_.skip("heading", Reason::kNotFinite);
    return;
  }
  double variance = std::pow(params_.positioning.gnss_heading_sigma_rad, 2);
  if (heading.variance_rad2) {
    if (std::isfinite(*heading.variance_rad2) && *heading.variance_rad2 > 0.0) {
      variance = *heading.variance_rad2;
    } else {
      counters_.add("heading variance unusable, parameter taken");
    }
  }
  if (!filter_) {
    counters_.add("skipped heading: before the first usable fix");
    return;
  }
  // A yaw that has travelled as a quaternion differs in its last bits from one that has not: both round to
  // the same.
  constexpr double kYawGrid_rad = 1e-9;
  filter_->updateHeading(heading.stamp, std::round(heading.yaw_rad / kYawGrid_rad) * kYawGrid_rad, variance);
}

void LocalizationStage::use(const ImuSample& sample) {
  counters_.add("imu");
  if (params_.smoothed) {
    answerSmoothed(sample.stamp);
    return;
  }
  if (!sample.angular_velocity_radps.allFinite() || !sample.linear_acceleration_mps2.allFinite()) {
    counters_.skip("imu", Reason::kNotFinite);
    return;
  }
  ImuSample clean = sample;
  if (clean.orientation) {
    const double norm = clean.orientation->norm();
    if (std::isfinite(norm) && std::abs(norm - 1.0) < kMaxNormError) {
      clean.orientation->normalize();
    } else {
      counters_.skip("imu orientation", Reason::kNotNormalized);
      clean.orientation.reset();
    }
  }
  if (!filter_) {
    last_imu_ = clean;
    counters_.skip("odometry", Reason::kNoPoseYet);
    return;
  }
  const std::optional<Odometry> odometry = filter_->propagate(clean);
  if (!odometry) {
    counters_.skip("odometry", Reason::kNoPoseYet);
    return;
  }
  emit(*odometry);
}

void LocalizationStage::emit(const Odometry& odometry) {
  counters_.add("odometry");
  if (on_odometry) on_odometry(odometry);
}

void LocalizationStage::answerSmoothed(Stamp stamp) {
  const eskf::History& run = *params_.smoothed;
  while (smoothed_next_ < run.size() && run.stamp(smoothed_next_) < stamp) ++smoothed_next_;
  if (smoothed_next_ == run.size() || run.stamp(smoothed_next_) != stamp) {
    counters_.skip("odometry", Reason::kNoPoseYet);
    return;
  }
  emit(run.odometry(smoothed_next_++));
}

void LocalizationStage::record(eskf::History* history) {
  Counters counters;
  if (!makePositioningFilter(params_.filter, params_.positioning, Eigen::Vector3d::Zero(), {}, counters)
           ->record(history))
    throw std::invalid_argument("localization: filter " + params_.filter + " has no smoother");
  history_ = history;
}

std::optional<ImuBias> LocalizationStage::imuBias() const {
  return filter_ ? filter_->imuBias() : std::nullopt;
}

void LocalizationStage::onEnd() {
  if (filter_) filter_->finish();
  for (std::size_t input = 0; input < inputs(); ++input) {
    const std::uint64_t late = merge().late(input);
    if (late > 0) counters_.add("skipped " + inputName(input) + ": late", late);
  }
}

}  // namespace atlas
