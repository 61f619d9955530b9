// SPDX-License-Identifier: MIT
// How fixes of the two receivers (and air pressure) reach the filter: checked, in map, with the covariance
// and lever arm of their own receiver.
#include <cmath>
#include <string_view>

#include "atlas/localization/localization_stage.hpp"

namespace atlas {
namespace {
constexpr double kUnknownAltitude_m = 1000.0;  // standard deviation where a receiver gives none
}  // namespace

Outcome<Eigen::Vector3d> LocalizationStage::leverArm(const GnssFix& fix, const std::string& given) const {
  const std::string& frame = given.empty() ? fix.frame : given;
  if (frame.empty()) return Eigen::Vector3d(Eigen::Vector3d::Zero());  // nobody says that it is elsewhere
  const Outcome<Pose> T_imu_antenna = rig_.T_imu(frame);
  if (!T_imu_antenna) return T_imu_antenna.reason();
  return T_imu_antenna->translation;
}

Eigen::Matrix3d LocalizationStage::covarianceOf(const GnssFix& fix, double horizontal_m, double vertical_m) {
  const Eigen::Vector3d sigma(horizontal_m, horizontal_m, vertical_m);
  const Eigen::Matrix3d assumed = sigma.cwiseAbs2().asDiagonal();
  if (!fix.covariance_enu_m2) return assumed;
  const Eigen::Matrix3d given =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(fix.covariance_enu_m2->data());
  if (given.allFinite() && given.diagonal().minCoeff() > 0.0) return given;
  counters_.add("fix covariance unusable, parameter taken");
  return assumed;
}

bool LocalizationStage::isPosition(const GnssFix& fix, const char* what) {
  const Geodetic& g = fix.position;
  if (!std::isfinite(g.latitude_deg) || !std::isfinite(g.longitude_deg) || !std::isfinite(g.altitude_m)) {
    counters_.skip(what, Reason::kNotFinite);
    return false;
  }
  if (std::abs(g.latitude_deg) > 90.0 || std::abs(g.longitude_deg) > 360.0) {
    counters_.skip(what, Reason::kBadLayout);
    return false;
  }
  if (g.latitude_deg == 0.0 && g.longitude_deg == 0.0) {  // what receivers without a position say
    counters_.add(std::string("skipped ") + what + ": latitude and longitude exactly 0");
    return false;
  }
  return true;
}

void LocalizationStage::anchorAt(const GnssFix& fix) {
  if (map_) return;
  map_.emplace(fix.position);
  if (on_anchor) on_anchor({fix.stamp, fix.position});
}

void LocalizationStage::startFilter(const Eigen::Vector3d& lever_arm_imu) {
  if (filter_) return;
  filter_ =
      makePositioningFilter(params_.filter, params_.positioning, lever_arm_imu, map_->anchor(), counters_);
  filter_lever_ = lever_arm_imu;
  if (history_ != nullptr) filter_->record(history_);
  filter_->on_innovation = [this](const InnovationRecord& record) { onInnovation(record); };
  if (last_imu_) filter_->propagate(*last_imu_);
}

void LocalizationStage::giveToFilter(const Receivers::Fix& fix, Receivers::Use receiver) {
  Eigen::Vector3d p = fix.p_map_antenna;
  Eigen::Matrix3d R = fix.R_m2;
  const Eigen::Vector3d lever = filter_lever_ - fix.lever_arm_imu;  // to the antenna that the filter expects
  if (lever != Eigen::Vector3d::Zero()) {
    if (receivers_.prediction()) {
      p += receivers_.prediction()->T_map_imu.rotation * lever;
    } else {
      R += lever.squaredNorm() * Eigen::Matrix3d::Identity();
    }
  }
  if (receiver == Receivers::Use::kSecondary) second_in_filter_ = fix.stamp;
  filter_->update(fix.stamp, p, R);
  if (keeper_.positioned()) return;  // its innovation tells what the filter thinks of it
  receivers_.taken(fix.stamp, receiver);
  keeper_.fixTaken(fix.stamp, receiver);
}

void LocalizationStage::onInnovation(const InnovationRecord& record) {
  InnovationRecord named = record;
  if (std::string_view(record.source) == "fix") {
    const bool second = record.stamp == second_in_filter_;
    const auto receiver = second ? Receivers::Use::kSecondary : Receivers::Use::kPrimary;
    if (second) named.source = "second fix";
    if (record.used) {
      receivers_.taken(record.stamp, receiver);
      keeper_.fixTaken(record.stamp, receiver);
    }
  }
  keeper_.innovation(named, named.source);
  if (on_innovation) on_innovation(named);
}

void LocalizationStage::use(const GnssFix& fix) {
  counters_.add("fix");
  if (!isPosition(fix, "fix") || !trusts("gnss", "fix")) return;
  receivers_.begin(fix.stamp);
  anchorAt(fix);
  if (params_.smoothed) {
    receivers_.taken(fix.stamp, Receivers::Use::kPrimary);
    return;
  }
  const Outcome<Eigen::Vector3d> lever_arm_imu = leverArm(fix, params_.gnss_antenna_frame);
  if (!lever_arm_imu) {
    counters_.skip("fix", lever_arm_imu.reason());
    return;
  }
  startFilter(*lever_arm_imu);
  const PositioningParams& p = params_.positioning;
  const Receivers::Fix in_map{fix.stamp, map_->toMap(fix.position), *lever_arm_imu,
                              covarianceOf(fix, p.gnss_horizontal_sigma_m, p.gnss_vertical_sigma_m)};
  if (receivers_.jumped(in_map)) {
    counters_.add("skipped fix: jumped away from the second receiver and the prediction");
    return;
  }
  giveToFilter(in_map, Receivers::Use::kPrimary);
}

void LocalizationStage::usePressure(const ScalarSample& pressure) {
  if (params_.smoothed) return;
  std::optional<double> z;
  if (!receivers_.starting(pressure.stamp)) z = receivers_.prediction()->T_map_imu.translation.z();
  const auto height = barometer_.add(pressure, z, keeper_.fixed(pressure.stamp));
  if (height && filter_) filter_->updateHeight(pressure.stamp, height->z_map_m, height->variance_m2);
}

void LocalizationStage::useSecond(const GnssFix& fix) {
  counters_.add("second fix");
  if (!isPosition(fix, "second fix") || !trusts("imu_gnss", "second fix")) return;
  receivers_.begin(fix.stamp);
  const Geodetic& g = fix.position;
  const bool repeated = second_before_ && g.latitude_deg == second_before_->latitude_deg &&
                        g.longitude_deg == second_before_->longitude_deg;
  if (repeated) {  // the receiver is slower than its stream
    counters_.add("skipped second fix: the same position as before");
    return;
  }
  second_before_ = g;
  if (!map_ && !receivers_.firstIsSilent(fix.stamp)) {
    counters_.add("skipped second fix: before the first fix");
    return;
  }
  const ReceiverParams& r = params_.receivers;
  const Outcome<Eigen::Vector3d> lever_arm_imu = leverArm(fix, r.second_gnss_antenna_frame);
  if (!lever_arm_imu) {
    counters_.skip("second fix", lever_arm_imu.reason());
    return;
  }
  const bool no_altitude = g.altitude_m == 0.0 && !fix.covariance_enu_m2;
  if (!map_)
    counters_.add(no_altitude ? "anchor by the second receiver, altitude unknown"
                              : "anchor by the second receiver");
  anchorAt(fix);
  if (params_.smoothed) return;
  Receivers::Fix in_map{fix.stamp, map_->toMap(g), *lever_arm_imu,
                        covarianceOf(fix, r.second_gnss_horizontal_sigma_m, r.second_gnss_vertical_sigma_m)};
  if (no_altitude) {
    const auto& prediction = receivers_.prediction();
    const double z = prediction ? prediction->T_map_imu.translation.z() : 0.0;
    Geodetic level = g;
    level.altitude_m = map_->toGeodetic({in_map.p_map_antenna.x(), in_map.p_map_antenna.y(), z}).altitude_m;
    in_map.p_map_antenna = map_->toMap(level);
    // A filter that starts is near the place it takes the height from.
    if (!receivers_.starting(fix.stamp)) in_map.R_m2(2, 2) = kUnknownAltitude_m * kUnknownAltitude_m;
  }
  const auto needed = receivers_.second(in_map);
  if (!needed) return;
  startFilter(*lever_arm_imu);
  giveToFilter(*needed, Receivers::Use::kSecondary);
}

}  // namespace atlas
