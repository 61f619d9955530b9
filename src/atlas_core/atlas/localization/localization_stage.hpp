// SPDX-License-Identifier: MIT
// Stage: IMU and GNSS in, odometry at IMU rate out. The filter behind it is chosen by
// LocalizationParams::filter.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "atlas/base/stage.hpp"
#include "atlas/calibration/rig.hpp"
#include "atlas/localization/barometer.hpp"
#include "atlas/localization/imu_guard.hpp"
#include "atlas/localization/localization_status.hpp"
#include "atlas/localization/positioning_filter.hpp"
#include "atlas/localization/receivers.hpp"
#include "atlas/sensor/products.hpp"
#include "atlas/sensor/sensor_gate.hpp"

namespace atlas {

struct LocalizationParams {
  std::string filter = "kalman_1d";  ///< see makePositioningFilter()
  /// Its T_imu_antenna translation is the lever arm; "" = the frame that the fix itself names (none: at the
  /// imu).
  std::string gnss_antenna_frame = "gnss_rear";
  PositioningParams positioning;
  ReceiverParams receivers;
  ImuGuardParams imu_guard;
  BarometerParams barometer;
  SensorLimits gate_on_sensors;  ///< gnss, imu_gnss: fixes and headings below are left out
  /// A smoothed run over the same data: the stage answers from it instead of filtering (second pass offline).
  std::shared_ptr<const eskf::History> smoothed;
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const LocalizationParams& params);

class LocalizationStage : public Stage {
 public:
  enum Input : std::size_t {
    kTfStatic,
    kGnssFix,
    kGnssHeading,
    kImu,
    kSecondFix,
    kPressure
  };  ///< the last two: if asked for

  /// With a gate its status is input 1, and those after tf_static come one later.
  static std::size_t gatedInput(const LocalizationParams& params, Input input) {
    return input == kTfStatic || params.gate_on_sensors.empty() ? input : input + 1;
  }
  static constexpr std::size_t kGateStatus = 1;

  explicit LocalizationStage(const LocalizationParams& params);
  ~LocalizationStage() override;

  void push(Stamp stamp, const StaticTransforms& transforms);
  void push(const GnssFix& fix);
  void pushSecond(const GnssFix& fix);
  void pushPressure(const ScalarSample& pressure);
  void push(const GnssHeading& heading);
  void push(const ImuSample& sample);
  void push(const SensorStatus& status);

  /// Records the run for smoothing; call before the first event. Throws std::invalid_argument for a filter
  /// that has no smoother. The history must outlive the stage.
  void record(eskf::History* history);
  /// Of the present time; none before there is an estimate.
  [[nodiscard]] std::optional<ImuBias> imuBias() const;

  std::function<void(const Odometry&)>
      on_odometry;                               ///< one per IMU sample once position and heading are known
  std::function<void(const Anchor&)> on_anchor;  ///< once, with the first fix
  std::function<void(const InnovationRecord&)> on_innovation;  ///< one per measurement, used or not
  std::function<void(const LocalizationStatus&)> on_status;    ///< once a second and at every change

 protected:
  void onEnd() override;

 private:
  // localization_fixes.cpp
  void use(const GnssFix& fix);
  void useSecond(const GnssFix& fix);
  [[nodiscard]] bool isPosition(const GnssFix& fix, const char* what);
  [[nodiscard]] Outcome<Eigen::Vector3d> leverArm(const GnssFix& fix, const std::string& frame) const;
  [[nodiscard]] Eigen::Matrix3d covarianceOf(const GnssFix& fix, double horizontal_m, double vertical_m);
  void anchorAt(const GnssFix& fix);
  void startFilter(const Eigen::Vector3d& lever_arm_imu);
  void giveToFilter(const Receivers::Fix& fix, Receivers::Use receiver);
  void onInnovation(const InnovationRecord& record);

  /// False: counted, not to be used.
  bool trusts(const char* sensor, const char* what);
  void usePressure(const ScalarSample& pressure);
  void use(const GnssHeading& heading);
  void use(const ImuSample& sample);
  void answer(Stamp stamp, const std::optional<Odometry>& odometry);

  LocalizationParams params_;
  Rig rig_;
  SensorGate gate_;
  std::optional<LocalEnu> map_;        ///< set with the first fix
  std::optional<ImuSample> last_imu_;  ///< before there is a filter: the first fix lies between two samples
  void emit(const Odometry& odometry);
  void answerSmoothed(Stamp stamp);

  std::unique_ptr<PositioningFilter> filter_;
  Eigen::Vector3d filter_lever_ = Eigen::Vector3d::Zero();  ///< of the fixes that the filter expects
  Receivers receivers_;
  ImuGuard guard_;
  Barometer barometer_;
  StatusKeeper keeper_;
  Stamp second_in_filter_ = kBeginOfTime;  ///< newest fix of the second receiver that the filter was given
  std::optional<Geodetic> second_before_;
  eskf::History* history_ = nullptr;
  std::size_t smoothed_next_ = 0;  ///< first smoothed sample that is not older than the present one
};

}  // namespace atlas
