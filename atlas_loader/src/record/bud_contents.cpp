// SPDX-License-Identifier: MIT
#include "record/bud_contents.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "record/scan_store.hpp"

namespace atlas::record {
namespace {
namespace fs = std::filesystem;

const char* const kImuFiles[] = {"imu.txt",      "d_quat.txt", "gnss.txt", "mag.txt",
                                 "pressure.txt", "temp.txt",   "time.txt"};
const char* const kGnssFiles[] = {"pose.txt", "time.txt"};

bool isThere(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// Names in a folder, sorted; empty when there is no such folder.
std::vector<std::string> namesIn(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    names.push_back(it->path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Notes what a folder of the record has besides `known`.
void noteOthers(const fs::path& record, const std::string& folder, const std::set<std::string>& known,
                RecordLog& log) {
  std::vector<std::string> others;
  for (const std::string& name : namesIn(record / folder)) {
    if (known.count(name) == 0) others.push_back(name);
  }
  constexpr std::size_t kShown = 10;
  const std::size_t more = others.size() > kShown ? others.size() - kShown : 0;
  others.resize(others.size() - more);
  if (others.empty()) return;
  log.note((folder.empty() ? "" : folder + "/: ") + std::string("not part of the format, ignored: ") +
           joined(others) + (more > 0 ? " and " + std::to_string(more) + " more" : ""));
}

void noteLidar(const fs::path& record, const std::string& lidar, RecordLog& log) {
  std::set<std::string> known = {"timestamps.txt", "scans", "scans.zip"};
  bool loose = false;
  for (const std::string& name : namesIn(record / lidar)) {
    if (!scanIndex(name)) continue;
    known.insert(name);
    loose = true;
  }
  const int places = (loose ? 1 : 0) + (isThere(record / lidar / "scans") ? 1 : 0) +
                     (isThere(record / lidar / "scans.zip") ? 1 : 0);
  if (places > 1)
    log.note(
        lidar +
        ": scans in several places, read from the first of the folder, scans/ and scans.zip that has any");
  noteOthers(record, lidar, known, log);
}
}  // namespace

void noteMissingFiles(const fs::path& record, RecordLog& log) {
  std::vector<std::string> missing;
  const auto look = [&](const std::string& name) {
    if (!isThere(record / name)) missing.push_back(name);
  };
  for (const char* file : kImuFiles) look("imu/" + std::string(file));
  for (const char* file : kGnssFiles) look("gnss/" + std::string(file));
  for (const char* lidar : {"lidar_left", "lidar_right"}) look(lidar);
  for (const char* camera : kBudCameras) look(camera);
  if (!missing.empty()) log.note("not in this record: " + joined(missing));
}

void noteUnreadFiles(const fs::path& record, RecordLog& log) {
  std::set<std::string> folders = {"imu", "gnss", "radar_ti", "yolo", "calibrations", "output"};
  folders.insert(std::begin(kBudLidars), std::end(kBudLidars));
  folders.insert(std::begin(kBudCameras), std::end(kBudCameras));
  noteOthers(record, "", folders, log);
  noteOthers(record, "imu", {std::begin(kImuFiles), std::end(kImuFiles)}, log);
  noteOthers(record, "gnss", {std::begin(kGnssFiles), std::end(kGnssFiles)}, log);
  noteOthers(record, "radar_ti", {"scans.txt"}, log);
  std::set<std::string> yolo;
  for (const char* camera : kBudCameras) {
    noteOthers(record, camera, {"timestamps.txt", "video.mp4"}, log);
    yolo.insert(std::string(camera) + ".txt");
  }
  noteOthers(record, "yolo", yolo, log);
  for (const char* lidar : kBudLidars) noteLidar(record, lidar, log);
}

void noteMissingFrames(const fs::path& record, const StaticTransforms& rig, RecordLog& log) {
  std::set<std::string> placed, sensors;
  for (const StaticTransform& transform : rig.transforms) placed.insert(transform.child);
  if (isThere(record / "gnss/pose.txt")) sensors.insert("gnss_rear");
  if (isThere(record / "radar_ti/scans.txt")) sensors.insert("radar_ti");
  for (const char* lidar : kBudLidars) {
    if (isThere(record / lidar / "timestamps.txt")) sensors.insert(lidar);
  }
  for (const char* camera : kBudCameras) {
    if (isThere(record / camera / "timestamps.txt")) sensors.insert(camera);
  }
  for (const std::string& sensor : sensors) {
    if (placed.count(sensor) == 0) log.note("calibration: frames.yaml has no frame '" + sensor + "'");
  }
}

}  // namespace atlas::record
