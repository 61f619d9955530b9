// SPDX-License-Identifier: MIT
// A small KITTI raw drive, for tests that then spoil one of its files.
#pragma once

#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "temporary_folder.hpp"

namespace atlas::test {

inline std::string kittiName(int index, const char* extension) {
  char name[32];
  std::snprintf(name, sizeof name, "%010d%s", index, extension);
  return name;
}

/// 30 columns; specific force and rates in the vehicle frame differ from those in the level frame.
inline std::string oxtsText(double yaw_rad) {
  char row[320];
  std::snprintf(row, sizeof row,
                "49.0 8.4 115.0 0.01 0.02 %.6f 1 2 3 0 0 0.1 0.2 9.8 0.11 0.21 9.81 0.01 0.02 0.03 0.011 "
                "0.021 0.031 0.05 "
                "0.02 4 9 6 6 6\n",
                yaw_rad);
  return row;
}

inline void appendReturn(std::string& bytes, double azimuth_rad, double z_m) {
  const float v[4] = {static_cast<float>(10 * std::cos(azimuth_rad)),
                      static_cast<float>(10 * std::sin(azimuth_rad)), static_cast<float>(z_m), 0.5F};
  bytes.append(reinterpret_cast<const char*>(v), sizeof v);
}

/// Laser by laser, azimuth from just above 0 counter-clockwise, as KITTI stores it.
inline std::string velodyneBytes(int lasers, int columns) {
  std::string bytes;
  for (int laser = 0; laser < lasers; ++laser) {
    for (int c = 0; c < columns; ++c) appendReturn(bytes, (c + 1e-4) * 2 * M_PI / columns, 1.0 - 0.1 * laser);
  }
  return bytes;
}

/// No rotations but the change of axes between velodyne and camera.
inline void writeKittiCalibration(const TemporaryFolder& folder, const std::string& below) {
  folder.write(below + "calib_imu_to_velo.txt",
               "calib_time: 25-May-2012 16:47:16\nR: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n");
  folder.write(below + "calib_velo_to_cam.txt",
               "calib_time: 15-Mar-2012 11:37:16\nR: 0 -1 0 0 0 -1 1 0 0\nT: 0 0 -0.27\ndelta_f: 0 0\n");
  folder.write(
      below + "calib_cam_to_cam.txt",
      "R_rect_00: 1 0 0 0 1 0 0 0 1\n"
      "S_rect_02: 1242 375\nR_rect_02: 1 0 0 0 1 0 0 0 1\nP_rect_02: 720 0 600 45 0 720 170 0 0 0 1 0\n"
      "S_rect_03: 1242 375\nR_rect_03: 1 0 0 0 1 0 0 0 1\nP_rect_03: 720 0 600 -340 0 720 170 0 0 0 1 0\n");
}

inline std::string kittiStamp(double second) {
  char text[64];
  std::snprintf(text, sizeof text, "2011-09-26 14:19:%012.9f\n", second);
  return text;
}

/// Ten frames at 10 Hz: oxts with stamps; velodyne_points and image_02 without.
inline void writeSmallKitti(const TemporaryFolder& folder) {
  std::string stamps;
  const cv::Mat picture(10, 20, CV_8UC3, cv::Scalar(10, 200, 90));
  for (int i = 0; i < 10; ++i) {
    stamps += kittiStamp(35.1 + 0.1 * i);
    folder.write("oxts/data/" + kittiName(i, ".txt"), oxtsText(0.1 * i));
    folder.write("velodyne_points/data/" + kittiName(i, ".bin"), velodyneBytes(4, 36));
    folder.write("image_02/data/x", "");
    cv::imwrite((folder / ("image_02/data/" + kittiName(i, ".png"))).string(), picture);
  }
  folder.write("oxts/timestamps.txt", stamps);
  writeKittiCalibration(folder, "calib/");
}

}  // namespace atlas::test
