// SPDX-License-Identifier: MIT
// Whether a recording's stamps mark the start or the end of its sweeps, seen from the sharpness of the map: a
// synthetic drive through a curve, read as it is and with the wrong setting.
#include "scan_stamp_check.hpp"

#include <gtest/gtest.h>

#include "synthetic/drive.hpp"
#include "temporary_folder.hpp"

namespace atlas_loader {
namespace {

TEST(ScanStampCheck, SeesWhenAllSweepsAreStampedAtTheOtherEnd) {
  const atlas::test::TemporaryFolder folder;
  atlas::synthetic::DriveOptions drive;
  drive.seed = 3;
  drive.skip_s = 8.0;  // accelerates, brakes and turns
  drive.duration_s = 12.0;
  drive.cameras.clear();
  drive.video = false;
  drive.truth_points_every = 0;
  atlas::synthetic::writeDrive(drive, folder.path() / "drive", [](const std::string&, double) {});
  folder.remove("drive/lidar_right");  // one lidar tells as much in half the time
  InputOptions input;
  input.record = (folder.path() / "drive").string();
  const std::vector<ScanStampFit> right = tryScanStamps(input);
  ASSERT_EQ(right.size(), 1U);
  for (const ScanStampFit& fit : right) {
    EXPECT_FALSE(judge(fit).is_problem) << judge(fit).text;
    EXPECT_GT(fit.earlier, 0.0);
    EXPECT_GT(fit.later, 0.0);
  }
  input.scan_stamp = "start";
  const std::vector<ScanStampFit> wrong = tryScanStamps(input);
  ASSERT_EQ(wrong.size(), 1U) << "a lidar that nothing is said about would pass";
  EXPECT_TRUE(judge(wrong[0]).is_problem) << judge(wrong[0]).text;
  EXPECT_LT(wrong[0].earlier, 0.0);
}

TEST(ScanStampCheck, SaysWhatItFound) {
  EXPECT_TRUE(judge({"velodyne/points", 9, 0.2, 0.01, -0.1, 0.01}).is_problem);
  EXPECT_NE(judge({"velodyne/points", 9, 0.2, 0.01, -0.1, 0.01}).text.find("mark the start"),
            std::string::npos);
  EXPECT_NE(judge({"velodyne/points", 9, -0.2, 0.01, 0.1, 0.01}).text.find("mark the end"),
            std::string::npos);
  EXPECT_FALSE(judge({"velodyne/points", 9, -0.01, 0.01, 0.1, 0.01}).is_problem);
  EXPECT_NE(judge({"velodyne/points", 9, -0.01, 0.01, 0.1, 0.01}).text.find("does not tell"),
            std::string::npos);
}

}  // namespace
}  // namespace atlas_loader
