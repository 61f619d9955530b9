// SPDX-License-Identifier: MIT
// A small truth and a run's output folder side by side in a temporary folder.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "atlas/output/trajectory_text.hpp"
#include "synthetic/evaluate.hpp"
#include "synthetic/world.hpp"

namespace atlas::synthetic {

class EvaluateTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "evaluate_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    base_ = name;
    folders_ = {base_ / "record" / "truth", base_ / "record", base_ / "out"};
    std::filesystem::create_directories(folders_.truth);
    std::filesystem::create_directories(folders_.out / "trajectory");
  }
  void TearDown() override { std::filesystem::remove_all(base_); }

  static void writeText(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }
  static std::string anchorText(const Geodetic& anchor) {
    const nlohmann::json json = {{"latitude", anchor.latitude_deg},
                                 {"longitude", anchor.longitude_deg},
                                 {"altitude", anchor.altitude_m}};
    return json.dump();
  }
  void writeRun(const std::vector<StampedPose>& poses, const std::string& anchor) const {
    std::string text;
    for (const StampedPose& pose : poses) {
      Odometry odometry;
      odometry.stamp = pose.stamp;
      odometry.T_map_imu = pose.pose;
      text += tumLine(odometry);
    }
    writeText(folders_.out / "trajectory" / "trajectory.tum", text);
    writeText(folders_.out / "trajectory" / "anchor.json", anchor);
  }
  /// Truth of the anchor and of a drive that takes no other data; the run's trajectory is the true one.
  void writeTrueRun() const {
    DriveOptions options;
    options.duration_s = 20.0;
    const World world(options);
    writeTruth(world, folders_.truth);
    writeRun(readTrajectory(folders_.truth / "trajectory.tum"), anchorText(options.anchor));
  }
  /// True when some reason of the evaluation holds `part`.
  static bool isSkipped(const Evaluation& evaluation, const std::string& part) {
    for (const auto& [reason, count] : evaluation.skipped()) {
      if (reason.find(part) != std::string::npos && count > 0) return true;
    }
    return false;
  }

  std::filesystem::path base_;
  RunFolders folders_;
};

}  // namespace atlas::synthetic
