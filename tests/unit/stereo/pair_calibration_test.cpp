// SPDX-License-Identifier: MIT
#include "stereo/pair_calibration.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "atlas/stereo/rectifier.hpp"

namespace atlas::test {
namespace {

namespace fs = std::filesystem;

class PairCalibrationFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(testing::TempDir()) /
        ("pair_calibration_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  static std::string errorOf(const fs::path& path) {
    try {
      readPairCalibration(path, {}, {500, 312});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  fs::path folder_;
};

TEST_F(PairCalibrationFile, YamlOfARectifiedPair) {
  const auto pair = readPairCalibration(
      write("pair.yaml", "f: 410\nu0: 258\nv0: 156\nbaseline: 0.22\nheight: 1.28\npitch: 0.5\n"), {},
      {500, 312});
  const Rectifier rectifier(pair.left, pair.right, pair.T_left_right);
  EXPECT_TRUE(rectifier.untouched());
  EXPECT_DOUBLE_EQ(rectifier.rig().focal_px, 410.0);
  EXPECT_DOUBLE_EQ(rectifier.rig().v0_px, 156.0);
  EXPECT_NEAR(rectifier.rig().baseline_m, 0.22, 1e-12);
  EXPECT_EQ(rectifier.rig().width_px, 500);
  EXPECT_DOUBLE_EQ(pair.height_m, 1.28);
  EXPECT_DOUBLE_EQ(pair.pitch_deg, 0.5);
}

TEST_F(PairCalibrationFile, KittiInBothForms) {
  const std::string left =
      "7.215377e+02 0 6.095593e+02 4.485728e+01 0 7.215377e+02 1.728540e+02 2.163791e-01 0 0 1 2.7e-03";
  const std::string right =
      "7.215377e+02 0 6.095593e+02 -3.395242e+02 0 7.215377e+02 1.728540e+02 2.199936e+00 0 0 1 2.7e-03";
  for (const auto& [a, b] : {std::pair{"P_rect_02: ", "P_rect_03: "}, {"P2: ", "P3: "}}) {
    const auto pair =
        readPairCalibration(write("calib.txt", a + left + "\n" + b + right + "\n"), {}, {1242, 375});
    const Rectifier rectifier(pair.left, pair.right, pair.T_left_right);
    EXPECT_TRUE(rectifier.untouched());
    EXPECT_NEAR(rectifier.rig().baseline_m, 0.5327, 1e-4);
  }
}

TEST_F(PairCalibrationFile, RigFolderIsRectified) {
  const std::string camera =
      "width: 640\nheight: 480\nintrinsic: [500,0,320, 0,500,240, 0,0,1]\ndist: [-0.2,0,0,0,0]\n";
  write("camera_left_front.yaml", camera);
  write("camera_right_front.yaml", camera);
  write("frames.yaml",
        "imu: {trans: [0,0,0], rot: [0,0,0,1]}\n"
        "camera_left_front: {trans: [0.5,0.2,0], rot: [-0.5,0.5,-0.5,0.5]}\n"
        "camera_right_front: {trans: [0.5,-0.2,0], rot: [-0.5,0.5,-0.5,0.5]}\n");
  const auto pair = readPairCalibration(folder_, {}, {640, 480});
  const Rectifier rectifier(pair.left, pair.right, pair.T_left_right);
  EXPECT_FALSE(rectifier.untouched());
  EXPECT_NEAR(rectifier.rig().baseline_m, 0.4, 1e-9);
}

TEST_F(PairCalibrationFile, ErrorsNameFileLineFieldAndValue) {
  const std::string file = (folder_ / "pair.yaml").string();
  EXPECT_EQ(errorOf(write("pair.yaml", "f: 410\nu0: 258\nv0: 156\n")), file + ": field baseline is missing");
  EXPECT_EQ(errorOf(write("pair.yaml", "f: 410\nu0: 258\nv0: 156\nbaseline: -1\n")),
            file + ":4: field baseline: not a positive number: '-1'");
  EXPECT_EQ(errorOf(write("pair.yaml", "f: wide\nu0: 258\nv0: 156\nbaseline: 1\n")),
            file + ":1: field f: not a positive number: 'wide'");
  EXPECT_EQ(errorOf(write("pair.yaml", "f: 410\nu0: 258\nv0: 156\nbaseline: 1\nheigth: 1\n")),
            file + ":5: unknown field heigth");
  const std::string text = (folder_ / "calib.txt").string();
  EXPECT_EQ(errorOf(write("calib.txt", "P_rect_02: 1 2 3\n")),
            text + ":1: field P_rect_02: needs 12 numbers, got 'P_rect_02: 1 2 3'");
  EXPECT_EQ(errorOf(write("calib.txt", "R: 1\n")), text + ": field P_rect_02 (or P2) is missing");
}

}  // namespace
}  // namespace atlas::test
