// SPDX-License-Identifier: MIT
// Runs a LocalizationStage over a simulated recording and compares its odometry with the truth.
#pragma once

#include <map>

#include "atlas/localization/localization_stage.hpp"
#include "simulated_drive.hpp"

namespace atlas::test {

struct StageRun {
  std::vector<Odometry> odometry;
  std::optional<Anchor> anchor;
  Counters counters;
};

inline StaticTransforms rigWith(const Eigen::Vector3d& lever_arm_imu) {
  return {{{"base_link", "gnss_rear", {Eigen::Quaterniond::Identity(), lever_arm_imu}}}};
}

inline void listen(LocalizationStage& stage, StageRun& run) {
  stage.on_odometry = [&run](const Odometry& odometry) { run.odometry.push_back(odometry); };
  stage.on_anchor = [&run](const Anchor& anchor) { run.anchor = anchor; };
}

/// The whole recording, stream by stream.
inline void feed(LocalizationStage& stage, const Recording& recording, const DriveParams& drive) {
  stage.push(recording.imu.front().stamp, rigWith(drive.lever_arm_imu));
  stage.finish(LocalizationStage::kTfStatic);
  for (const GnssFix& fix : recording.fixes) stage.push(fix);
  for (const GnssHeading& heading : recording.headings) stage.push(heading);
  stage.finish(LocalizationStage::kGnssFix);
  stage.finish(LocalizationStage::kGnssHeading);
  for (const ImuSample& sample : recording.imu) stage.push(sample);
  stage.finish(LocalizationStage::kImu);
}

inline StageRun runStage(const Recording& recording, const DriveParams& drive,
                         const LocalizationParams& params = {}) {
  StageRun result;
  LocalizationStage stage(params);
  listen(stage, result);
  feed(stage, recording, drive);
  result.counters = stage.counters();
  return result;
}

/// Errors of the odometry at one stamp, in map; the first fix's antenna is the origin of map.
struct PoseError {
  double time_s = 0.0;
  Eigen::Vector3d position_m, velocity_mps, rotation_rad;  ///< rotation about map's axes
  double position_nees = 0.0;                              ///< x, y: 2 degrees of freedom
  double velocity_nees = 0.0;                              ///< x, y in the imu frame: 2 degrees of freedom
  double yaw_nees = 0.0;                                   ///< 1 degree of freedom
};

inline std::vector<PoseError> errors(const std::vector<Odometry>& odometry, const std::vector<Truth>& truth,
                                     const Recording& recording, const DriveParams& drive) {
  using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;
  std::map<Stamp, const Truth*> by_stamp;
  for (const Truth& t : truth) by_stamp[t.stamp] = &t;
  const Eigen::Vector3d origin =
      truthAt(truth, recording.fixes.front().stamp).T_map_imu * drive.lever_arm_imu;
  std::vector<PoseError> result;
  for (const Odometry& o : odometry) {
    const Truth& t = *by_stamp.at(o.stamp);
    PoseError e;
    e.time_s = toSeconds(o.stamp - truth.front().stamp);
    e.position_m = o.T_map_imu.translation - (t.T_map_imu.translation - origin);
    const Eigen::Vector3d v_imu = t.T_map_imu.rotation.conjugate() * t.velocity_map;
    e.velocity_mps = o.velocity_imu_mps - v_imu;
    e.rotation_rad = logSo3(o.T_map_imu.rotation * t.T_map_imu.rotation.conjugate());
    const Matrix6 P = Eigen::Map<const Matrix6>(o.pose_covariance.data());
    const Matrix6 V = Eigen::Map<const Matrix6>(o.twist_covariance.data());
    const Eigen::Vector2d p = e.position_m.head<2>(), v = e.velocity_mps.head<2>();
    const Eigen::Matrix2d Pp = P.topLeftCorner<2, 2>(), Pv = V.topLeftCorner<2, 2>();
    e.position_nees = p.dot(Pp.inverse() * p);
    e.velocity_nees = v.dot(Pv.inverse() * v);
    e.yaw_nees = e.rotation_rad.z() * e.rotation_rad.z() / P(5, 5);
    result.push_back(e);
  }
  return result;
}

template <class Value>
double rms(const std::vector<PoseError>& all, double from_s, double to_s, Value value) {
  double sum = 0.0;
  int n = 0;
  for (const PoseError& e : all) {
    if (e.time_s < from_s || e.time_s > to_s) continue;
    sum += value(e) * value(e);
    ++n;
  }
  return std::sqrt(sum / n);
}
template <class Value>
double mean(const std::vector<PoseError>& all, double from_s, double to_s, Value value) {
  double sum = 0.0;
  int n = 0;
  for (const PoseError& e : all) {
    if (e.time_s < from_s || e.time_s > to_s) continue;
    sum += value(e);
    ++n;
  }
  return sum / n;
}

}  // namespace atlas::test
