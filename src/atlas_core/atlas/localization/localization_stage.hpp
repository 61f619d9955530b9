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
#include "atlas/localization/positioning_filter.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct LocalizationParams {
  std::string filter = "kalman_1d";  ///< see makePositioningFilter()
  /// Its T_imu_antenna translation is the lever arm; "" = the frame that the fix itself names (none: at the
  /// imu).
  std::string gnss_antenna_frame = "gnss_rear";
  PositioningParams positioning;
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const LocalizationParams& params);

class LocalizationStage : public Stage {
 public:
  enum Input : std::size_t { kTfStatic, kGnssFix, kGnssHeading, kImu, kInputs };

  explicit LocalizationStage(const LocalizationParams& params);
  ~LocalizationStage() override;

  void push(Stamp stamp, const StaticTransforms& transforms);
  void push(const GnssFix& fix);
  void push(const GnssHeading& heading);
  void push(const ImuSample& sample);

  std::function<void(const Odometry&)>
      on_odometry;                               ///< one per IMU sample once position and heading are known
  std::function<void(const Anchor&)> on_anchor;  ///< once, with the first fix

 protected:
  void onEnd() override;

 private:
  void use(const GnssFix& fix);
  void use(const GnssHeading& heading);
  void use(const ImuSample& sample);
  [[nodiscard]] Outcome<Eigen::Vector3d> leverArm(const GnssFix& fix) const;
  [[nodiscard]] Eigen::Matrix3d covarianceOf(const GnssFix& fix);

  LocalizationParams params_;
  Rig rig_;
  std::optional<LocalEnu> map_;        ///< set with the first fix
  std::optional<ImuSample> last_imu_;  ///< before there is a filter: the first fix lies between two samples
  std::unique_ptr<PositioningFilter> filter_;
};

}  // namespace atlas
