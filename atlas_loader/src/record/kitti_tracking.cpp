// SPDX-License-Identifier: MIT
#include "record/kitti_tracking.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <tuple>

#include "atlas/base/geodesy.hpp"
#include "record/kitti_rows.hpp"
#include "record/text_rows.hpp"

namespace atlas::record {
namespace {
namespace fs = std::filesystem;

constexpr std::size_t kColumns3d = 15, kColumns2d = 6;
constexpr std::int64_t kMostFrames = 100000;

bool isSequence(const fs::path& path) {
  const std::string stem = path.stem().string();
  return path.extension() == ".txt" && stem.size() == 4 &&
         stem.find_first_not_of("0123456789") == std::string::npos;
}

std::optional<KittiClass> classOfFolder(const fs::path& file) {
  for (fs::path folder = file.parent_path(); folder.has_filename(); folder = folder.parent_path()) {
    const std::string name = folder.filename().string();
    for (const KittiClass c : {KittiClass::kPedestrian, KittiClass::kCar, KittiClass::kCyclist}) {
      if (name.find(toString(c)) != std::string::npos) return c;
    }
  }
  return std::nullopt;
}

KittiDetection parse3d(RowFields& fields) {
  KittiDetection d;
  d.kitti_class = static_cast<KittiClass>(fields.integer(1, "type", 1, 3));
  d.x1 = fields.number(2, "x1");
  d.y1 = fields.number(3, "y1");
  d.x2 = fields.number(4, "x2");
  d.y2 = fields.number(5, "y2");
  d.score = fields.number(6, "score");
  d.has_box = true;
  d.size = {fields.number(9, "l"), fields.number(8, "w"), fields.number(7, "h")};
  d.bottom_camera = {fields.number(10, "x"), fields.number(11, "y"), fields.number(12, "z")};
  d.rotation_y_rad = fields.number(13, "ry");
  return d;
}

KittiDetection parse2d(RowFields& fields, KittiClass kitti_class) {
  KittiDetection d;
  d.kitti_class = kitti_class;
  d.x1 = fields.number(1, "x1");
  d.y1 = fields.number(2, "y1");
  d.x2 = fields.number(3, "x2");
  d.y2 = fields.number(4, "y2");
  d.score = fields.number(5, "score");
  return d;
}

/// "P2: 1 2 3" and, in some files, "R_rect 1 2 3".
std::map<std::string, std::vector<double>> readKeys(const fs::path& file) {
  LineReader lines(file);
  if (!lines.opened()) throw std::runtime_error(file.string() + ": cannot be opened");
  std::map<std::string, std::vector<double>> keys;
  RowFields fields(file.string(), ' ');
  while (const auto line = lines.next()) {
    if (isBlank(line->text)) continue;
    fields.assign(*line);
    std::string key(fields.text(0));
    if (!key.empty() && key.back() == ':') key.pop_back();
    std::vector<double> values;
    for (std::size_t i = 1; i < fields.size(); ++i) values.push_back(fields.number(i, key.c_str()));
    if (!fields.ok()) throw std::runtime_error(fields.example());
    keys[key] = std::move(values);
  }
  return keys;
}

Pose rigid(const std::vector<double>& values, const fs::path& file, const std::string& key) {
  const bool moved = values.size() == 12;
  if (!moved && values.size() != 9)
    throw std::runtime_error(file.string() + ": field " + key + ": 9 or 12 numbers, got " +
                             std::to_string(values.size()));
  Eigen::Matrix3d R;
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  const std::size_t columns = moved ? 4 : 3;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) R(static_cast<int>(i), static_cast<int>(j)) = values[i * columns + j];
    if (moved) t(static_cast<int>(i)) = values[i * columns + 3];
  }
  if ((R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > 1e-3 || R.determinant() < 0)
    throw std::runtime_error(file.string() + ": field " + key + ": not a rotation matrix");
  return {Eigen::Quaterniond(R).normalized(), t};
}

}  // namespace

const char* toString(KittiClass kitti_class) {
  switch (kitti_class) {
    case KittiClass::kPedestrian:
      return "Pedestrian";
    case KittiClass::kCar:
      return "Car";
    case KittiClass::kCyclist:
      return "Cyclist";
  }
  return "DontCare";
}

std::map<std::string, std::vector<fs::path>> findKittiDetections(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": no folder");
  std::map<std::string, std::vector<fs::path>> sequences;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && isSequence(entry.path()))
      sequences[entry.path().stem().string()].push_back(entry.path());
  }
  for (auto& [sequence, files] : sequences) std::sort(files.begin(), files.end());
  return sequences;
}

KittiDetections readKittiDetections(const std::vector<fs::path>& files, RecordLog& log) {
  KittiDetections detections;
  std::set<std::tuple<std::int64_t, int, double, double, double, double, double>> known;
  for (const fs::path& file : files) {
    LineReader lines(file);
    const std::string name = file.parent_path().filename().string() + "/" + file.filename().string();
    RowFields fields(name, ',');
    const auto folder_class = classOfFolder(file);
    while (const auto line = lines.next()) {
      if (isBlank(line->text)) continue;
      ++log.file(name).rows;
      fields.assign(*line);
      if (fields.size() != kColumns2d) fields.expect(kColumns3d);
      const auto frame = fields.integer(0, "frame", 0, kMostFrames);
      const bool is_2d = fields.size() == kColumns2d;
      if (is_2d && !folder_class) fields.fail("class unknown", "no folder is called after a class");
      KittiDetection d;
      if (fields.ok()) d = is_2d ? parse2d(fields, *folder_class) : parse3d(fields);
      if (!fields.ok()) {
        log.skip(name, fields.reason(), fields.example());
        continue;
      }
      if (!known.emplace(frame, static_cast<int>(d.kitti_class), d.x1, d.y1, d.x2, d.y2, d.score).second) {
        log.skip(name, "the same detection in another file");
        continue;
      }
      ++log.file(name).used;
      std::vector<KittiDetection>& list = detections[static_cast<std::uint32_t>(frame)];
      d.index = static_cast<std::uint32_t>(list.size());
      list.push_back(d);
    }
  }
  return detections;
}

KittiTrackingCalibration readKittiTrackingCalibration(const fs::path& file) {
  auto keys = readKeys(file);
  const auto get = [&](const std::string& name, const std::string& other) {
    for (const std::string& key : {name, other}) {
      if (keys.count(key) != 0) return keys.at(key);
    }
    throw std::runtime_error(file.string() + ": field " + name + " is missing");
  };
  const Pose T_velo_imu = rigid(get("Tr_imu_to_velo", "Tr_imu_velo"), file, "Tr_imu_to_velo");
  const Pose T_cam_velo = rigid(get("Tr_velo_to_cam", "Tr_velo_cam"), file, "Tr_velo_to_cam");
  const Pose T_rect_cam = rigid(get("R0_rect", "R_rect"), file, "R0_rect");
  KittiTrackingCalibration calibration;
  calibration.T_imu_camera = (T_rect_cam * T_cam_velo * T_velo_imu).inverse();
  const auto p = get("P2", "P2");
  if (p.size() != 12)
    throw std::runtime_error(file.string() + ": field P2: 12 numbers, got " + std::to_string(p.size()));
  calibration.P2 = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(p.data());
  return calibration;
}

std::vector<Pose> readKittiTrackingPoses(const fs::path& oxts_file) {
  LineReader lines(oxts_file);
  if (!lines.opened()) throw std::runtime_error(oxts_file.string() + ": cannot be opened");
  std::vector<Pose> poses;
  std::optional<LocalEnu> enu;
  RowFields fields(oxts_file.string(), ' ');
  while (const auto line = lines.next()) {
    if (isBlank(line->text)) continue;
    fields.assign(*line);
    const OxtsSample sample = parseOxts(fields, kSecond);
    if (!fields.ok()) throw std::runtime_error(fields.example());
    if (!enu) enu.emplace(sample.fix.position);
    poses.push_back({*sample.imu.orientation, enu->toMap(sample.fix.position)});
  }
  return poses;
}

}  // namespace atlas::record
