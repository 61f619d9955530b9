// SPDX-License-Identifier: MIT
#include "stereo/pair_calibration.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "atlas/calibration/rig.hpp"
#include "record/calibration_file.hpp"

namespace atlas {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int line, const std::string& what) {
  throw std::runtime_error(file.string() + ":" + std::to_string(line) + ": " + what);
}

CameraInfo rectifiedInfo(const std::string& frame, cv::Size size, const std::array<double, 12>& P) {
  CameraInfo info;
  info.frame = frame;
  info.width = static_cast<std::uint32_t>(size.width);
  info.height = static_cast<std::uint32_t>(size.height);
  info.distortion_model = "plumb_bob";
  info.K = {P[0], P[1], P[2], P[4], P[5], P[6], P[8], P[9], P[10]};
  info.P = P;
  return info;
}

/// The 12 numbers after the first of `keys` that the file has.
std::array<double, 12> projectionIn(const fs::path& file, const std::vector<std::string>& keys) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error(file.string() + ": cannot be read");
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    for (const std::string& key : keys) {
      if (line.compare(0, key.size() + 1, key + ":") != 0) continue;
      std::istringstream fields(line.substr(key.size() + 1));
      fields.imbue(std::locale::classic());
      std::array<double, 12> values{};
      for (double& value : values)
        if (!(fields >> value)) fail(file, number, "field " + key + ": needs 12 numbers, got '" + line + "'");
      if (!(values[0] > 0.0))
        fail(file, number, "field " + key + ": focal length " + std::to_string(values[0]));
      return values;
    }
  }
  throw std::runtime_error(file.string() + ": field " + keys.front() + " (or " + keys.back() +
                           ") is missing");
}

PairCalibration readKitti(const fs::path& file, const PairNames& names, cv::Size size) {
  const auto numberOf = [&](const std::string& name, const std::string& usual) {
    const std::string camera = name.empty() ? usual : name;
    const std::string number = camera.size() > 2 ? camera.substr(camera.size() - 2) : camera;
    if (number.find_first_not_of("0123456789") != std::string::npos || number.size() != 2)
      throw std::runtime_error("camera '" + camera +
                               "' of a KITTI calibration must end in its number, as image_02");
    return number;
  };
  const std::string left = numberOf(names.left, "image_02"), right = numberOf(names.right, "image_03");
  PairCalibration pair;
  pair.left =
      rectifiedInfo("image_" + left, size, projectionIn(file, {"P_rect_" + left, "P" + left.substr(1)}));
  pair.right =
      rectifiedInfo("image_" + right, size, projectionIn(file, {"P_rect_" + right, "P" + right.substr(1)}));
  return pair;
}

PairCalibration readYaml(const fs::path& file, cv::Size size) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(file.string());
  } catch (const YAML::BadFile&) {
    throw std::runtime_error(file.string() + ": cannot be read");
  } catch (const YAML::Exception& error) {
    fail(file, error.mark.line + 1, error.msg);
  }
  if (!root.IsMap()) fail(file, root.Mark().line + 1, "expected f, u0, v0, baseline");
  const std::set<std::string> known{"f", "u0", "v0", "baseline", "height", "pitch"};
  for (const auto& entry : root)
    if (known.count(entry.first.Scalar()) == 0)
      fail(file, entry.first.Mark().line + 1, "unknown field " + entry.first.Scalar());
  const auto number = [&](const std::string& field, bool positive, std::optional<double> otherwise) {
    const YAML::Node node = root[field];
    if (!node && otherwise) return *otherwise;
    if (!node) throw std::runtime_error(file.string() + ": field " + field + " is missing");
    double value = std::nan("");
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value) ||
        (positive && value <= 0.0))
      fail(file, node.Mark().line + 1,
           "field " + field + ": not a " + (positive ? "positive " : "") + "number: '" +
               (node.IsScalar() ? node.Scalar() : "...") + "'");
    return value;
  };
  const double f = number("f", true, {}), u0 = number("u0", false, {}), v0 = number("v0", false, {});
  const double baseline_m = number("baseline", true, {});
  PairCalibration pair;
  pair.left = rectifiedInfo("left", size, {f, 0, u0, 0, 0, f, v0, 0, 0, 0, 1, 0});
  pair.right = rectifiedInfo("right", size, {f, 0, u0, -f * baseline_m, 0, f, v0, 0, 0, 0, 1, 0});
  pair.height_m = root["height"] ? number("height", true, {}) : 0.0;
  pair.pitch_deg = number("pitch", false, 0.0);
  return pair;
}

PairCalibration readRig(const fs::path& folder, const PairNames& names, cv::Size size) {
  const record::RigFiles files = record::readRigFiles(folder);
  Rig rig;
  rig.add(files.transforms);
  const auto infoOf = [&](const std::string& name, const std::string& usual) {
    const std::string camera = name.empty() ? usual : name;
    const auto found = files.cameras.find(camera);
    if (found == files.cameras.end())
      throw std::runtime_error(folder.string() + ": has no " + camera + ".yaml");
    CameraInfo info = found->second;
    if (info.width == 0) info.width = static_cast<std::uint32_t>(size.width);
    if (info.height == 0) info.height = static_cast<std::uint32_t>(size.height);
    return info;
  };
  PairCalibration pair;
  pair.left = infoOf(names.left, "camera_left_front");
  pair.right = infoOf(names.right, "camera_right_front");
  const auto T_imu_left = rig.T_imu(pair.left.frame), T_imu_right = rig.T_imu(pair.right.frame);
  if (T_imu_left && T_imu_right) pair.T_left_right = T_imu_left->inverse() * *T_imu_right;
  return pair;
}

}  // namespace

PairCalibration readPairCalibration(const fs::path& path, const PairNames& names, cv::Size size) {
  if (fs::is_directory(path)) return readRig(path, names, size);
  if (path.extension() == ".yaml" || path.extension() == ".yml") return readYaml(path, size);
  return readKitti(path, names, size);
}

}  // namespace atlas
