// SPDX-License-Identifier: MIT
// The motion within a sweep: as driven, whatever the positioning corrects meanwhile.
#include "atlas/lidar/vehicle_motion.hpp"

#include <gtest/gtest.h>

#include "moving_lidar.hpp"

namespace atlas {
namespace {

using namespace test;

/// What a fix at 1.05 s changes: from then on the same drive, half a degree and 20 cm aside.
const Pose kCorrection{fromRollPitchYaw({0.0, 0.0, 0.5 * M_PI / 180.0}), Eigen::Vector3d(0.2, 0.0, 0.0)};

std::vector<Odometry> correctedAt105(const Drive& drive) {
  std::vector<Odometry> result = drive.odometry(0.8, 1.4);
  for (Odometry& o : result)
    if (o.stamp >= at(1.05)) o.T_map_imu = kCorrection * o.T_map_imu;
  return result;
}

/// Largest distance from the truth of a point 30 m ahead of the vehicle, seen from its pose at 1 s.
double worstMotionError_m(const Drive& drive, const Trajectory& poses) {
  double worst_m = 0.0;
  for (double t_s = 1.0; t_s <= 1.1; t_s += 0.01) {
    const Eigen::Vector3d ahead(30.0, 0.0, 0.0);
    const Eigen::Vector3d is = poses.at(at(1.0))->inverse() * (*poses.at(at(t_s)) * ahead);
    const Eigen::Vector3d should = drive.arc(1.0).inverse() * (drive.arc(t_s) * ahead);
    worst_m = std::max(worst_m, (is - should).norm());
  }
  return worst_m;
}

TEST(VehicleMotion, VelocitiesAddUpToThePoses) {
  const Drive drive;
  VehicleMotion motion;
  for (const Odometry& o : drive.odometry(0.0, 1.4)) motion.push(o);
  const auto poses = motion.around(at(1.0), at(1.0), at(1.1));
  ASSERT_TRUE(poses);
  EXPECT_LT((poses->at(at(1.0))->translation - drive.arc(1.0).translation).norm(), 1e-9);
  // The trapezoid's error: v w^2 dt^3 / 12 a step of 10 ms.
  EXPECT_LT(worstMotionError_m(drive, *poses), 10 * (10.0 * 0.25 * 1e-6 / 12) + 1e-9);
}

TEST(VehicleMotion, ACorrectionIsNoMotion) {
  const Drive drive;
  VehicleMotion velocities, poses;
  for (const Odometry& o : correctedAt105(drive)) {
    velocities.push(o);
    poses.push(StampedPose{o.stamp, o.T_map_imu});
  }
  const auto smooth = velocities.around(at(1.0), at(1.0), at(1.1));
  const auto stepped = poses.around(at(1.0), at(1.0), at(1.1));
  ASSERT_TRUE(smooth && stepped);
  EXPECT_LT(worstMotionError_m(drive, *smooth), 1e-5);
  EXPECT_GT(worstMotionError_m(drive, *stepped), 0.2);
  // Whoever asks after the correction gets a pose that has it.
  const auto after = velocities.around(at(1.2), at(1.1), at(1.2));
  ASSERT_TRUE(after);
  const Pose expected = kCorrection * drive.arc(1.2);
  EXPECT_LT((after->at(at(1.2))->translation - expected.translation).norm(), 1e-9);
  EXPECT_LT(after->at(at(1.2))->rotation.angularDistance(expected.rotation), 1e-9);
}

TEST(VehicleMotion, NothingIsExtrapolated) {
  const Drive drive;
  VehicleMotion motion;
  EXPECT_EQ(motion.around(at(1.0), at(1.0), at(1.1)).reason(), Reason::kNoPoseYet);
  for (const Odometry& o : drive.odometry(0.95, 1.05)) motion.push(o);
  EXPECT_EQ(motion.around(at(1.1), at(1.1), at(1.2)).reason(), Reason::kPoseNotReached);
  const auto poses = motion.around(at(1.0), at(0.9), at(1.1));
  ASSERT_TRUE(poses);
  EXPECT_EQ(poses->at(at(0.9)).reason(), Reason::kNoPoseYet);
  EXPECT_EQ(poses->at(at(1.1)).reason(), Reason::kPoseNotReached);
  EXPECT_TRUE(poses->at(at(1.05)));
  motion.forgetBefore(at(1.02));
  EXPECT_EQ(motion.around(at(1.0), at(1.0), at(1.05)).reason(), Reason::kNoPoseYet);
  EXPECT_TRUE(motion.around(at(1.02), at(1.02), at(1.05)));
}

/// Points of one sweep against the truth as the pose at its stamp has them: what is left is distortion.
double distortion_m(const Drive& drive, const std::vector<Odometry>& odometry, const DeskewParams& params,
                    std::uint64_t& jumps) {
  DeskewRun run(params);
  run.rig(drive);
  for (const Odometry& o : odometry) run.stage.push(o);
  const SeenSweep seen = seeWall(drive, 1.0, 1000);
  run.stage.push(0, seen.sweep);
  run.finish();
  jumps = run.stage.counters().get("sweeps with a jump of the position, or whose odometry has no velocities");
  return worstError(inMap(*run.answers.at(0).batched), seen.truth_map);
}

TEST(VehicleMotion, TheStageUsesIt) {
  const Drive drive;
  for (const int batches : {0, 1000}) {
    DeskewParams params = oneLidar(batches);
    std::uint64_t jumps = 0;
    // Half a step of the trapezoid, float coordinates.
    EXPECT_LT(distortion_m(drive, correctedAt105(drive), params, jumps), 2e-4) << batches;
    EXPECT_EQ(jumps, 0U);
    params.motion = "poses";
    EXPECT_GT(distortion_m(drive, correctedAt105(drive), params, jumps), 0.15) << batches;
  }
}

TEST(VehicleMotion, OdometryWithoutVelocitiesIsCounted) {
  const Drive drive;
  std::vector<Odometry> odometry = drive.odometry(0.8, 1.4);
  for (Odometry& o : odometry) o.velocity_imu_mps = o.angular_velocity_imu_radps = Eigen::Vector3d::Zero();
  DeskewParams params = oneLidar();
  std::uint64_t jumps = 0;
  EXPECT_GT(distortion_m(drive, odometry, params, jumps), 0.5) << "nothing moves the points";
  EXPECT_EQ(jumps, 1U);
  params.motion = "poses";
  EXPECT_LT(distortion_m(drive, odometry, params, jumps), 0.01);
  EXPECT_EQ(jumps, 0U);
}

}  // namespace
}  // namespace atlas
