// SPDX-License-Identifier: MIT
// Whole KITTI raw drives: several layouts, with and without stamps, spoiled ones.
#include "record/kitti_reader.hpp"

#include <gtest/gtest.h>

#include "drained.hpp"
#include "record/kitti_rows.hpp"
#include "small_kitti.hpp"

namespace atlas::record {
namespace {

using test::Drained;
using test::kittiName;
using test::readRecord;

constexpr Stamp kFirst = 1'317'046'775'100'000'000;  // OXTS frame 0

class KittiDrive : public ::testing::Test {
 protected:
  void SetUp() override { test::writeSmallKitti(folder_); }
  test::TemporaryFolder folder_;
};

TEST_F(KittiDrive, EveryFileOfEveryFrameIsRead) {
  const Drained d = readRecord(folder_.path());
  for (const char* topic : {"imu/data", "gnss/fix", "gnss/heading", "velodyne/points",
                            "image_02/image_raw/compressed", "image_02/camera_info"})
    EXPECT_EQ(d.of(topic).size(), 10U) << topic;
  EXPECT_EQ(d.of("tf_static").size(), 1U);
  EXPECT_EQ(d.events.front().stream, 0U) << "the places of the sensors come first";
  EXPECT_EQ(d.report.size(), 4U) << "oxts/timestamps.txt and three data folders";
  for (const auto& [name, file] : d.report) EXPECT_EQ(file.used, 10U) << name;
  EXPECT_EQ(d.payloads<ImuSample>("imu/data").at(3).stamp, kFirst + 300 * kMillisecond);
}

TEST_F(KittiDrive, FrameTimesComeFromOxtsWhenThereAreNoOthers) {
  const Drained d = readRecord(folder_.path());
  const auto pictures = d.payloads<ImagePtr>("image_02/image_raw/compressed");
  EXPECT_EQ(pictures.at(2)->stamp, kFirst + 200 * kMillisecond - 17 * kMillisecond);
  EXPECT_EQ(pictures.at(2)->frame, "image_02");
  // The sweep's stamp is its end, half a revolution after the moment at which it looks forward.
  const auto sweeps = d.payloads<SweepPtr>("velodyne/points");
  EXPECT_EQ(sweeps.at(2)->stamp, kFirst + 200 * kMillisecond - 17 * kMillisecond + 51'780'000);
  EXPECT_TRUE(d.notesSay("image_02: no timestamps.txt"));
}

TEST_F(KittiDrive, OwnStampsOfTheVelodyneAndItsMeasuredPeriod) {
  std::string forward, start, end;
  for (int i = 0; i < 10; ++i) {
    forward += test::kittiStamp(35.09 + 0.1 * i);
    start += test::kittiStamp(35.09 + 0.1 * i - 0.051);
    end += test::kittiStamp(35.09 + 0.1 * i + 0.051);
  }
  folder_.write("velodyne_points/timestamps.txt", forward);
  folder_.write("velodyne_points/timestamps_start.txt", start);
  folder_.write("velodyne_points/timestamps_end.txt", end);
  const Drained d = readRecord(folder_.path());
  const auto sweeps = d.payloads<SweepPtr>("velodyne/points");
  const Stamp looks_forward = kFirst - 10 * kMillisecond;
  EXPECT_NEAR(static_cast<double>(sweeps.at(0)->stamp - looks_forward), 51e6, 2);
  EXPECT_NEAR(sweeps.at(0)->points.at(0).time, -0.051, 1e-5);
  EXPECT_EQ(d.payloads<ImagePtr>("image_02/image_raw/compressed").at(0)->stamp, looks_forward)
      << "the lidar triggers the cameras";
  EXPECT_EQ(d.report.at("velodyne_points/timestamps.txt").used, 10U);
  EXPECT_EQ(d.report.at("velodyne_points/timestamps_end.txt").used, 10U);
}

TEST_F(KittiDrive, OwnStampsOfTheCamera) {
  std::string stamps;
  for (int i = 0; i < 12; ++i) stamps += test::kittiStamp(36.0 + 0.1 * i);
  folder_.write("image_02/timestamps.txt", stamps);
  const Drained d = readRecord(folder_.path());
  EXPECT_EQ(d.payloads<ImagePtr>("image_02/image_raw/compressed").at(0)->stamp, kFirst + 900 * kMillisecond);
  EXPECT_EQ(d.skipped("image_02/data", "file missing"), 2U) << "two stamps more than pictures";
  EXPECT_EQ(d.of("image_02/camera_info").size(), 10U) << "one for each picture";
}

TEST_F(KittiDrive, ImagesAsPixels) {
  RecordOptions options;
  options.images = RecordOptions::Images::kPixels;
  const Drained d = readRecord(folder_.path(), options);
  const auto pictures = d.payloads<ImagePtr>("image_02/image_raw");
  ASSERT_EQ(pictures.size(), 10U);
  EXPECT_EQ(pictures[0]->pixels.at<cv::Vec3b>(1, 1), cv::Vec3b(10, 200, 90));
}

TEST_F(KittiDrive, SpanAndTopics) {
  RecordOptions options;
  options.start_s = 0.25;
  options.duration_s = 0.3;
  options.topics = {"imu/data", "/velodyne/points"};
  const Drained d = readRecord(folder_.path(), options);
  // The record begins with frame 0 of the pictures, 17 ms before OXTS; [0.25, 0.55) s after it.
  EXPECT_EQ(d.of("imu/data").size(), 3U);
  EXPECT_EQ(d.of("velodyne/points").size(), 3U);
  EXPECT_FALSE(d.hasStream("gnss/fix"));
  EXPECT_FALSE(d.hasStream("image_02/camera_info"));
  EXPECT_EQ(d.skipped("oxts/data", "outside the requested time span"), 7U);
}

TEST_F(KittiDrive, OneTopicOnlyStillBooksItsFiles) {
  for (const char* topic :
       {"image_02/camera_info", "image_02/image_raw/compressed", "velodyne/points", "gnss/heading"}) {
    RecordOptions options;
    options.topics = {topic};
    const Drained d = readRecord(folder_.path(), options);
    EXPECT_EQ(d.of(topic).size(), 10U) << topic;
    EXPECT_EQ(d.report.at("oxts/timestamps.txt").used, 10U) << "they give the time of the frames";
  }
  RecordOptions options;
  options.topics = {"camera_ir/packets"};
  EXPECT_TRUE(readRecord(folder_.path(), options).notesSay("topic 'camera_ir/packets' was asked for"));
}

TEST_F(KittiDrive, LatenciesMoveTheStreamsAgainstEachOther) {
  RecordOptions options;
  options.imu_latency_s = 0.25;
  options.gnss_latency_s = -0.1;
  options.lidar_latency_s = 0.02;
  const Drained d = readRecord(folder_.path(), options);
  EXPECT_EQ(d.payloads<ImuSample>("imu/data").at(0).stamp, kFirst - 250 * kMillisecond);
  EXPECT_EQ(d.payloads<GnssFix>("gnss/fix").at(0).stamp, kFirst + 100 * kMillisecond);
  EXPECT_EQ(d.payloads<SweepPtr>("velodyne/points").at(0)->stamp,
            kFirst - 17'000'000 + 51'780'000 - 20'000'000);
}

TEST_F(KittiDrive, SpoiledFilesAreCountedSkips) {
  folder_.write("oxts/data/" + kittiName(1, ".txt"), "49 8 nonsense");
  folder_.write("oxts/data/" + kittiName(2, ".txt"), "");
  folder_.remove("oxts/data/" + kittiName(3, ".txt"));
  folder_.write("oxts/data/" + kittiName(77, ".txt"), test::oxtsText(0));
  folder_.write("velodyne_points/data/" + kittiName(4, ".bin"), "seventeen bytes..");
  folder_.remove("velodyne_points/data/" + kittiName(5, ".bin"));
  const std::string png = folder_.read("image_02/data/" + kittiName(6, ".png"));
  folder_.write("image_02/data/" + kittiName(6, ".png"), png.substr(0, png.size() / 2));
  const Drained d = readRecord(folder_.path());
  EXPECT_EQ(d.of("imu/data").size(), 7U);
  EXPECT_EQ(d.skipped("oxts/data", "too few fields"), 1U);
  EXPECT_EQ(d.skipped("oxts/data", "file empty"), 1U);
  EXPECT_EQ(d.skipped("oxts/data", "file missing"), 1U);
  EXPECT_EQ(d.skipped("oxts/data", "no stamp for this frame"), 1U);
  EXPECT_EQ(d.skipped("velodyne_points/data", "not a whole number of points of 16 bytes"), 1U);
  EXPECT_EQ(d.skipped("image_02/data", "picture damaged"), 1U);
  const auto sweeps = d.payloads<SweepPtr>("velodyne/points");
  ASSERT_EQ(sweeps.size(), 9U) << "frame 5 has neither file nor stamp";
  EXPECT_TRUE(sweeps.at(4)->points.empty()) << "a damaged scan is an empty sweep";
  EXPECT_EQ(d.of("image_02/image_raw/compressed").size(), 9U);
}

TEST_F(KittiDrive, SamePictureTwiceIsBooked) {
  folder_.write("image_02/data/" + kittiName(3, ".jpg"), "?");
  EXPECT_EQ(readRecord(folder_.path()).skipped("image_02/data", "frame is there twice"), 1U);
}

TEST_F(KittiDrive, StampsBackAndOutliers) {
  std::string stamps;
  for (int i = 0; i < 10; ++i) stamps += i == 7 ? "1999-09-26 14:19:35\n" : test::kittiStamp(36.0 - 0.1 * i);
  folder_.write("oxts/timestamps.txt", stamps);
  const Drained d = readRecord(folder_.path());
  EXPECT_EQ(d.of("imu/data").size(), 9U) << "sorted by stamp";
  EXPECT_EQ(d.report.at("oxts/timestamps.txt").used, 9U);
  EXPECT_EQ(d.skipped("oxts/data", "no stamp for this frame"), 1U);
}

TEST_F(KittiDrive, WithoutCalibrationOrSensors) {
  folder_.remove("calib");
  folder_.remove("velodyne_points");
  const Drained d = readRecord(folder_.path());
  EXPECT_TRUE(d.notesSay("calibration: no calib_*.txt found"));
  EXPECT_TRUE(d.notesSay("velodyne_points: missing"));
  EXPECT_FALSE(d.hasStream("image_02/camera_info"));
  EXPECT_EQ(d.of("image_02/image_raw/compressed").size(), 10U);
}

TEST_F(KittiDrive, PicturesOfAnotherSizeThanTheCalibrationAreNoted) {
  EXPECT_TRUE(
      readRecord(folder_.path()).notesSay("image_02: pictures are 20x10, calibration is for 1242x375"));
}

TEST_F(KittiDrive, UnusableCalibrationIsRefused) {
  folder_.write("calib/calib_velo_to_cam.txt", "R: 1 0 0\nT: 0 0 0\n");
  EXPECT_THROW(readRecord(folder_.path()), std::runtime_error);
}

TEST(KittiReader, WhatIsNoRecordIsRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(openRecord(folder.path(), {}), std::invalid_argument);
  EXPECT_THROW(openRecord(folder / "missing", {}), std::invalid_argument);
  try {
    openRecord(folder / "missing", {});
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("missing"), std::string::npos);
  }
}

}  // namespace
}  // namespace atlas::record
