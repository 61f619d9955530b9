// SPDX-License-Identifier: MIT
#include "record/calibration_file.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "record/text_rows.hpp"

namespace atlas::record {
namespace {
namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const YAML::Mark& mark, const std::string& what) {
  const std::string line = mark.is_null() ? "" : ":" + std::to_string(mark.line + 1);
  throw std::runtime_error(file.string() + line + ": " + what);
}

YAML::Node load(const fs::path& file) {
  try {
    return YAML::LoadFile(file.string());
  } catch (const YAML::Exception& error) {
    fail(file, error.mark, "not readable as YAML: " + error.msg);
  }
}

/// Numbers of [1, 2, 3], of [1 2 3] (one scalar in YAML's eyes) and of "1 2 3".
std::vector<double> numbers(const fs::path& file, const YAML::Node& node, const std::string& field,
                            std::size_t count) {
  if (!node) throw std::runtime_error(file.string() + ": field " + field + " is missing");
  std::string text;
  if (node.IsScalar()) text = node.Scalar();
  if (node.IsSequence()) {
    for (const YAML::Node& element : node) {
      if (!element.IsScalar()) fail(file, node.Mark(), "field " + field + ": not a list of numbers");
      text += element.Scalar() + " ";
    }
  }
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == '[' || c == ']' || c == '\n'; }, ' ');
  std::vector<double> values;
  std::string_view rest = trim(text);
  while (!rest.empty()) {
    const std::size_t end = rest.find_first_of(" \t");
    const std::string_view word = rest.substr(0, end);
    const auto value = toDouble(word);
    if (!value || !std::isfinite(*value))
      fail(file, node.Mark(), "field " + field + ": not a number: '" + std::string(word) + "'");
    values.push_back(*value);
    rest = end == std::string_view::npos ? std::string_view() : trim(rest.substr(end));
  }
  if (values.size() != count) {
    fail(file, node.Mark(),
         "field " + field + ": expected " + std::to_string(count) + " numbers, found " +
             std::to_string(values.size()));
  }
  return values;
}

std::string currentName(const std::string& name) { return name == "ir_camera" ? "camera_ir" : name; }

void readFrames(const fs::path& file, RigFiles& rig) {
  const YAML::Node root = load(file);
  if (!root.IsMap()) fail(file, root.Mark(), "expected one entry per frame");
  std::map<std::string, Pose> poses;
  for (const auto& entry : root) {
    if (!entry.first.IsScalar()) fail(file, entry.first.Mark(), "the name of a frame is not a word");
    const std::string name = entry.first.Scalar();
    const YAML::Node node = entry.second;
    if (!node.IsMap()) fail(file, node.Mark(), "frame " + name + ": expected trans and rot");
    const auto t = numbers(file, node["trans"], name + ".trans", 3);
    const auto r = numbers(file, node["rot"], name + ".rot", 4);
    const Eigen::Quaterniond q(r[3], r[0], r[1], r[2]);
    const double norm = q.norm();
    if (std::abs(norm - 1.0) > 0.1) {
      fail(file, node["rot"].Mark(), "field " + name + ".rot: not a rotation, norm " + std::to_string(norm));
    }
    if (std::abs(norm - 1.0) > 1e-4) {
      rig.notes.push_back(file.filename().string() + ": rotation of " + name + " normalized, its norm was " +
                          std::to_string(norm));
    }
    poses[currentName(name)] = Pose{q.normalized(), {t[0], t[1], t[2]}};
  }
  const auto imu = poses.find("imu");
  if (imu != poses.end()) {
    const Pose& p = imu->second;
    if (p.translation.norm() > 0 || Eigen::Quaterniond::Identity().angularDistance(p.rotation) > 0)
      fail(file, root["imu"].Mark(), "frame imu: must be the identity, poses are given in the imu frame");
  }
  poses["imu"] = Pose{};
  rig.transforms.transforms.clear();
  for (const auto& [name, pose] : poses) rig.transforms.transforms.push_back({"base_link", name, pose});
}

std::uint32_t imageSide(const fs::path& file, const YAML::Node& node, const std::string& field) {
  if (!node) return 0;  // files before 2019-11 have none
  const double value = numbers(file, node, field, 1)[0];
  if (value < 1 || value > 65536 || std::floor(value) != value)
    fail(file, node.Mark(), "field " + field + ": not an image side: " + std::to_string(value));
  return static_cast<std::uint32_t>(value);
}

CameraInfo readCamera(const fs::path& file, const std::string& camera) {
  const YAML::Node root = load(file);
  if (!root.IsMap()) fail(file, root.Mark(), "expected width, height, intrinsic, dist");
  CameraInfo info;
  info.frame = camera;
  info.width = imageSide(file, root["width"], "width");
  info.height = imageSide(file, root["height"], "height");
  info.distortion_model = "plumb_bob";
  const auto k = numbers(file, root["intrinsic"], "intrinsic", 9);
  info.distortion = numbers(file, root["dist"], "dist", 5);
  if (k[0] <= 0 || k[4] <= 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
    fail(file, root["intrinsic"].Mark(), "field intrinsic: not a camera matrix");
  std::copy(k.begin(), k.end(), info.K.begin());
  info.P = {k[0], k[1], k[2], 0, k[3], k[4], k[5], 0, k[6], k[7], k[8], 0};
  return info;
}

bool holdsYaml(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".yaml") return true;
  }
  return false;
}
}  // namespace

fs::path calibrationIn(const fs::path& folder) {
  if (holdsYaml(folder)) return folder;
  std::vector<fs::path> below;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->is_directory(error) && holdsYaml(it->path())) below.push_back(it->path());
  }
  return below.empty() ? fs::path() : *std::min_element(below.begin(), below.end());
}

RigFiles readRigFiles(const fs::path& folder) {
  RigFiles rig;
  rig.transforms.transforms.push_back({"base_link", "imu", Pose{}});
  std::error_code error;
  if (fs::exists(folder / "frames.yaml", error)) {
    readFrames(folder / "frames.yaml", rig);
  } else {
    rig.notes.push_back("calibration: no frames.yaml, tf_static has no sensors");
  }
  std::vector<fs::path> files;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".yaml") files.push_back(it->path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const std::string camera = currentName(file.stem().string());
    if (camera.rfind("camera_", 0) == 0) rig.cameras[camera] = readCamera(file, camera);
  }
  return rig;
}

}  // namespace atlas::record
