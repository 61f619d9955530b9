// SPDX-License-Identifier: MIT
// Calibration files of the Brno Urban Dataset, new and old, and what is said about bad ones.
#include "record/calibration_file.hpp"

#include <gtest/gtest.h>

#include "temporary_folder.hpp"

namespace atlas::record {
namespace {

const char* const kCamera =
    "width: 1920\nheight: 1200\nintrinsic: [1376.4, 0, 959.2, 0, 1377.2, 576.7, 0, 0, 1]\n"
    "dist: [-0.17, 0.11, -0.00015, 0.00038, -0.02]\n";
const char* const kFrames =
    "imu:\n  trans: [0, 0, 0]\n  rot: [0, 0, 0, 1]\n"
    "lidar_center:\n  trans: [0.42, 0, 0.10]\n  rot: [-0.002, 0.079, 0.026, 0.997]\n"
    "camera_ir:\n  trans: [0.46, 0.24, 0]\n  rot: [-0.515309, 0.500121, -0.485219, 0.498897]\n";

/// What readRigFiles() says about a folder that it refuses.
std::string refusal(const test::TemporaryFolder& folder) {
  try {
    readRigFiles(folder.path());
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  ADD_FAILURE() << "was taken";
  return "";
}

TEST(CalibrationFile, ReadsFramesAndCameras) {
  const test::TemporaryFolder folder;
  folder.write("frames.yaml", kFrames);
  folder.write("camera_left_front.yaml", kCamera);
  const RigFiles rig = readRigFiles(folder.path());
  ASSERT_EQ(rig.transforms.transforms.size(), 3U);
  for (const StaticTransform& transform : rig.transforms.transforms) {
    EXPECT_EQ(transform.parent, "base_link");
    EXPECT_NEAR(transform.T_parent_child.rotation.norm(), 1.0, 1e-12);
  }
  EXPECT_EQ(rig.transforms.transforms[0].child, "camera_ir") << "sorted by name";
  EXPECT_TRUE(
      rig.transforms.transforms[0].T_parent_child.translation.isApprox(Eigen::Vector3d(0.46, 0.24, 0)));
  // The optical axis of the forward camera is the vehicle's x axis but for 1.7 deg left and 1.8 deg down.
  const Eigen::Vector3d axis =
      rig.transforms.transforms[0].T_parent_child.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(std::atan2(axis.y(), axis.x()) * 180 / M_PI, 1.7, 0.1);
  EXPECT_NEAR(std::asin(axis.z()) * 180 / M_PI, -1.8, 0.1);
  const CameraInfo& camera = rig.cameras.at("camera_left_front");
  EXPECT_EQ(camera.width, 1920U);
  EXPECT_EQ(camera.K[0], 1376.4);
  EXPECT_EQ(camera.P[6], 576.7);
  EXPECT_EQ(camera.distortion.size(), 5U);
  ASSERT_EQ(rig.notes.size(), 1U);
  EXPECT_NE(rig.notes[0].find("lidar_center normalized, its norm was 1.0004"), std::string::npos);
}

TEST(CalibrationFile, OldFilesHaveNoCommasNoSizeAndAnotherName) {
  const test::TemporaryFolder folder;
  folder.write("ir_camera.yaml",
               "intrinsic: [526.4 0 328.7 0 526.2 266.1 0 0 1]\ndist: [-0.29 0.11 -0.0017 -0.0030 -0.029]\n");
  folder.write("frames.yaml", "ir_camera:\n  trans: [0.46 0.24 0]\n  rot: [0 0 0 1]\n");
  const RigFiles rig = readRigFiles(folder.path());
  const CameraInfo& camera = rig.cameras.at("camera_ir");
  EXPECT_EQ(camera.frame, "camera_ir");
  EXPECT_EQ(camera.width, 0U) << "the size comes from the video";
  EXPECT_EQ(camera.K[4], 526.2);
  EXPECT_EQ(rig.transforms.transforms[0].child, "camera_ir");
}

TEST(CalibrationFile, ArraysOverSeveralLines) {
  const test::TemporaryFolder folder;
  folder.write("camera_x.yaml",
               "intrinsic: [526.4, 0, 328.7,\n  0, 526.2, 266.1,\n  0, 0, 1]\ndist: [0, 0, 0, 0, 0]\nwidth: "
               "640\nheight: 512\n");
  EXPECT_EQ(readRigFiles(folder.path()).cameras.at("camera_x").K[5], 266.1);
}

TEST(CalibrationFile, WithoutFramesOnlyTheImuHasAPlace) {
  const test::TemporaryFolder folder;
  folder.write("camera_left_front.yaml", kCamera);
  const RigFiles rig = readRigFiles(folder.path());
  ASSERT_EQ(rig.transforms.transforms.size(), 1U);
  EXPECT_EQ(rig.transforms.transforms[0].child, "imu");
  EXPECT_EQ(rig.notes.at(0), "calibration: no frames.yaml, tf_static has no sensors");
}

TEST(CalibrationFile, RefusalNamesFileLineFieldAndValue) {
  const test::TemporaryFolder folder;
  folder.write("camera_x.yaml",
               "width: 640\nheight: 512\nintrinsic: [526.4, 0, abc, 0, 526.2, 266.1, 0, 0, 1]\ndist: [0, 0, "
               "0, 0, 0]\n");
  const std::string text = refusal(folder);
  EXPECT_NE(text.find("camera_x.yaml:3"), std::string::npos) << text;
  EXPECT_NE(text.find("field intrinsic: not a number: 'abc'"), std::string::npos) << text;
}

TEST(CalibrationFile, RefusesWhatCannotBe) {
  const std::pair<const char*, const char*> cameras[] = {
      {"width: 640\nheight: 512\nintrinsic: [1, 0, 3]\ndist: [0, 0, 0, 0, 0]\n",
       "expected 9 numbers, found 3"},
      {"width: 640\nheight: 512\nintrinsic: [0, 0, 3, 0, 5, 6, 0, 0, 1]\ndist: [0, 0, 0, 0, 0]\n",
       "not a camera matrix"},
      {"width: -640\nheight: 512\nintrinsic: [5, 0, 3, 0, 5, 6, 0, 0, 1]\ndist: [0, 0, 0, 0, 0]\n",
       "not an image side"},
      {"width: 640\nheight: 512\nintrinsic: [5, 0, 3, 0, 5, 6, 0, 0, 1]\n", "field dist is missing"},
      {"width: 640\nheight: 512\nintrinsic: [5, 0, .nan, 0, 5, 6, 0, 0, 1]\ndist: [0, 0, 0, 0, 0]\n",
       "not a number"},
      {"[1, 2", "not readable as YAML"},
      {"", "expected width, height"},
      {"width: {a: 1}\nintrinsic: [[1], 2]\n", "expected 1 numbers"}};
  for (const auto& [yaml, what] : cameras) {
    const test::TemporaryFolder folder;
    folder.write("camera_x.yaml", yaml);
    EXPECT_NE(refusal(folder).find(what), std::string::npos) << yaml;
  }
  const std::pair<const char*, const char*> frames[] = {
      {"a:\n  trans: [0, 0, 0]\n  rot: [0, 0, 0, 0]\n", "field a.rot: not a rotation, norm 0"},
      {"a:\n  trans: [0, 0]\n  rot: [0, 0, 0, 1]\n", "field a.trans: expected 3 numbers"},
      {"a:\n  trans: [0, 0, 0]\n", "field a.rot is missing"},
      {"imu:\n  trans: [1, 0, 0]\n  rot: [0, 0, 0, 1]\n", "frame imu: must be the identity"},
      {"[a]: 1\n", "the name of a frame is not a word"},
      {"a: 5\n", "frame a: expected trans and rot"},
      {"- 1\n", "expected one entry per frame"}};
  for (const auto& [yaml, what] : frames) {
    const test::TemporaryFolder folder;
    folder.write("frames.yaml", yaml);
    EXPECT_NE(refusal(folder).find(what), std::string::npos) << yaml;
  }
}

TEST(CalibrationFile, IsFoundInTheFolderOrInAClonedRepositoryBelow) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(calibrationIn(folder.path()).empty());
  EXPECT_TRUE(calibrationIn(folder / "missing").empty());
  folder.write("clone.sh", "git clone ...");
  folder.write("b/frames.yaml", kFrames);
  folder.write("a/frames.yaml", kFrames);
  folder.write("empty/readme.txt", "");
  EXPECT_EQ(calibrationIn(folder.path()).filename(), "a");
  folder.write("frames.yaml", kFrames);
  EXPECT_EQ(calibrationIn(folder.path()), folder.path());
}

}  // namespace
}  // namespace atlas::record
