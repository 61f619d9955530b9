// SPDX-License-Identifier: MIT
#include "atlas/localization/localization_stage.hpp"

#include <cmath>
#include <stdexcept>

#include "atlas/base/check.hpp"
#include "atlas/localization/eskf_history.hpp"

namespace atlas {
namespace {
constexpr double kMaxNormError = 1e-2;  // quaternions recorded with six digits, with room

std::vector<std::string> inputNames(const LocalizationParams& params) {
  std::vector<std::string> names = {"tf_static"};
  if (!params.gate_on_sensors.empty()) names.emplace_back("sensor_status");
  names.insert(names.end(), {"gnss/fix", "gnss/heading", "imu"});
  if (params.receivers.second_receiver || params.barometer.barometer) names.emplace_back("imu/gnss/fix");
  if (params.barometer.barometer) names.emplace_back("imu/pressure");
  return names;
}
}  // namespace

void validate(const LocalizationParams& params) {
  Counters counters;
  makePositioningFilter(params.filter, params.positioning, Eigen::Vector3d::Zero(), {}, counters);
  validate(params.gate_on_sensors, "localization");
  validate(params.receivers);
  validate(params.imu_guard);
  validate(params.barometer);
  if (params.barometer.barometer && params.filter != "eskf")
    throw std::invalid_argument("localization: barometer needs filter eskf, got '" + params.filter + "'");
}

LocalizationStage::LocalizationStage(const LocalizationParams& params)
    : Stage("localization", inputNames(params)),
      params_(params),
      gate_(params.gate_on_sensors),
      receivers_(params.receivers, counters_),
      guard_(params.imu_guard, counters_),
      barometer_(params.barometer, counters_),
      keeper_(counters_) {
  validate(params_);
}

LocalizationStage::~LocalizationStage() = default;

void LocalizationStage::push(Stamp stamp, const StaticTransforms& transforms) {
  enqueue(kTfStatic, stamp, [this, transforms] { rig_.add(transforms); });
}
void LocalizationStage::push(const GnssFix& fix) {
  enqueue(gatedInput(params_, kGnssFix), fix.stamp, [this, fix] { use(fix); });
}
void LocalizationStage::pushSecond(const GnssFix& fix) {
  ATLAS_CHECK(params_.receivers.second_receiver, "localization: there is no second receiver");
  enqueue(gatedInput(params_, kSecondFix), fix.stamp, [this, fix] { useSecond(fix); });
}
void LocalizationStage::pushPressure(const ScalarSample& pressure) {
  ATLAS_CHECK(params_.barometer.barometer, "localization: there is no barometer");
  enqueue(gatedInput(params_, kPressure), pressure.stamp, [this, pressure] { usePressure(pressure); });
}
void LocalizationStage::push(const GnssHeading& heading) {
  enqueue(gatedInput(params_, kGnssHeading), heading.stamp, [this, heading] { use(heading); });
}
void LocalizationStage::push(const ImuSample& sample) {
  enqueue(gatedInput(params_, kImu), sample.stamp, [this, sample] { use(sample); });
}
void LocalizationStage::push(const SensorStatus& status) {
  ATLAS_CHECK(!params_.gate_on_sensors.empty(), "localization: there is no gate");
  enqueue(kGateStatus, status.stamp, [this, status] { gate_.add(status); });
}

bool LocalizationStage::trusts(const char* sensor, const char* what) {
  if (gate_.open(sensor)) return true;
  counters_.add(std::string("skipped ") + what + ": score of " + sensor + " below its limit");
  return false;
}

void LocalizationStage::use(const GnssHeading& heading) {
  counters_.add("heading");
  if (params_.smoothed || !trusts("gnss", "heading")) return;
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
  receivers_.begin(sample.stamp);
  if (params_.smoothed) {
    answerSmoothed(sample.stamp);
    return;
  }
  if (!sample.angular_velocity_radps.allFinite() || !sample.linear_acceleration_mps2.allFinite()) {
    counters_.skip("imu", Reason::kNotFinite);
    return;
  }
  const bool usable = guard_.usable(sample);
  const ImuGuard::Doubt& doubt = guard_.doubt();
  if (filter_ && (doubt.velocity > 0.0 || doubt.turn > 0.0)) filter_->distrust(doubt.velocity, doubt.turn);
  if (!usable) return;
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
  if (filter_) {
    answer(clean.stamp, filter_->propagate(clean));
  } else {
    last_imu_ = clean;
    answer(clean.stamp, std::nullopt);
  }
}

void LocalizationStage::answer(Stamp stamp, const std::optional<Odometry>& odometry) {
  keeper_.answer(stamp, odometry);
  if (odometry) {
    receivers_.predicted(*odometry);
    emit(*odometry);
  } else {
    counters_.skip("odometry", Reason::kNoPoseYet);
  }
  if (on_status && keeper_.due(stamp)) on_status(keeper_.status(stamp, imuBias()));
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
