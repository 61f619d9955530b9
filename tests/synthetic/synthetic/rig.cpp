// SPDX-License-Identifier: MIT
#include "synthetic/rig.hpp"

#include <cmath>
#include <stdexcept>

#include "synthetic/text_file.hpp"

namespace atlas::synthetic {

const std::vector<RigFrame>& rigFrames() {
  static const std::vector<RigFrame> kFrames = {
      {"imu", {0, 0, 0}, {0, 0, 0, 1}},
      {"lidar_left", {0.17, 0.48, 0.15}, {0.00127205, -0.0632186, -0.997913, 0.0130773}},
      {"lidar_right", {0.17, -0.48, 0.15}, {-0.00127205, -0.0632186, 0.997913, 0.0130773}},
      {"lidar_center", {0.42, 0.0, 0.10}, {-0.002, 0.079, 0.026, 0.997}},
      {"camera_left_front", {0.46, 0.34, 0}, {-0.509899, 0.489903, -0.489901, 0.509898}},
      {"camera_right_front", {0.46, -0.34, 0}, {-0.494975, 0.494977, -0.504975, 0.504973}},
      {"camera_left_side", {0.41, 0.44, 0}, {-0.684011, 0.110053, -0.114552, 0.711966}},
      {"camera_right_side", {0.41, -0.44, 0}, {-0.132579, 0.690941, -0.697918, 0.133917}},
      {"camera_virtual", {0.0, 0.0, 3.0}, {0.579, -0.579, 0.405, -0.405}},
      {"gnss_front", {0.48, -0.19, 0}, {0, 0, 0, 1}},
      {"gnss_rear", {-0.48, -0.19, 0}, {0, 0, 0, 1}},
      {"camera_ir", {0.46, 0.24, 0}, {-0.515309, 0.500121, -0.485219, 0.498897}},
      {"radar_ti", {0.52, 0.42, -0.04}, {0, 0, 0, 1}},
  };
  return kFrames;
}

Pose T_imu_sensor(const std::string& frame) {
  for (const RigFrame& entry : rigFrames()) {
    if (entry.name == frame) return entry.T_imu_sensor();
  }
  throw std::invalid_argument("synthetic rig: no frame \"" + frame + "\"");
}

std::vector<Camera> rigCameras(double rgb_scale) {
  std::vector<Camera> cameras = {
      {"camera_left_front", 1920, 1200, 1376.3974496214614, 1377.1721669205588, 959.23661859185984,
       576.74337567054886, -0.17245433170404437, 0.11239016157509915, -0.00015253720111333031,
       0.00038487261087130094, -0.020770262391598841},
      {"camera_left_side", 1920, 1200, 1032.9180994368476, 1030.3821972228279, 984.92525031711864,
       585.98411105174750, -0.14969168617434800, 0.074181710817879137, 0.00016074527128387292,
       0.00014418952850272905, -0.024409073870486547},
      {"camera_right_front", 1920, 1200, 1401.3103100941660, 1396.0898458767542, 1015.9140597134168,
       598.93145212702859, -0.20232937998377637, 0.14524755809605608, -0.0013144795400742237,
       0.0086127186770880628, -0.057951505510463422},
      {"camera_right_side", 1920, 1200, 1006.7971442444854, 1006.9716460470880, 989.09655481158700,
       595.57363718410966, -0.14805229920655585, 0.074182817619655422, 0.00047189089838384001,
       0.000063920298421256020, -0.015465074923160538},
  };
  for (Camera& camera : cameras) {  // whole pixels keep their centres: u' + 1/2 = scale (u + 1/2)
    camera.width =
        2 * static_cast<int>(std::lround(0.5 * camera.width * rgb_scale));  // even, for 4:2:0 video
    camera.height = 2 * static_cast<int>(std::lround(0.5 * camera.height * rgb_scale));
    camera.fx *= rgb_scale;
    camera.fy *= rgb_scale;
    camera.cx = (camera.cx + 0.5) * rgb_scale - 0.5;
    camera.cy = (camera.cy + 0.5) * rgb_scale - 0.5;
  }
  cameras.push_back({"camera_ir", 640, 512, 526.40790081811531, 526.16047137164196, 328.73021894218374,
                     266.06656491425667, -0.29218591630293017, 0.10967035799564277, -0.0017002587844859012,
                     -0.0030185250977213937, -0.029409489363612488});
  return cameras;
}

// OpenCV documentation, calib3d, "Detailed description": x'' and y'' from x' and y'.
Eigen::Vector2d Camera::distort(const Eigen::Vector2d& tangent) const {
  const double x = tangent.x(), y = tangent.y(), r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {fx * (x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x)) + cx,
          fy * (y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y) + cy};
}

Eigen::Vector2d Camera::undistort(const Eigen::Vector2d& pixel) const {
  Eigen::Vector2d tangent((pixel.x() - cx) / fx, (pixel.y() - cy) / fy);
  for (int round = 0; round < 20; ++round) {
    constexpr double kStep = 1e-6;
    const Eigen::Vector2d error = distort(tangent) - pixel;
    Eigen::Matrix2d jacobian;
    jacobian.col(0) =
        (distort(tangent + Eigen::Vector2d(kStep, 0.0)) - distort(tangent - Eigen::Vector2d(kStep, 0.0))) /
        (2.0 * kStep);
    jacobian.col(1) =
        (distort(tangent + Eigen::Vector2d(0.0, kStep)) - distort(tangent - Eigen::Vector2d(0.0, kStep))) /
        (2.0 * kStep);
    const Eigen::Vector2d change = jacobian.inverse() * error;
    tangent -= change;
    if (change.norm() < 1e-12) break;
  }
  return tangent;
}

void writeCalibrations(const std::filesystem::path& folder, double rgb_scale) {
  std::filesystem::create_directories(folder);
  std::vector<Camera> cameras = rigCameras(rgb_scale);
  cameras.push_back(cameras.front());
  cameras.back().name = "camera_virtual";
  for (const Camera& camera : cameras) {
    TextFile file(folder / (camera.name + ".yaml"), TextFile::LineEnd::kUnix);
    file.print("width: %d\n\nheight: %d\n\n", camera.width, camera.height);
    file.print("intrinsic: [%.16e, %.16e, %.16e,\n", camera.fx, 0.0, camera.cx);
    file.print("            %.16e, %.16e, %.16e,\n", 0.0, camera.fy, camera.cy);
    file.print("            %.16e, %.16e, %.16e]\n\n", 0.0, 0.0, 1.0);
    file.print("dist: [%.16e, %.16e, %.16e, %.16e, %.16e]\n", camera.k1, camera.k2, camera.p1, camera.p2,
               camera.k3);
  }
  TextFile file(folder / "frames.yaml", TextFile::LineEnd::kUnix);
  file.print(
      "# Pose of each sensor in the imu frame: p_imu = R p_sensor + t\n# trans: [x, y, z]\n# rot: [x, y, z, "
      "w]\n");
  for (const RigFrame& frame : rigFrames()) {
    file.print("\n%s:\n    trans: [%g, %g, %g]\n", frame.name.c_str(), frame.translation.x(),
               frame.translation.y(), frame.translation.z());
    file.print("    rot: [%.9g, %.9g, %.9g, %.9g]\n", frame.rotation[0], frame.rotation[1], frame.rotation[2],
               frame.rotation[3]);
  }
}

}  // namespace atlas::synthetic
