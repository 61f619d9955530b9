// SPDX-License-Identifier: MIT
// Damaged bytes in every file that a reader opens: no crash, no exception but the documented one for
// calibration, and every row accounted for. Deterministic: a failure names the seed.
#include <gtest/gtest.h>

#include "drained.hpp"
#include "mutations.hpp"
#include "record/bud_rows.hpp"
#include "record/calibration_file.hpp"
#include "record/detection_file.hpp"
#include "record/kitti_calibration.hpp"
#include "record/kitti_files.hpp"
#include "record/kitti_rows.hpp"
#include "record/kitti_sweep.hpp"
#include "record/sweep_timing.hpp"
#include "small_kitti.hpp"
#include "small_video.hpp"
#include "small_zip.hpp"

namespace atlas::record {
namespace {

using test::Mutations;
using test::TemporaryFolder;

constexpr std::uint32_t kParserCases = 3000;
constexpr std::uint32_t kRecordCases = 250;
constexpr std::uint32_t kCalibrationCases = 800;
constexpr std::uint32_t kVideoCases = 150;

/// Calls parse(fields) for each line of a spoiled text.
template <class Parse>
void spoilRows(const std::string& text, char delimiter, Parse parse) {
  for (std::uint32_t seed = 0; seed < kParserCases; ++seed) {
    const std::string spoiled = Mutations(seed).spoil(text);
    RowFields fields("f.txt", delimiter);
    std::size_t at = 0;
    for (std::uint64_t number = 1; at < spoiled.size(); ++number) {
      const std::size_t end = std::min(spoiled.find('\n', at), spoiled.size());
      fields.assign(Line{std::string_view(spoiled).substr(at, end - at), number, at, false});
      parse(fields);
      if (!fields.ok()) {
        EXPECT_FALSE(fields.example().empty()) << "seed " << seed;
      }
      at = end + 1;
    }
  }
}

bool isFinite(const Eigen::Vector3d& v) { return v.allFinite(); }

TEST(Fuzz, RowsOfTheDataset) {
  const BudRowOptions options{1000, true};
  spoilRows(test::imuText(3), ',', [&](RowFields& fields) {
    const ImuSample sample = parseImu(fields, options);
    if (fields.ok()) {
      EXPECT_TRUE(isFinite(sample.linear_acceleration_mps2) && isFinite(sample.angular_velocity_radps));
      EXPECT_TRUE(isPlausible(sample.stamp + options.latency));
    }
  });
  spoilRows(test::poseText(3), ',', [&](RowFields& fields) {
    const GnssFix fix = parseFix(fields, options, 5);
    const auto heading = parseHeading(fields, options);
    if (fields.ok()) {
      EXPECT_LE(std::abs(fix.position.latitude_deg), 90.0);
      EXPECT_TRUE(!heading || std::abs(heading->yaw_rad) <= M_PI + 1e-9);
    }
  });
  spoilRows("1568186745436549395, 2, 10.5, 1, 0.5, -3.25, 20, -2, 0, 1e-1\n", ',', [&](RowFields& fields) {
    const RadarScan scan = parseRadar(fields, options);
    if (fields.ok()) {
      EXPECT_EQ(fields.size(), 2 + 4 * scan.targets.size());
    }
  });
  spoilRows("1568186745407734180, 2019, 9, 11, 7, 25, 45, 403600000\n", ',',
            [&](RowFields& fields) { parseTime(fields, options, "imu"); });
}

TEST(Fuzz, RowsOfDetections) {
  for (const auto layout : {DetectionLayout::kTopLeft, DetectionLayout::kCenter, DetectionLayout::kCorners}) {
    const std::string row =
        layout == DetectionLayout::kTopLeft  ? "2, 0.1617, 0.4584, 0.0362, 0.0268, 0.8189, 0.9967, 2\n"
        : layout == DetectionLayout::kCenter ? "2, 0.5, 0.4584, 0.0362, 0.0268, 0.8189, 2\n"
                                             : "2, -12, 30, 80, 90, 0.9, 2\n";
    spoilRows(row, ',', [&](RowFields& fields) {
      const Detection2d box = parseDetection(fields, layout, {640, 512});
      if (fields.ok()) {
        EXPECT_LE(box.x_min, box.x_max);
        EXPECT_LE(box.y_min, box.y_max);
        EXPECT_TRUE(box.confidence >= 0 && box.confidence <= 1);
      }
    });
  }
}

TEST(Fuzz, RowsOfKitti) {
  spoilRows(test::oxtsText(0.5), ' ', [](RowFields& fields) {
    const OxtsSample sample = parseOxts(fields, 7);
    if (fields.ok()) {
      EXPECT_TRUE(isFinite(sample.imu.linear_acceleration_mps2));
      EXPECT_NEAR(sample.imu.orientation->norm(), 1.0, 1e-9);
    }
  });
  const std::string stamp = test::kittiStamp(35.5);
  for (std::uint32_t seed = 0; seed < kParserCases; ++seed) {
    const auto parsed = parseKittiStamp(Mutations(seed).spoil(stamp));
    EXPECT_TRUE(!parsed || isPlausible(*parsed)) << "seed " << seed;
  }
}

TEST(Fuzz, PointClouds) {
  const std::string kinds[] = {
      test::pcdText(test::revolution(4)),
      "FIELDS x y z t\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 3\nHEIGHT 1\nPOINTS 3\nDATA "
      "ascii\n1 2 3 0\n4 5 6 7\n8 9 1 2\n",
      "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA "
      "binary_compressed\n" +
          std::string("\x19\0\0\0\x18\0\0\0\x17", 9) + std::string(24, 'a')};
  for (const std::string& good : kinds) {
    ASSERT_EQ(parsePcd(good).error, "");
    for (std::uint32_t seed = 0; seed < kParserCases; ++seed) {
      PcdCloud cloud = parsePcd(Mutations(seed).spoil(good));
      if (!cloud.error.empty()) {
        EXPECT_TRUE(cloud.points.empty()) << "seed " << seed;
        continue;
      }
      const std::size_t size = cloud.points.size();
      const Sweep sweep = makeSweep(std::move(cloud), test::kBegin, "l", {}).sweep;
      ASSERT_EQ(sweep.points.size(), size);
      for (const LidarPoint& point : sweep.points)
        ASSERT_TRUE(std::abs(point.time) <= 1.0F) << "seed " << seed;
    }
  }
}

TEST(Fuzz, VelodyneFilesAndPictures) {
  const std::string sweep = test::velodyneBytes(3, 20);
  std::vector<std::uint8_t> png, jpeg;
  cv::Mat picture(16, 24, CV_8UC3);
  for (int i = 0; i < 16 * 24 * 3; ++i) picture.data[i] = static_cast<std::uint8_t>(i * 7);
  cv::imencode(".png", picture, png);
  cv::imencode(".jpg", picture, jpeg);
  for (std::uint32_t seed = 0; seed < kParserCases; ++seed) {
    Mutations mutations(seed);
    const auto parsed = parseKittiSweep(mutations.spoil(sweep), {});
    if (parsed) {
      for (const LidarPoint& p : parsed->points)
        ASSERT_TRUE(p.ring < 64 && std::abs(p.time) < 0.2) << "seed " << seed;
    }
    kittiImage(mutations.spoil({png.begin(), png.end()}), true);
    kittiImage(mutations.spoil({jpeg.begin(), jpeg.end()}), true);
  }
}

/// Reads a folder of calibration; only std::runtime_error that names a file may come out.
template <class Read>
void expectReadOrRefused(Read read, std::uint32_t seed) {
  try {
    read();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("."), std::string::npos)
        << "seed " << seed << ": " << error.what();
  }
}

TEST(Fuzz, CalibrationFiles) {
  const std::string frames =
      "imu:\n  trans: [0, 0, 0]\n  rot: [0, 0, 0, 1]\nlidar_left:\n  trans: [0.17, 0.48, 0.15]\n  rot: [0, "
      "-0.06, -0.99, "
      "0.01]\n";
  const std::string camera =
      "width: 640\nheight: 512\nintrinsic: [526.4, 0, 328.7, 0, 526.2, 266.1, 0, 0, 1]\ndist: [-0.29, 0.11, "
      "0, 0, 0]\n";
  const TemporaryFolder bud, kitti;
  test::writeKittiCalibration(kitti, "");
  const std::string imu = kitti.read("calib_imu_to_velo.txt"), cams = kitti.read("calib_cam_to_cam.txt");
  for (std::uint32_t seed = 0; seed < kCalibrationCases; ++seed) {
    Mutations mutations(seed);
    bud.write("frames.yaml", mutations.spoil(frames));
    bud.write("camera_ir.yaml", mutations.spoil(camera));
    expectReadOrRefused([&] { readRigFiles(bud.path()); }, seed);
    kitti.write("calib_imu_to_velo.txt", mutations.spoil(imu));
    kitti.write("calib_cam_to_cam.txt", mutations.spoil(cams));
    expectReadOrRefused([&] { readKittiCalibration(kitti.path()); }, seed);
  }
}

/// Spoils one file of a record after the other and reads the whole record each time.
void spoilRecord(const TemporaryFolder& folder, const std::vector<std::string>& files, std::uint32_t cases) {
  std::map<std::string, std::string> good;
  for (const std::string& file : files) {
    good[file] = folder.read(file);
    ASSERT_FALSE(good[file].empty()) << file;
  }
  for (std::uint32_t seed = 0; seed < cases; ++seed) {
    Mutations mutations(seed);
    const std::string& file = files[seed % files.size()];
    folder.write(file, mutations.spoil(good[file]));
    RecordOptions options;
    options.images = static_cast<RecordOptions::Images>(mutations.below(3));
    if (mutations.below(4) == 0) options.start_s = 0.35;
    SCOPED_TRACE("seed " + std::to_string(seed) + ", " + file);
    test::readRecord(folder.path(), options);
    folder.write(file, good[file]);
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(Fuzz, TextFilesOfARecord) {
  const TemporaryFolder folder;
  test::writeSmallRecord(folder);
  test::addCameras(folder, 3);
  spoilRecord(folder,
              {"imu/imu.txt", "imu/gnss.txt", "imu/mag.txt", "imu/time.txt", "gnss/pose.txt", "gnss/time.txt",
               "lidar_left/timestamps.txt", "radar_ti/scans.txt", "camera_ir/timestamps.txt",
               "camera_left_front/timestamps.txt", "yolo/camera_left_front.txt"},
              kRecordCases);
}

TEST(Fuzz, ZipOfARecord) {
  const TemporaryFolder folder;
  folder.write("lidar_left/timestamps.txt", test::lidarTimesText(5));
  std::vector<std::pair<std::string, std::string>> members;
  for (int i = 0; i < 5; ++i) members.emplace_back(test::scanName(i), test::pcdText(test::revolution(6, i)));
  test::writeZip(folder / "lidar_left/scans.zip", members);
  spoilRecord(folder, {"lidar_left/scans.zip"}, 4 * kRecordCases);
}

TEST(Fuzz, VideosOfARecord) {
  const TemporaryFolder folder;
  test::addCameras(folder, 35);
  folder.write("camera_left_front/video.mp4", test::withIndexFirst(folder.read("camera_ir/video.mp4")));
  spoilRecord(folder, {"camera_ir/video.mp4", "camera_left_front/video.mp4"}, kVideoCases);
}

TEST(Fuzz, FilesOfAKittiDrive) {
  const TemporaryFolder folder;
  test::writeSmallKitti(folder);
  spoilRecord(
      folder,
      {"oxts/timestamps.txt", "oxts/data/" + test::kittiName(3, ".txt"),
       "velodyne_points/data/" + test::kittiName(4, ".bin"), "image_02/data/" + test::kittiName(5, ".png")},
      kRecordCases);
}

}  // namespace
}  // namespace atlas::record
