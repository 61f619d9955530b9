// SPDX-License-Identifier: MIT
// Whole records of the Brno Urban Dataset: every stream, options, where calibration and scans come from.
#include "record/bud_reader.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "bud_record.hpp"
#include "small_zip.hpp"

namespace atlas::record {
namespace {

using test::Drained;
using test::kBegin;
using test::readRecord;

TEST_F(BudRecord, EveryRowOfEveryFileIsRead) {
  test::addCameras(folder_, 10);
  const Drained d = readRecord(folder_.path());
  const std::map<std::string, std::size_t> expected = {{"imu/data", 400},
                                                       {"imu/mag", 100},
                                                       {"imu/pressure", 50},
                                                       {"imu/temperature", 400},
                                                       {"imu/time", 400},
                                                       {"imu/gnss/fix", 50},
                                                       {"gnss/fix", 20},
                                                       {"gnss/heading", 16},
                                                       {"gnss/time", 20},
                                                       {"lidar_left/points", 10},
                                                       {"lidar_left/time", 10},
                                                       {"radar_ti/scan", 5},
                                                       {"camera_ir/packets", 10},
                                                       {"camera_ir/temperature_range", 10},
                                                       {"camera_left_front/packets", 10},
                                                       {"camera_left_front/detections", 10},
                                                       {"tf_static", 1}};
  for (const auto& [topic, count] : expected) EXPECT_EQ(d.of(topic).size(), count) << topic;
  EXPECT_EQ(d.streams.size(), expected.size());
  for (const auto& [name, file] : d.report) {
    if (name != "imu/d_quat.txt") {
      EXPECT_EQ(file.used, file.rows) << name;
    }
  }
  EXPECT_EQ(d.report.at("imu/d_quat.txt").skipped.at("not converted: imu/data carries the orientation"),
            400U);
  EXPECT_TRUE(d.notesSay("imu: acceleration sign inverted, corrected"));
  EXPECT_NEAR(d.payloads<ImuSample>("imu/data").at(5).linear_acceleration_mps2.z(), 9.81, 1e-9);
  EXPECT_TRUE(d.notesSay("gnss/pose.txt: 4 rows with azimuth 0"));
  EXPECT_EQ(d.span.first, kBegin);
}

TEST_F(BudRecord, SweepsHaveTimeAndRing) {
  const auto sweeps = readRecord(folder_.path()).payloads<SweepPtr>("lidar_left/points");
  ASSERT_EQ(sweeps.size(), 10U);
  const Sweep& sweep = *sweeps[3];
  EXPECT_EQ(sweep.frame, "lidar_left");
  EXPECT_EQ(sweep.stamp, kBegin + 300 * kMillisecond);
  ASSERT_EQ(sweep.points.size(), 60U * 32);
  EXPECT_FLOAT_EQ(sweep.points[0].time, -0.1F);
  EXPECT_NEAR(sweep.points.back().time, -0.1 / 60, 1e-6);
  EXPECT_EQ(sweep.points[5].ring, 5);
  EXPECT_TRUE(std::isnan(sweep.points[14].x)) << "the dead laser";
}

TEST_F(BudRecord, ScansComeFromAZipInPlace) {
  std::vector<std::pair<std::string, std::string>> members;
  for (int i = 0; i < 10; ++i) {
    members.emplace_back(test::scanName(i), lines("lidar_left/" + test::scanName(i)));
    folder_.remove("lidar_left/" + test::scanName(i));
  }
  test::writeZip(folder_ / "lidar_left/scans.zip", members);
  const Drained d = readRecord(folder_.path());
  EXPECT_EQ(d.report.at("lidar_left/scans.zip").used, 10U);
  for (const auto& sweep : d.payloads<SweepPtr>("lidar_left/points"))
    EXPECT_EQ(sweep->points.size(), 60U * 32);
}

TEST_F(BudRecord, LidarCenterHasTwoColumnsAndNoRings) {
  folder_.write("lidar_center/timestamps.txt",
                test::rows(3, 100 * kMillisecond, [](int i) { return "," + std::to_string(i); }));
  for (int i = 0; i < 3; ++i)
    folder_.write("lidar_center/scans/" + test::scanName(i), test::pcdText(test::revolution(10)));
  const Drained d = readRecord(folder_.path());
  const auto sweeps = d.payloads<SweepPtr>("lidar_center/points");
  ASSERT_EQ(sweeps.size(), 3U);
  EXPECT_EQ(sweeps[1]->points[33].ring, 0);
  EXPECT_NEAR(sweeps[1]->points[1].time - sweeps[1]->points[0].time, 0.1 / 320, 1e-6)
      << "linear in the file's order";
  EXPECT_TRUE(d.of("lidar_center/time").empty());
  EXPECT_EQ(d.report.at("lidar_center/scans").used, 3U);
}

TEST_F(BudRecord, CorrectAccelerationIsKept) {
  folder_.write("imu/imu.txt", test::imuText(400, +9.81));
  const Drained d = readRecord(folder_.path());
  EXPECT_NEAR(d.payloads<ImuSample>("imu/data").at(0).linear_acceleration_mps2.z(), 9.81, 1e-9);
  EXPECT_TRUE(d.notesSay("acceleration points up at rest, kept"));
}

TEST_F(BudRecord, DetectionsAnswerEveryFrame) {
  test::addCameras(folder_, 10);
  const auto detections = readRecord(folder_.path()).payloads<Detections>("camera_left_front/detections");
  ASSERT_EQ(detections.size(), 10U);
  EXPECT_TRUE(detections[0].boxes.empty());
  ASSERT_EQ(detections[2].boxes.size(), 2U);
  EXPECT_EQ(detections[2].image_index, 2U);
  EXPECT_NEAR(detections[2].boxes[0].x_min, 0.4 * test::kVideoWidth - 0.5, 1e-9)
      << "size of the picture, not of a calibration";
}

TEST_F(BudRecord, ImagesAsPixelsAndAsJpeg) {
  test::addCameras(folder_, 10);
  RecordOptions options;
  options.images = RecordOptions::Images::kPixels;
  const auto grey = readRecord(folder_.path(), options).payloads<ImagePtr>("camera_ir/image_raw");
  ASSERT_EQ(grey.size(), 10U);
  EXPECT_EQ(grey[4]->format, "mono8");
  EXPECT_NEAR(cv::mean(grey[4]->pixels)[0], test::greyOfFrame(4), 3);
  options.images = RecordOptions::Images::kEncoded;
  EXPECT_EQ(
      readRecord(folder_.path(), options).payloads<ImagePtr>("camera_left_front/image_raw/compressed").size(),
      10U);
}

TEST_F(BudRecord, TopicsAndSpan) {
  test::addCameras(folder_, 10);
  RecordOptions options;
  options.topics = {"imu/data", "/camera_ir/packets"};
  options.start_s = 0.35;
  options.duration_s = 0.5;
  const Drained d = readRecord(folder_.path(), options);
  EXPECT_EQ(d.of("imu/data").size(), 200U) << "half-open: 0.5 s at 400 Hz";
  // Frames 4 .. 8 and at least the four packets before them, without which they cannot be decoded.
  EXPECT_GE(d.of("camera_ir/packets").size(), 9U);
  EXPECT_EQ(d.report.at("camera_ir/video.mp4").used, 5U);
  for (const Event& event : d.events) EXPECT_GE(event.stamp, kBegin + 350 * kMillisecond);
  EXPECT_EQ(d.streams.size(), 3U);
  EXPECT_EQ(d.report.size(), 3U)
      << "files of other topics are not opened: imu.txt, timestamps.txt, video.mp4";
}

TEST_F(BudRecord, EachTopicAloneBooksItsFiles) {
  test::addCameras(folder_, 10);
  const Drained whole = readRecord(folder_.path());
  for (const StreamInfo& stream : whole.streams) {
    if (stream.topic == "tf_static") continue;  // comes along with any other
    RecordOptions options;
    options.topics = {stream.topic};
    const Drained alone = readRecord(folder_.path(), options);
    EXPECT_EQ(alone.of(stream.topic).size(), whole.of(stream.topic).size()) << stream.topic;
  }
}

TEST_F(BudRecord, SpanBeyondTheRecordIsEmptyButBooked) {
  test::addCameras(folder_, 10);
  RecordOptions options;
  options.start_s = 1000;
  const Drained d = readRecord(folder_.path(), options);
  EXPECT_TRUE(d.events.empty());
  EXPECT_EQ(d.skipped("imu/imu.txt", "outside the requested time span"), 400U);
}

TEST_F(BudRecord, LatenciesMoveTheStreams) {
  RecordOptions options;
  options.imu_latency_s = 0.0041;
  options.gnss_latency_s = 0.0082;
  options.lidar_latency_s = 0.0005;
  const Drained d = readRecord(folder_.path(), options);
  EXPECT_EQ(d.payloads<ImuSample>("imu/data").at(0).stamp, kBegin - 4'100'000);
  EXPECT_EQ(d.payloads<GnssFix>("gnss/fix").at(0).stamp, kBegin - 8'200'000);
  EXPECT_EQ(d.payloads<GnssHeading>("gnss/heading").at(0).stamp, kBegin - 8'200'000);
  EXPECT_EQ(d.payloads<SweepPtr>("lidar_left/points").at(0)->stamp, kBegin - 500'000);
}

TEST_F(BudRecord, CalibrationOfTheRecordThenOfTheOptionThenThePackagedOne) {
  const auto frames = [](double x) {
    return "imu:\n  trans: [0, 0, 0]\n  rot: [0, 0, 0, 1]\nlidar_left:\n  trans: [" + std::to_string(x) +
           ", 0, 0]\n  rot: [0, 0, 0, 1]\n";
  };
  const test::TemporaryFolder given, packaged;
  packaged.write("frames.yaml", frames(3));
  const auto place = [&](const RecordOptions& options) {
    const Drained d = readRecord(folder_.path(), options);
    const auto rig = d.payloads<StaticTransforms>("tf_static").at(0);
    for (const StaticTransform& t : rig.transforms) {
      if (t.child == "lidar_left") return t.T_parent_child.translation.x();
    }
    return 0.0;
  };
  RecordOptions options;
  EXPECT_EQ(place(options), 0.0);
  options.packaged_rig_dir = packaged.path().string();
  EXPECT_EQ(place(options), 3.0);
  options.calibration_dir = given.path().string();
  EXPECT_THROW(readRecord(folder_.path(), options), std::invalid_argument)
      << "named, but without calibration";
  given.write("frames.yaml", frames(2));
  EXPECT_EQ(place(options), 2.0);
  folder_.write("calibrations/clone.sh", "only a script");
  EXPECT_EQ(place(options), 2.0);
  folder_.write("calibrations/Brno-Urban-Dataset-Calibrations/frames.yaml", frames(1));
  EXPECT_EQ(place(options), 1.0);
  EXPECT_TRUE(readRecord(folder_.path(), options).notesSay("frames.yaml has no frame 'gnss_rear'"));
}

TEST(RecordOptions, AreValidated) {
  RecordOptions options;
  EXPECT_NO_THROW(validate(options));
  options.start_s = -1;
  try {
    validate(options);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("start_s must be >= 0, got -1"), std::string::npos);
  }
  options = {};
  options.imu_latency_s = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(validate(options), std::invalid_argument);
}

}  // namespace
}  // namespace atlas::record
