// SPDX-License-Identifier: MIT
// A lidar on a moving vehicle, for tests: the truth is an odometry sampled from an arc and interpolated as
// the suite does it, so the only error left in a de-skewed point is that of the batch.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "atlas/base/trajectory.hpp"
#include "atlas/lidar/batched_points.hpp"
#include "atlas/lidar/deskew_stage.hpp"

namespace atlas::test {

constexpr Stamp kStart = 1'500'000'000'000'000'000;
inline Stamp at(double t_s) { return kStart + fromSeconds(t_s); }

struct Drive {
  double speed_mps = 10.0;
  double yaw_rate_radps = 0.5;
  double heading_rad = 0.3;
  double odometry_hz = 100.0;
  Pose T_imu_lidar{fromRollPitchYaw({0.02, -0.03, 0.4}), Eigen::Vector3d(0.8, -0.4, 0.3)};

  /// Constant speed and yaw rate: p = v / w (sin, -cos).
  [[nodiscard]] Pose arc(double t_s) const {
    const double yaw = heading_rad + yaw_rate_radps * t_s;
    Eigen::Vector3d p(5.0, -7.0, 1.5);
    if (yaw_rate_radps == 0.0) {
      p += speed_mps * t_s * Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0.0);
    } else {
      const double radius = speed_mps / yaw_rate_radps;
      p += radius *
           Eigen::Vector3d(std::sin(yaw) - std::sin(heading_rad), std::cos(heading_rad) - std::cos(yaw), 0.0);
    }
    return {fromRollPitchYaw({0.01, 0.02, yaw}), p};
  }
  [[nodiscard]] std::vector<Odometry> odometry(double from_s, double to_s) const {
    std::vector<Odometry> result;
    const auto first = static_cast<int>(std::ceil(from_s * odometry_hz - 1e-6));
    for (int i = first; i / odometry_hz <= to_s + 1e-9; ++i) {
      Odometry o;
      o.stamp = at(i / odometry_hz);
      o.T_map_imu = arc(i / odometry_hz);
      const double yaw = heading_rad + yaw_rate_radps * i / odometry_hz;
      const Eigen::Quaterniond R_imu_map = o.T_map_imu.rotation.conjugate();
      o.velocity_imu_mps = R_imu_map * (speed_mps * Eigen::Vector3d(std::cos(yaw), std::sin(yaw), 0.0));
      o.angular_velocity_imu_radps = R_imu_map * Eigen::Vector3d(0.0, 0.0, yaw_rate_radps);
      result.push_back(o);
    }
    return result;
  }
  [[nodiscard]] Trajectory trajectory(double from_s, double to_s) const {
    Trajectory result;
    for (const Odometry& o : odometry(from_s, to_s)) result.push({o.stamp, o.T_map_imu});
    return result;
  }
};

/// A sweep and where its points truly are.
struct SeenSweep {
  std::shared_ptr<Sweep> sweep;
  std::vector<Eigen::Vector3d> truth_map;
};

/// Points of a wall (the cylinder of 15 m around the middle of the drive) met in `count` directions during
/// one clockwise turn of 0.1 s that starts at the stamp.
inline SeenSweep seeWall(const Drive& drive, double stamp_s, int count,
                         const std::string& frame = "lidar_left") {
  const Trajectory truth = drive.trajectory(stamp_s - 0.1, stamp_s + 0.3);
  SeenSweep seen{std::make_shared<Sweep>(), {}};
  seen.sweep->stamp = at(stamp_s);
  seen.sweep->frame = frame;
  const Eigen::Vector3d middle = drive.arc(stamp_s).translation;
  for (int i = 0; i < count; ++i) {
    LidarPoint point;
    point.time = static_cast<float>(0.1 * i / count);
    point.ring = static_cast<std::uint16_t>(i % 32);
    point.intensity = static_cast<float>(i % 256);
    const Stamp stamp = seen.sweep->stamp + fromSeconds(static_cast<double>(point.time));
    const double azimuth = -2.0 * M_PI * i / count;
    const Eigen::Vector3d p_map =
        middle + Eigen::Vector3d(15.0 * std::cos(azimuth), 15.0 * std::sin(azimuth), 0.1 * (i % 32));
    const Eigen::Vector3d p_lidar = (*truth.at(stamp) * drive.T_imu_lidar).inverse() * p_map;
    point.x = static_cast<float>(p_lidar.x());
    point.y = static_cast<float>(p_lidar.y());
    point.z = static_cast<float>(p_lidar.z());
    seen.sweep->points.push_back(point);
    seen.truth_map.push_back(p_map);
  }
  return seen;
}

inline double distance(const LidarPoint& p, const Eigen::Vector3d& q) {
  return (Eigen::Vector3d(p.x, p.y, p.z) - q).norm();
}
inline double worstError(const MapCloud& cloud, const std::vector<Eigen::Vector3d>& truth_map) {
  double worst = cloud.points.size() == truth_map.size() ? 0.0 : 1e9;
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    worst = std::max(worst, distance(cloud.points[i], truth_map[i]));
  return worst;
}

inline StaticTransforms rigOf(const Drive& drive, const std::vector<std::string>& lidars) {
  StaticTransforms rig;
  for (const std::string& lidar : lidars) rig.transforms.push_back({"base_link", lidar, drive.T_imu_lidar});
  return rig;
}

/// A stage for one or two lidars with its answers.
struct DeskewRun {
  struct Answer {
    std::size_t lidar;
    BatchedSweepPtr batched;
  };
  explicit DeskewRun(const DeskewParams& p) : params(p), stage(p) {
    stage.on_batches = [this](std::size_t lidar, const BatchedSweepPtr& batched) {
      answers.push_back({lidar, batched});
    };
  }
  void rig(const Drive& drive) {
    stage.push(0, rigOf(drive, params.lidars));
    stage.finish(DeskewStage::kTfStatic);
  }
  void finish() {
    for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
  }
  DeskewParams params;
  DeskewStage stage;
  std::vector<Answer> answers;
};

inline DeskewParams oneLidar(int batches = 100) {
  DeskewParams params;
  params.lidars = {"lidar_left"};
  params.batches_per_sweep = batches;
  return params;
}

/// Rig, odometry and one sweep, all at once.
inline BatchedSweepPtr deskewOne(const Drive& drive, const SweepPtr& sweep, const DeskewParams& params) {
  DeskewRun run(params);
  run.rig(drive);
  const double stamp_s = toSeconds(sweep->stamp - kStart);
  for (const Odometry& o : drive.odometry(stamp_s - 0.2, stamp_s + 0.3)) run.stage.push(o);
  run.stage.push(0, sweep);
  run.finish();
  return run.answers.size() == 1 ? run.answers[0].batched : nullptr;
}

}  // namespace atlas::test
