// SPDX-License-Identifier: MIT
// An IMU that does not look forward: seen in the accelerations, and the heading is set anew.
#include "atlas/localization/eskf_mount.hpp"

#include <gtest/gtest.h>

#include "stage_run.hpp"

namespace atlas::test {
namespace {

constexpr double kDeg = M_PI / 180.0;

TEST(MountYaw, NothingIsSaidAtConstantSpeed) {
  eskf::MountYaw mount;
  for (int i = 0; i < 100; ++i) {
    mount.move(Eigen::Quaterniond::Identity(), {0.3, 0.0, 9.81}, 0.2);
    mount.velocity({5.0, 5.0, 0.0}, 0.01, Eigen::Vector3d::UnitZ());
  }
  EXPECT_FALSE(mount.angle());
}

TEST(MountYaw, NothingIsSaidWhenBothViewsDisagree) {
  eskf::MountYaw mount;
  for (int i = 0; i < 100; ++i) {  // speeds up and brakes by turns; the imu sees one and the same push
    mount.move(Eigen::Quaterniond::Identity(), {2.0, 0.0, 9.81}, 1.0);
    mount.velocity({0.0, i % 2 == 0 ? 5.0 : 7.0, 0.0}, 0.001, Eigen::Vector3d::UnitZ());
  }
  EXPECT_FALSE(mount.angle());
}

TEST(MountYaw, IsTheAngleFromImuXToTheCourse) {
  eskf::MountYaw mount;
  for (int i = 0; i < 4; ++i) {  // northwards, faster and faster; felt to the right of the imu
    mount.move(Eigen::Quaterniond::Identity(), {0.0, -2.0, 9.81}, 1.0);
    mount.velocity({0.0, 5.0 + 2.0 * i, 0.0}, 0.001, Eigen::Vector3d::UnitZ());
  }
  ASSERT_TRUE(mount.angle());
  EXPECT_NEAR(*mount.angle(), -90.0 * kDeg, 1e-9);
}

/// Drive without a receiver's heading, imu turned by `mounted` about z; the last error of the odometry.
PoseError lastError(double mounted_rad, std::uint64_t& set_anew) {
  std::mt19937 random(4);
  DriveParams p = cityDrive(50.0);
  p.sway_rad = 0.003;
  std::vector<Truth> truth = drive(p);
  Errors noise = realisticErrors(random);
  noise.earth_rotates = true;
  Recording recording = record(truth, p, noise, random);
  recording.headings.clear();
  const Eigen::Quaterniond R_vehicle_imu = expSo3({0.0, 0.0, mounted_rad});
  for (ImuSample& sample : recording.imu) {
    sample.orientation.reset();
    sample.angular_velocity_radps = R_vehicle_imu.conjugate() * sample.angular_velocity_radps;
    sample.linear_acceleration_mps2 = R_vehicle_imu.conjugate() * sample.linear_acceleration_mps2;
  }
  for (Truth& t : truth) t.T_map_imu.rotation = t.T_map_imu.rotation * R_vehicle_imu;
  p.lever_arm_imu = R_vehicle_imu.conjugate() * p.lever_arm_imu;
  LocalizationParams params;
  params.filter = "eskf";
  const StageRun run = runStage(recording, p, params);
  set_anew = 0;
  for (const auto& [what, count] : run.counters.all())
    if (what.find("heading set anew") != std::string::npos) set_anew += count;
  return errors(run.odometry, truth, recording, p).back();
}

TEST(MountYaw, AnImuMountedAcrossOrBackwardsIsAsGoodAsOneThatLooksForward) {
  for (const double mounted_deg : {0.0, 15.0, 90.0, -120.0, 180.0}) {
    std::uint64_t set_anew = 0;
    const PoseError error = lastError(mounted_deg * kDeg, set_anew);
    EXPECT_EQ(set_anew, std::abs(mounted_deg) > 45.0 ? 1u : 0u) << mounted_deg;
    EXPECT_LT(error.position_m.head<2>().norm(), 0.05) << mounted_deg;  // fixes of 2 cm
    EXPECT_LT(std::abs(error.rotation_rad.z()), 0.5 * kDeg) << mounted_deg;
  }
}

}  // namespace
}  // namespace atlas::test
