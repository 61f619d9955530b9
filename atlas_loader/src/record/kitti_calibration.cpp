// SPDX-License-Identifier: MIT
#include "record/kitti_calibration.hpp"

#include <cmath>
#include <stdexcept>

#include "record/text_rows.hpp"

namespace atlas::record {
namespace {
namespace fs = std::filesystem;

/// "key: number number ..." lines of one file.
class KeyedNumbers {
 public:
  explicit KeyedNumbers(fs::path path) : path_(std::move(path)) {
    LineReader lines(path_);
    present_ = lines.opened();
    while (const auto line = lines.next()) {
      const std::size_t colon = line->text.find(':');
      if (colon == std::string_view::npos) continue;
      text_[std::string(trim(line->text.substr(0, colon)))] = {std::string(line->text.substr(colon + 1)),
                                                               line->number};
    }
  }
  [[nodiscard]] bool present() const { return present_; }
  [[nodiscard]] bool has(const std::string& key) const { return text_.count(key) > 0; }

  [[nodiscard]] std::vector<double> get(const std::string& key, std::size_t count) const {
    const auto it = text_.find(key);
    if (it == text_.end()) throw std::runtime_error(path_.string() + ": field " + key + " is missing");
    RowFields fields(path_.string(), ' ');
    fields.assign(Line{it->second.text, it->second.line, 0, false});
    fields.expect(count);
    std::vector<double> values;
    for (std::size_t i = 0; i < count && fields.ok(); ++i) values.push_back(fields.number(i, key.c_str()));
    if (!fields.ok()) throw std::runtime_error(fields.example());
    return values;
  }
  /// A rotation, row-major; printed with 7 digits, so it is made orthogonal through the quaternion.
  [[nodiscard]] Eigen::Quaterniond rotation(const std::string& key) const {
    const auto r = get(key, 9);
    const Eigen::Matrix3d m = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(r.data());
    if ((m * m.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-3 || m.determinant() < 0)
      throw std::runtime_error(path_.string() + ": field " + key + ": not a rotation matrix");
    return Eigen::Quaterniond(m).normalized();
  }
  [[nodiscard]] Pose rigid() const {
    const auto t = get("T", 3);
    return {rotation("R"), {t[0], t[1], t[2]}};
  }

 private:
  struct Value {
    std::string text;
    std::uint64_t line;
  };
  fs::path path_;
  bool present_ = false;
  std::map<std::string, Value> text_;
};

CameraInfo rectifiedCamera(const KeyedNumbers& cams, const std::string& number, const std::string& frame) {
  const auto p = cams.get("P_rect_" + number, 12);
  const auto size = cams.get("S_rect_" + number, 2);
  CameraInfo info;
  info.frame = frame;
  if (size[0] < 1 || size[1] < 1 || size[0] > 65536 || size[1] > 65536 || p[0] <= 0 || p[5] <= 0)
    throw std::runtime_error("calib_cam_to_cam.txt: fields S_rect_" + number + ", P_rect_" + number +
                             ": no camera");
  info.width = static_cast<std::uint32_t>(size[0]);
  info.height = static_cast<std::uint32_t>(size[1]);
  info.distortion_model = "plumb_bob";
  info.distortion.assign(5, 0.0);
  info.K = {p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]};
  info.P = {p[0], p[1], p[2], 0, p[4], p[5], p[6], 0, p[8], p[9], p[10], 0};
  return info;
}
}  // namespace

KittiCalibration readKittiCalibration(const fs::path& folder) {
  KittiCalibration calibration;
  const KeyedNumbers imu(folder / "calib_imu_to_velo.txt");
  const KeyedNumbers velo(folder / "calib_velo_to_cam.txt");
  const KeyedNumbers cams(folder / "calib_cam_to_cam.txt");
  auto& transforms = calibration.transforms.transforms;
  transforms.push_back({"base_link", "imu", Pose{}});
  if (!imu.present())
    calibration.notes.emplace_back("calib_imu_to_velo.txt: missing, no sensor has a place in base_link");
  if (!velo.present())
    calibration.notes.emplace_back("calib_velo_to_cam.txt: missing, cameras have no place in base_link");
  if (!cams.present()) calibration.notes.emplace_back("calib_cam_to_cam.txt: missing, no camera_info");
  const Pose T_velo_imu = imu.present() ? imu.rigid() : Pose{};
  if (imu.present()) transforms.push_back({"base_link", "velodyne", T_velo_imu.inverse()});
  for (const std::string number : {"02", "03"}) {
    if (!cams.present() || !cams.has("P_rect_" + number)) continue;
    const std::string frame = "image_" + number;
    calibration.cameras[frame] = rectifiedCamera(cams, number, frame);
    if (!imu.present() || !velo.present()) continue;
    const auto p = cams.get("P_rect_" + number, 12);
    const Eigen::Matrix3d K =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(calibration.cameras[frame].K.data());
    const Pose T_image_rect0{Eigen::Quaterniond::Identity(),
                             K.inverse() * Eigen::Vector3d(p[3], p[7], p[11])};
    const Pose T_rect0_cam0{cams.rotation("R_rect_00"), Eigen::Vector3d::Zero()};
    const Pose T_image_imu = T_image_rect0 * T_rect0_cam0 * velo.rigid() * T_velo_imu;
    transforms.push_back({"base_link", frame, T_image_imu.inverse()});
  }
  return calibration;
}

}  // namespace atlas::record
