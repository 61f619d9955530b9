// SPDX-License-Identifier: MIT
// Is the time that is rebuilt for each point of a real sweep true? Sweeps put together by the poses of the
// vehicle at the times of their points fill the fewest voxels when it is.
#include <gtest/gtest.h>

#include <cstdlib>
#include <unordered_set>

#include "atlas/base/geodesy.hpp"
#include "atlas/base/trajectory.hpp"
#include "drained.hpp"

namespace atlas::record {
namespace {

/// The drive's own poses, by its inertial navigation.
Trajectory trajectoryOf(const test::Drained& drive) {
  const auto fixes = drive.payloads<GnssFix>("gnss/fix");
  const auto samples = drive.payloads<ImuSample>("imu/data");
  const LocalEnu local(fixes.at(0).position);
  Trajectory trajectory;
  for (std::size_t i = 0; i < fixes.size(); ++i)
    trajectory.push({fixes[i].stamp, Pose{*samples.at(i).orientation, local.toMap(fixes[i].position)}});
  return trajectory;
}

/// Voxels of 0.15 m that ten sweeps fill when each point is put where the vehicle was `scale` times the
/// point's time away from the moment at which the sensor looked forward.
std::size_t filledVoxels(const test::Drained& drive, const Pose& T_imu_lidar, double scale) {
  const Trajectory trajectory = trajectoryOf(drive);
  const auto sweeps = drive.payloads<SweepPtr>("velodyne/points");
  std::unordered_set<std::int64_t> voxels;
  for (std::size_t s = 6; s < 16; ++s) {
    constexpr double kForward_s = -0.05178;  // before the stamp, which is the end of the sweep
    std::map<std::int64_t, Pose> poses;      // one for each ms: half a millimetre at this speed
    for (const LidarPoint& p : sweeps.at(s)->points) {
      const Eigen::Vector3d p_lidar(p.x, p.y, p.z);
      if (!p_lidar.allFinite() || p_lidar.norm() > 40.0 || p_lidar.norm() < 3.0) continue;
      const auto ms = static_cast<std::int64_t>(
          std::floor(1e3 * (kForward_s + scale * (static_cast<double>(p.time) - kForward_s))));
      const auto [place, first] = poses.try_emplace(ms);
      if (first) place->second = trajectory.at(sweeps[s]->stamp + ms * kMillisecond).value() * T_imu_lidar;
      const Eigen::Vector3d p_map = place->second * p_lidar / 0.15;
      const auto cell = [](double v) { return static_cast<std::int64_t>(std::floor(v)) & 0xfffff; };
      voxels.insert(cell(p_map.x()) << 40 | cell(p_map.y()) << 20 | cell(p_map.z()));
    }
  }
  return voxels.size();
}

TEST(RealSweep, PointTimesOfKittiMakeTheMapSharper) {
  const char* data = std::getenv("ATLAS_DATA");
  const std::filesystem::path folder = std::filesystem::path(data ? data : "") / "kitti_raw_0048";
  if (data == nullptr || !std::filesystem::is_directory(folder)) GTEST_SKIP() << "ATLAS_DATA is not set";
  const test::Drained drive = test::readRecord(folder);
  Pose T_imu_lidar;
  const auto rig = drive.payloads<StaticTransforms>("tf_static").at(0);
  for (const StaticTransform& t : rig.transforms) {
    if (t.child == "velodyne") T_imu_lidar = t.T_parent_child;
  }
  const std::size_t right = filledVoxels(drive, T_imu_lidar, 1.0);
  const std::size_t none = filledVoxels(drive, T_imu_lidar, 0.0);
  const std::size_t reversed = filledVoxels(drive, T_imu_lidar, -1.0);
  RecordProperty("right", std::to_string(right));
  RecordProperty("none", std::to_string(none));
  RecordProperty("reversed", std::to_string(reversed));
  EXPECT_LT(right, none);
  EXPECT_LT(none, reversed) << "the sensor turns clockwise";
}

}  // namespace
}  // namespace atlas::record
