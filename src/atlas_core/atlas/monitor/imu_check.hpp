// SPDX-License-Identifier: MIT
// The inertial sensor: what the positioning's own guard refuses (frozen, saturated, implausible, wrong
// units), the norm of gravity, and jumps of the gyroscopes' bias seen while the vehicle stands.
#pragma once

#include <optional>

#include "atlas/localization/imu_guard.hpp"
#include "atlas/localization/imu_monitor.hpp"
#include "atlas/monitor/findings.hpp"

namespace atlas {

class ImuCheck {
 public:
  explicit ImuCheck(const AnomalyThresholds& thresholds);
  ImuCheck(const ImuCheck&) = delete;  // the guard refers to the counters beside it
  ImuCheck& operator=(const ImuCheck&) = delete;
  /// `standing`: somebody else sees that the vehicle stands.
  void add(const ImuSample& sample, bool standing, Findings& findings);

 private:
  /// Gives what the guard says of the sample.
  void ask(const ImuSample& sample, Findings& findings);
  void measureGravity(const ImuMonitor::Block& block, Stamp stamp, Findings& findings);
  void measureBias(const ImuMonitor::Block& block, bool standing, Stamp stamp, Findings& findings);

  Counters counters_;  ///< of the guard
  ImuGuard guard_;
  bool units_wrong_ = false;
  ImuMonitor monitor_;
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero(), gyro_sum_ = Eigen::Vector3d::Zero();
  int force_blocks_ = 0, standing_blocks_ = 0;
  std::optional<Eigen::Vector3d> standing_gyro_radps_;  ///< of earlier standstills
};

}  // namespace atlas
