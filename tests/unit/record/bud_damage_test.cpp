// SPDX-License-Identifier: MIT
// What a spoiled file does to a record of the Brno Urban Dataset: each row is booked, nothing throws but
// calibration.
#include <gtest/gtest.h>

#include "bud_record.hpp"
#include "record/bud_reader.hpp"

namespace atlas::record {
namespace {

using test::Drained;
using test::kBegin;
using test::readRecord;

TEST_F(BudRecord, CorruptZipGivesEmptySweepsAndSaysSo) {
  for (int i = 0; i < 10; ++i) folder_.remove("lidar_left/" + test::scanName(i));
  folder_.write("lidar_left/scans.zip", std::string(5000, 'z'));
  const Drained d = readRecord(folder_.path());
  EXPECT_EQ(d.of("lidar_left/points").size(), 10U) << "indices stay aligned";
  EXPECT_EQ(d.skipped("lidar_left/scans.zip", "scan missing"), 10U);
  EXPECT_TRUE(d.notesSay("lidar_left/scans.zip: "));
}

TEST_F(BudRecord, ScansThatFitNoRowAndRowsWithoutScan) {
  folder_.remove("lidar_left/" + test::scanName(4));
  folder_.write("lidar_left/" + test::scanName(5), "no pcd");
  folder_.write("lidar_left/" + test::scanName(6), test::pcdText({}));
  folder_.write("lidar_left/" + test::scanName(99), test::pcdText(test::revolution(2)));
  const Drained d = readRecord(folder_.path());
  const std::string name = "lidar_left/scan*.pcd";
  EXPECT_EQ(d.skipped(name, "scan missing"), 1U);
  EXPECT_EQ(d.skipped(name, "no PCD header"), 1U);
  EXPECT_EQ(d.skipped(name, "scan without points"), 1U);
  EXPECT_EQ(d.skipped(name, "no row in timestamps.txt"), 1U);
  EXPECT_EQ(d.report.at(name).used, 7U);
  EXPECT_TRUE(d.payloads<SweepPtr>("lidar_left/points").at(4)->points.empty());
}

TEST_F(BudRecord, ScanOfAnotherLayoutIsReadAndNoted) {
  auto points = test::revolution(60);
  points.resize(1000);
  folder_.write("lidar_left/" + test::scanName(2), test::pcdText(points));
  const Drained d = readRecord(folder_.path());
  EXPECT_EQ(d.payloads<SweepPtr>("lidar_left/points").at(2)->points.size(), 1000U);
  EXPECT_TRUE(d.notesSay("layout of scans unknown: point time linear"));
}

TEST_F(BudRecord, InnerClockIsRepairedAndReported) {
  std::string text;
  for (int i = 0; i < 10; ++i) {
    const Stamp stamp = kBegin + i * 100 * kMillisecond;
    text += test::stampText(stamp) + "," + std::to_string(i) + ", " +
            std::to_string(test::innerTime(stamp - 477'000, i == 4 ? 1 : 0)) + "\r\n";
  }
  folder_.write("lidar_left/timestamps.txt", text);
  const Drained d = readRecord(folder_.path());
  EXPECT_TRUE(
      d.notesSay("system stamp minus lidar clock 0.477 ms (median of 10), 1 times off by 1 s repaired"));
  const auto times = d.payloads<TimeReference>("lidar_left/time");
  EXPECT_EQ(times.at(4).stamp - times.at(4).sensor_time, 477'000);
  EXPECT_FLOAT_EQ(d.payloads<SweepPtr>("lidar_left/points").at(5)->points[0].time, -0.1F)
      << "a wrong second is no revolution of 1.1 s";
}

TEST_F(BudRecord, MixedLineEndsEmptyFilesAndShortRows) {
  std::string imu = lines("imu/imu.txt");
  imu.erase(std::remove(imu.begin(), imu.end(), '\r'), imu.end());
  folder_.write("imu/imu.txt", imu + "1568186746400000000, 1, 2\n\n\r\n");
  folder_.write("imu/gnss.txt", "\r\n");
  folder_.write("imu/mag.txt", "");
  const Drained d = readRecord(folder_.path());
  EXPECT_EQ(d.of("imu/data").size(), 400U);
  EXPECT_EQ(d.skipped("imu/imu.txt", "too few fields"), 1U);
  EXPECT_TRUE(d.notesSay("imu/gnss.txt: empty"));
  EXPECT_TRUE(d.notesSay("imu/mag.txt: empty"));
}

TEST_F(BudRecord, GarbledRowsAndNan) {
  std::string imu = lines("imu/imu.txt");
  imu.replace(imu.find(",", 200), 1, ";");
  folder_.write("imu/imu.txt", imu + "1568186746400000000, nan, 0, -9.8, 0, 0, 0, 0, 0, 0, 1\r\n");
  const Drained d = readRecord(folder_.path());
  const FileReport& report = d.report.at("imu/imu.txt");
  EXPECT_EQ(report.rows, 401U);
  EXPECT_EQ(report.used, 399U);
  ASSERT_EQ(report.examples.size(), 2U);
  EXPECT_EQ(report.examples[1], "imu/imu.txt:401: field 2 (ax): not finite: 'nan'");
}

TEST_F(BudRecord, GnssFilesOfDifferentLength) {
  folder_.write("gnss/pose.txt", test::poseText(7));
  const Drained d = readRecord(folder_.path());
  EXPECT_EQ(d.of("gnss/fix").size(), 7U);
  EXPECT_EQ(d.of("gnss/time").size(), 20U);
}

TEST_F(BudRecord, LessFramesThanRowsAndLessRowsThanFrames) {
  test::addCameras(folder_, 10);
  test::writeGreyVideo(folder_ / "camera_ir/video.mp4", 8);
  test::writeRgbVideo(folder_ / "camera_left_front/video.mp4", 12, {1, 2, 3});
  const Drained d = readRecord(folder_.path());
  EXPECT_EQ(d.of("camera_ir/packets").size(), 8U);
  EXPECT_EQ(d.of("camera_ir/temperature_range").size(), 8U) << "the smaller number counts";
  EXPECT_EQ(d.skipped("camera_ir/timestamps.txt", "the video has no such frame"), 2U);
  EXPECT_TRUE(d.notesSay("camera_ir: video has 8 frames, timestamps.txt 10 rows"));
  EXPECT_EQ(d.report.at("camera_left_front/video.mp4").used, 10U);
  EXPECT_EQ(d.skipped("camera_left_front/video.mp4", "no row in timestamps.txt"), 2U);
}

TEST_F(BudRecord, UnreadableOrMissingVideoIsBookedPictureByPicture) {
  test::addCameras(folder_, 10);
  const std::string video = lines("camera_ir/video.mp4");
  folder_.write("camera_ir/video.mp4", video.substr(0, video.size() / 2));
  folder_.remove("camera_left_front/video.mp4");
  const Drained d = readRecord(folder_.path());
  EXPECT_EQ(d.skipped("camera_ir/video.mp4", "video unreadable"), 10U);
  EXPECT_EQ(d.skipped("camera_left_front/video.mp4", "no video.mp4"), 10U);
  EXPECT_EQ(d.of("camera_ir/temperature_range").size(), 10U);
  EXPECT_TRUE(d.notesSay("camera_ir/video.mp4: no pictures: "));
}

TEST_F(BudRecord, DetectionsOfACameraThatIsNotThere) {
  folder_.write("yolo/camera_right_side.txt", "0, 0.5, 0.5, 0.1, 0.1, 0.9, 2\n");
  EXPECT_EQ(
      readRecord(folder_.path()).skipped("yolo/camera_right_side.txt", "the camera has no timestamps.txt"),
      1U);
}

TEST_F(BudRecord, WhatIsMissingAndWhatIsNotReadIsSaid) {
  folder_.write("lidar_left/notes.txt", "?");
  folder_.write("lidar_left/scans/scan000000.pcd", "?");
  folder_.write("stuff/a", "?");
  folder_.write("imu/imu.csv", "?");
  const Drained d = readRecord(folder_.path());
  EXPECT_TRUE(d.notesSay("not in this record: lidar_right, camera_left_front")) << d.allNotes();
  EXPECT_TRUE(d.notesSay("not part of the format, ignored: stuff"));
  EXPECT_TRUE(d.notesSay("imu/: not part of the format, ignored: imu.csv"));
  EXPECT_TRUE(d.notesSay("lidar_left/: not part of the format, ignored: notes.txt"));
  EXPECT_TRUE(d.notesSay("lidar_left: scans in several places"));
}

TEST_F(BudRecord, UnusableCalibrationIsRefusedByName) {
  folder_.write("calibrations/frames.yaml", "lidar_left:\n  trans: [0, 0, x]\n  rot: [0, 0, 0, 1]\n");
  try {
    readRecord(folder_.path());
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("frames.yaml:2: field lidar_left.trans: not a number: 'x'"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(BudRecord, StampsGoingBackAreSortedOrCounted) {
  std::string imu = lines("imu/imu.txt");
  const std::size_t second = imu.find('\n') + 1, third = imu.find('\n', second) + 1;
  const std::string row = imu.substr(second, third - second);
  imu.erase(second, third - second);
  folder_.write("imu/imu.txt", imu + row);  // the second row is the last one
  const Drained d = readRecord(folder_.path());
  EXPECT_EQ(d.of("imu/data").size(), 400U);
  EXPECT_TRUE(d.notesSay("imu/imu.txt: 1 rows out of order, sorted by stamp"));
}

TEST(BudReader, OneSensorIsARecord) {
  const test::TemporaryFolder folder;
  folder.write("camera_ir/timestamps.txt", "1568186745426675402,0,-29.65,20.74\r\n");
  ASSERT_TRUE(isBudRecord(folder.path()));
  const Drained d = readRecord(folder.path());
  EXPECT_EQ(d.of("camera_ir/temperature_range").size(), 1U);
  EXPECT_TRUE(d.notesSay("camera_ir: no video.mp4"));
}

TEST(BudReader, FoldersWhereFilesShouldBe) {
  const test::TemporaryFolder folder;
  folder.write("imu/imu.txt/x", "");
  folder.write("camera_ir/timestamps.txt/x", "");
  folder.write("camera_ir/video.mp4/x", "");
  folder.write("lidar_left/timestamps.txt", test::lidarTimesText(2));
  folder.write("lidar_left/scans.zip/x", "");
  folder.write("yolo/camera_ir.txt/x", "");
  const Drained d = readRecord(folder.path());
  EXPECT_TRUE(d.notesSay("imu/imu.txt: cannot be opened"));
  EXPECT_EQ(d.of("lidar_left/points").size(), 2U);
}

}  // namespace
}  // namespace atlas::record
