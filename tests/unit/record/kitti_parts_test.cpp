// SPDX-License-Identifier: MIT
// The pieces of a KITTI raw drive: stamps, OXTS rows, sweeps, calibration, pictures.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "record/kitti_calibration.hpp"
#include "record/kitti_files.hpp"
#include "record/kitti_rows.hpp"
#include "record/kitti_sweep.hpp"
#include "record/kitti_times.hpp"
#include "small_kitti.hpp"

namespace atlas::record {
namespace {

using test::TemporaryFolder;

TEST(KittiStamps, AreReadAsUtc) {
  EXPECT_EQ(parseKittiStamp("2011-09-26 14:19:35.668269525"), 1'317'046'775'668'269'525);  // date -u +%s
  EXPECT_EQ(parseKittiStamp("2011-09-26 14:19:35.5\r"), 1'317'046'775'500'000'000);
  EXPECT_EQ(parseKittiStamp("2011-09-26 14:19:35"), 1'317'046'775'000'000'000);
  for (const char* text :
       {"", "2011-09-26", "2011-13-26 14:19:35", "2011-09-26T14:19:35", "2011-09-26 14:19:35.",
        "2011-09-26 14:19:35.1234567890", "2011-09-26 14:19:35,5", "x011-09-26 14:19:35"})
    EXPECT_FALSE(parseKittiStamp(text)) << text;
}

TEST(KittiStamps, BlankLineIsAFrameWithoutStamp) {
  const TemporaryFolder folder;
  RecordLog log;
  const auto stamps =
      readKittiStamps(folder.write("t.txt", "2011-09-26 14:19:35.1\n\nnonsense\n2011-09-26 14:19:35.4\n"),
                      "oxts/timestamps.txt", log);
  ASSERT_EQ(stamps.size(), 2U);
  EXPECT_EQ(stamps.count(0), 1U);
  EXPECT_EQ(stamps.count(3), 1U) << "numbered by line";
  EXPECT_EQ(log.files().at("oxts/timestamps.txt").rows, 3U);
  EXPECT_EQ(log.files().at("oxts/timestamps.txt").skipped.at("not a time"), 1U);
  EXPECT_NE(log.files()
                .at("oxts/timestamps.txt")
                .examples.at(0)
                .find(":3: field 1 (stamp): not a time: 'nonsense'"),
            std::string::npos);
}

OxtsSample oxts(const std::string& text, RowFields& fields) {
  static std::string kept;
  kept = text;
  fields.assign(Line{kept, 1, 0, false});
  return parseOxts(fields, 7);
}

TEST(Oxts, RowBecomesImuFixAndHeading) {
  RowFields fields("oxts/data/0000000000.txt", ' ');
  const OxtsSample sample = oxts(test::oxtsText(0.5), fields);
  ASSERT_TRUE(fields.ok()) << fields.example();
  EXPECT_EQ(sample.imu.stamp, 7);
  EXPECT_EQ(sample.fix.position.latitude_deg, 49.0);
  EXPECT_EQ(sample.fix.position.altitude_m, 115.0);
  EXPECT_EQ(sample.heading.yaw_rad, 0.5);
  EXPECT_TRUE(sample.imu.linear_acceleration_mps2.isApprox(Eigen::Vector3d(0.1, 0.2, 9.8)))
      << "ax ay az, not af al au";
  EXPECT_TRUE(sample.imu.angular_velocity_radps.isApprox(Eigen::Vector3d(0.01, 0.02, 0.03)))
      << "wx wy wz, not wf wl wu";
  ASSERT_TRUE(sample.fix.covariance_enu_m2);
  EXPECT_NEAR((*sample.fix.covariance_enu_m2)[0], 0.05 * 0.05, 1e-12);
  const RollPitchYaw rpy = toRollPitchYaw(*sample.imu.orientation);
  EXPECT_NEAR(rpy.roll, 0.01, 1e-9);
  EXPECT_NEAR(rpy.pitch, 0.02, 1e-9);
  EXPECT_NEAR(rpy.yaw, 0.5, 1e-9);
}

TEST(Oxts, FaultIsNamed) {
  RowFields fields("oxts/data/0000000000.txt", ' ');
  oxts("49 8 115", fields);
  EXPECT_EQ(fields.example(), "oxts/data/0000000000.txt:1: expected 30 fields, found 3");
  oxts("149" + test::oxtsText(0).substr(2), fields);
  EXPECT_EQ(fields.reason(), "position out of range");
}

TEST(KittiSweep, TimeIsFromTheAzimuthAndRingFromItsWraps) {
  const KittiSpin spin{1'000'000'000'000, 0.1};
  const auto sweep = parseKittiSweep(test::velodyneBytes(3, 360), spin);
  ASSERT_TRUE(sweep);
  EXPECT_EQ(sweep->stamp, spin.forward + 50'000'000);
  ASSERT_EQ(sweep->points.size(), 3U * 360);
  // The file begins at azimuth 0 = forward: half a revolution before the stamp, which is the end at the rear.
  EXPECT_NEAR(sweep->points[0].time, -0.05, 1e-6);
  EXPECT_NEAR(sweep->points[90].time, -0.05 - 0.025, 1e-4)
      << "left is seen before: the sensor turns clockwise";
  EXPECT_NEAR(sweep->points[270].time, -0.05 + 0.025, 1e-4) << "right is seen later";
  for (std::size_t i = 0; i < sweep->points.size(); ++i) {
    EXPECT_EQ(sweep->points[i].ring, 63 - i / 360) << i;
    EXPECT_LE(sweep->points[i].time, 1e-6);
    EXPECT_GE(sweep->points[i].time, -0.1 - 1e-6);
  }
}

TEST(KittiSweep, RingIsRobustAgainstJitterAtAzimuthZero) {
  std::string bytes;
  for (int laser = 0; laser < 3; ++laser) {
    for (int i = -1; i < 100; ++i) test::appendReturn(bytes, i * 0.06, -0.1 * laser);  // begins just before 0
  }
  const auto sweep = parseKittiSweep(bytes, {});
  for (std::size_t i = 1; i < 101; ++i) EXPECT_EQ(sweep->points[i].ring, 63) << i;
  for (std::size_t i = 203; i < 303; ++i) EXPECT_EQ(sweep->points[i].ring, 61) << i;
}

TEST(KittiSweep, ZeroAndNanPointsAreNoReturns) {
  std::string bytes = test::velodyneBytes(1, 8);
  bytes += std::string(16, '\0');
  const auto sweep = parseKittiSweep(bytes, {});
  ASSERT_EQ(sweep->points.size(), 9U);
  EXPECT_TRUE(std::isnan(sweep->points.back().x));
  EXPECT_EQ(sweep->points.back().time, 0.0F);
}

TEST(KittiSweep, RefusesWhatIsNoWholeNumberOfPoints) {
  EXPECT_FALSE(parseKittiSweep("", {}));
  EXPECT_FALSE(parseKittiSweep(std::string(17, 'x'), {}));
}

TEST(KittiCalibration, ChainOfTransformsProjectsAsThePaperSays) {
  const TemporaryFolder folder;
  test::writeKittiCalibration(folder, "");
  const KittiCalibration calibration = readKittiCalibration(folder.path());
  Pose T_imu_velo, T_imu_image2;
  for (const StaticTransform& t : calibration.transforms.transforms) {
    EXPECT_EQ(t.parent, "base_link");
    if (t.child == "velodyne") T_imu_velo = t.T_parent_child;
    if (t.child == "image_02") T_imu_image2 = t.T_parent_child;
  }
  // imu -> velo: x_velo = x_imu + (-0.8, 0.3, -0.8)
  EXPECT_TRUE((T_imu_velo * Eigen::Vector3d(0, 0, 0)).isApprox(Eigen::Vector3d(0.8, -0.3, 0.8), 1e-9));
  // A point 10 m ahead of the lidar: z = 10 - 0.27 in camera 0, and 0.06 m to the right in rectified
  // camera 2.
  const Eigen::Vector3d p_image = T_imu_image2.inverse() * (T_imu_velo * Eigen::Vector3d(10, 0, 0));
  EXPECT_NEAR(p_image.z(), 10 - 0.27, 1e-6);
  EXPECT_NEAR(p_image.x(), 0.0 + 45.0 / 720.0, 1e-6) << "P_rect_02 has 45 in its last column";
  const CameraInfo& info = calibration.cameras.at("image_02");
  EXPECT_EQ(info.width, 1242U);
  EXPECT_EQ(info.K[0], 720.0);
  EXPECT_EQ(info.distortion, std::vector<double>(5, 0.0)) << "the pictures are rectified";
  EXPECT_EQ(info.P[3], 0.0) << "the camera has its own frame";
}

TEST(KittiCalibration, MissingFilesLeaveOutWhatDependsOnThem) {
  const TemporaryFolder folder;
  test::writeKittiCalibration(folder, "");
  folder.remove("calib_velo_to_cam.txt");
  const KittiCalibration calibration = readKittiCalibration(folder.path());
  EXPECT_EQ(calibration.transforms.transforms.size(), 2U) << "imu and velodyne";
  EXPECT_EQ(calibration.cameras.size(), 2U);
  EXPECT_EQ(calibration.notes.at(0), "calib_velo_to_cam.txt: missing, cameras have no place in base_link");
}

TEST(KittiCalibration, RefusalNamesFileLineFieldAndValue) {
  const TemporaryFolder folder;
  test::writeKittiCalibration(folder, "");
  folder.write("calib_imu_to_velo.txt", "calib_time: x\nR: 1 0 0 0 1 0 0 0 abc\nT: 0 0 0\n");
  try {
    readKittiCalibration(folder.path());
    FAIL();
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("calib_imu_to_velo.txt:2: field 9 (R): not a number: 'abc'"), std::string::npos)
        << text;
  }
  folder.write("calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 2\nT: 0 0 0\n");
  EXPECT_THROW(readKittiCalibration(folder.path()), std::runtime_error) << "no rotation";
}

TEST(KittiImage, WholePictureOrNone) {
  std::vector<std::uint8_t> png, jpeg;
  const cv::Mat picture(20, 30, CV_8UC3, cv::Scalar(10, 200, 90));
  cv::imencode(".png", picture, png);
  cv::imencode(".jpg", picture, jpeg);
  const std::string whole_png(png.begin(), png.end()), whole_jpeg(jpeg.begin(), jpeg.end());
  EXPECT_EQ(kittiImage(whole_png, false)->format, "png");
  EXPECT_EQ(kittiImage(whole_jpeg, false)->format, "jpeg");
  EXPECT_EQ(kittiImage(whole_png, false)->encoded, png) << "as stored";
  EXPECT_EQ(kittiImage(whole_png, true)->pixels.at<cv::Vec3b>(3, 4), cv::Vec3b(10, 200, 90));
  EXPECT_EQ(kittiImage(whole_png.substr(0, whole_png.size() - 20), false), nullptr);
  EXPECT_EQ(kittiImage(whole_jpeg.substr(0, whole_jpeg.size() / 2), true), nullptr);
  EXPECT_EQ(kittiImage("", true), nullptr);
  std::string huge = whole_png;
  huge[16] = huge[20] = '\x7f';  // width and height of two thousand million
  EXPECT_EQ(kittiImage(huge, true), nullptr);
}

TEST(KittiFiles, AreFoundInEachLayout) {
  const TemporaryFolder folder;
  folder.write("raw/2011_09_26/calib_cam_to_cam.txt", "");
  folder.write("raw/2011_09_26/2011_09_26_drive_0001_sync/image_02/data/0000000005.png", "");
  folder.write("raw/2011_09_26/2011_09_26_drive_0001_sync/image_00/data/0000000005.png", "");
  folder.write("oxts/data/0000000005.txt", "");
  folder.write("annotated/proj_depth/groundtruth/image_02/0000000005.png", "");
  KittiFiles files = findKittiFiles(folder.path(), "");
  EXPECT_EQ(files.sensors.size(), 2U);
  EXPECT_EQ(files.calibration.filename(), "2011_09_26");
  EXPECT_EQ(files.notes.at(0), "image_00: grey camera, not read");
  files = findKittiFiles(folder / "raw/2011_09_26/2011_09_26_drive_0001_sync", "");
  EXPECT_EQ(files.calibration.filename(), "2011_09_26") << "the folder above, as KITTI delivers it";
  folder.write("raw/2011_09_26/2011_09_26_drive_0002_sync/image_02/data/0000000005.png", "");
  EXPECT_THROW(findKittiFiles(folder.path(), ""), std::invalid_argument) << "two drives";
}

}  // namespace
}  // namespace atlas::record
