// SPDX-License-Identifier: MIT
// The smoother's record of a run: where it is kept makes no difference.
#include "atlas/localization/eskf_history.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "stage_run.hpp"

namespace atlas::test {
namespace {

/// Filters and smooths a drive of 45 s.
void runInto(eskf::History& history) {
  std::mt19937 random(11);
  const DriveParams d = cityDrive(45.0);
  const Recording recording = record(drive(d), d, realisticErrors(random), random);
  LocalizationParams params;
  params.filter = "eskf";
  LocalizationStage stage(params);
  stage.record(&history);
  feed(stage, recording, d);
  history.smooth();
}

TEST(EskfHistory, OnDiskItIsTheSameBitByBit) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "eskf_history";
  eskf::History in_memory, on_disk({folder, 1});
  runInto(in_memory);
  runInto(on_disk);
  EXPECT_FALSE(in_memory.spilled());
  EXPECT_TRUE(on_disk.spilled());
  ASSERT_GT(in_memory.size(), 1000u);
  ASSERT_EQ(in_memory.size(), on_disk.size());
  for (std::size_t i = 0; i < in_memory.size(); ++i) {
    const Odometry a = in_memory.odometry(i), b = on_disk.odometry(i);
    ASSERT_EQ(in_memory.stamp(i), on_disk.stamp(i));
    ASSERT_EQ(a.stamp, b.stamp);
    ASSERT_EQ(a.T_map_imu.translation, b.T_map_imu.translation) << i;
    ASSERT_EQ(a.T_map_imu.rotation.coeffs(), b.T_map_imu.rotation.coeffs()) << i;
    ASSERT_EQ(a.velocity_imu_mps, b.velocity_imu_mps) << i;
    ASSERT_EQ(a.angular_velocity_imu_radps, b.angular_velocity_imu_radps) << i;
    ASSERT_EQ(a.pose_covariance, b.pose_covariance) << i;
    ASSERT_EQ(a.twist_covariance, b.twist_covariance) << i;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder)) << "nothing with a name is left there";
}

TEST(EskfHistory, AFolderThatCannotBeUsedIsNamed) {
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "eskf_history_file";
  std::ofstream(file) << "no folder";
  eskf::History history({file, 1});
  try {
    runInto(history);
    FAIL() << "it cannot have been kept";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace atlas::test
