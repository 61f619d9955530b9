// SPDX-License-Identifier: MIT
// Real recordings below $ATLAS_DATA: read completely, every row of every file accounted for.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "drained.hpp"
#include "record/text_rows.hpp"
#include "temporary_folder.hpp"

namespace atlas::record {
namespace {

using test::Drained;
namespace fs = std::filesystem;

class RealData : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* folder = std::getenv("ATLAS_DATA");
    if (folder == nullptr || !fs::is_directory(folder)) GTEST_SKIP() << "ATLAS_DATA is not set";
    data_ = folder;
  }
  [[nodiscard]] Drained read(const std::string& name, RecordOptions options = {}) const {
    if (!fs::is_directory(data_ / name)) return {};
    options.calibration_dir = name.rfind("bud", 0) == 0 ? (data_ / "bud_calibrations").string() : "";
    return test::readRecord(data_ / name, options);
  }
  fs::path data_;
};

/// Rows of a text file, counted without the reader.
std::uint64_t rowsOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  std::uint64_t rows = 0;
  while (std::getline(file, line)) rows += line.find_first_not_of(" \t\r") != std::string::npos ? 1 : 0;
  return rows;
}

TEST_F(RealData, BudSnippetIsReadCompletely) {
  const Drained d = read("bud_snippet");
  ASSERT_FALSE(d.streams.empty());
  std::set<std::string> text_files;
  for (const auto& entry : fs::recursive_directory_iterator(data_ / "bud_snippet")) {
    const std::string name = fs::relative(entry.path(), data_ / "bud_snippet").string();
    if (entry.path().extension() != ".txt" || entry.path().parent_path() == data_ / "bud_snippet") continue;
    text_files.insert(name);
    ASSERT_EQ(d.report.count(name), 1U) << name << " is not in the report";
    EXPECT_EQ(d.report.at(name).rows, rowsOf(entry.path())) << name;
    if (name != "imu/d_quat.txt") {
      EXPECT_EQ(d.report.at(name).used, d.report.at(name).rows) << name;
    }
  }
  EXPECT_EQ(text_files.size(), 13U);
  for (const char* video : {"camera_left_front/video.mp4", "camera_ir/video.mp4"})
    EXPECT_EQ(d.report.at(video).used, 500U);
  EXPECT_EQ(d.skipped("lidar_left/scans", "scan missing"), 500U) << "the snippet has no scans";
}

TEST_F(RealData, BudSnippetSaysWhatIsKnownAboutIt) {
  const Drained d = read("bud_snippet");
  ASSERT_FALSE(d.streams.empty());
  EXPECT_TRUE(d.notesSay("imu: acceleration sign inverted, corrected (median vertical component -9.7"));
  EXPECT_TRUE(
      d.notesSay("system stamp minus lidar clock 0.477 ms (median of 500), 3 times off by 1 s repaired"));
  EXPECT_TRUE(d.notesSay("gnss/pose.txt: 23 rows with azimuth 0"));
  EXPECT_TRUE(d.notesSay("imu/time.txt: system stamp minus the sensor's UTC 4.134 ms (median of 499)"))
      << d.allNotes();
  EXPECT_TRUE(d.notesSay("gnss/time.txt: system stamp minus the sensor's UTC 8.197 ms (median of 500)"));
  EXPECT_TRUE(d.notesSay("yolo/camera_left_front.txt: layout of 8 columns, boxes by their top-left corner"));
  EXPECT_EQ(d.of("gnss/heading").size(), 477U);
  std::size_t boxes = 0;
  for (const auto& detections : d.payloads<Detections>("camera_left_front/detections"))
    boxes += detections.boxes.size();
  EXPECT_EQ(boxes, 500U);
  for (const auto& sample : d.payloads<ImuSample>("imu/data")) ASSERT_TRUE(sample.orientation);
}

TEST_F(RealData, BudVideosDecodeToAsManyPictures) {
  RecordOptions options;
  options.topics = {"camera_ir/image_raw"};
  options.images = RecordOptions::Images::kPixels;
  const Drained d = read("bud_snippet", options);
  ASSERT_FALSE(d.streams.empty());
  const auto images = d.payloads<ImagePtr>("camera_ir/image_raw");
  EXPECT_EQ(images.size(), 500U);
  EXPECT_EQ(images.at(0)->pixels.size(), cv::Size(640, 512));
}

TEST_F(RealData, BudCalibrationHasAllSensors) {
  const Drained d = read("bud_snippet");
  ASSERT_FALSE(d.streams.empty());
  const auto rig = d.payloads<StaticTransforms>("tf_static").at(0);
  std::set<std::string> frames;
  for (const StaticTransform& t : rig.transforms) frames.insert(t.child);
  for (const char* frame :
       {"imu", "lidar_left", "lidar_right", "lidar_center", "camera_left_front", "camera_left_side",
        "camera_right_front", "camera_right_side", "camera_ir", "gnss_front", "gnss_rear", "radar_ti"})
    EXPECT_EQ(frames.count(frame), 1U) << frame;
  EXPECT_EQ(d.payloads<CameraInfo>("camera_ir/camera_info").at(0).width, 640U);
}

struct KittiCase {
  const char* folder;
  std::size_t oxts, sweeps, left, right;
};
class RealKitti : public RealData, public ::testing::WithParamInterface<KittiCase> {};

TEST_P(RealKitti, DriveIsReadCompletely) {
  const KittiCase expected = GetParam();
  const Drained d = read(expected.folder);
  ASSERT_FALSE(d.streams.empty());
  EXPECT_EQ(d.of("imu/data").size(), expected.oxts);
  EXPECT_EQ(d.of("gnss/fix").size(), expected.oxts);
  EXPECT_EQ(d.of("gnss/heading").size(), expected.oxts);
  EXPECT_EQ(d.of("velodyne/points").size(), expected.sweeps);
  EXPECT_EQ(d.of("image_02/image_raw/compressed").size(), expected.left);
  EXPECT_EQ(d.of("image_02/camera_info").size(), expected.left);
  EXPECT_EQ(d.of("image_03/image_raw/compressed").size(), expected.right);
  for (const auto& [name, file] : d.report)
    EXPECT_EQ(file.used, file.rows) << name << ": nothing is wrong with it";
  for (const auto& sample : d.payloads<ImuSample>("imu/data")) {
    const Eigen::Vector3d up = *sample.orientation * sample.linear_acceleration_mps2;
    EXPECT_NEAR(up.z(), 9.8, 2.5) << "gravity points up, whatever the road does";
  }
  for (const auto& sweep : d.payloads<SweepPtr>("velodyne/points")) {
    std::set<std::uint16_t> rings;
    for (const LidarPoint& point : sweep->points) {
      rings.insert(point.ring);
      ASSERT_LE(point.time, 1e-4);
      ASSERT_GE(point.time, -0.1037);
    }
    EXPECT_GT(sweep->points.size(), 100'000U);
    EXPECT_GE(rings.size(), 62U) << "64 lasers, of which a few merge";
    EXPECT_LE(rings.size(), 64U);
  }
}

INSTANTIATE_TEST_SUITE_P(Drives, RealKitti,
                         ::testing::Values(KittiCase{"kitti_raw_0048", 22, 22, 0, 0},
                                           KittiCase{"kitti_raw_0052", 40, 40, 40, 0},
                                           KittiCase{"kitti_depth_0001", 108, 0, 12, 12}),
                         [](const auto& drive) { return std::string(drive.param.folder); });

}  // namespace
}  // namespace atlas::record
