// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>

#include "synthetic/evaluate.hpp"
#include "synthetic/record_files.hpp"

namespace atlas::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr double kFarthest_m = 40.0;  // of the objects that are judged
constexpr double kVisible = 0.5;      // of an object's pixels

bool isJudged(const TruthBox2d& object) {
  return object.visible_fraction >= kVisible && object.depth_m <= kFarthest_m;
}

struct FrustumRow {
  int frame = 0, detection = 0, class_id = 0;
  double distance_m = 0;
};
/// stamp,frame,detection,class,confidence,distance,x,y,z; nothing when the row is broken.
std::optional<FrustumRow> parseRow(const std::string& line) {
  FrustumRow row;
  double confidence = 0;
  long long stamp = 0;
  const int fields = std::sscanf(line.c_str(), "%lld,%d,%d,%d,%lf,%lf", &stamp, &row.frame, &row.detection,
                                 &row.class_id, &confidence, &row.distance_m);
  if (fields != 6 || !std::isfinite(row.distance_m) || row.detection < 0) return std::nullopt;
  return row;
}

struct FrustumErrors {
  std::vector<float> error_m;
  Share answered;

  void append(const FrustumErrors& other) {
    error_m.insert(error_m.end(), other.error_m.begin(), other.error_m.end());
    answered.add(other.answered);
  }
  void report(const std::string& group, Evaluation& evaluation) {
    evaluation.add(group, "distance_error_m", statisticsOf(error_m));
    evaluation.add(group, "detections_answered_percent", answered.percent());
  }
};

/// The detections of a camera that show a true object which is judged, by (frame, index).
std::map<std::pair<int, int>, const TruthBox2d*> judgedDetections(
    const std::map<int, std::vector<FakeDetection>>& detections,
    const std::map<int, std::vector<TruthBox2d>>& boxes) {
  std::map<std::pair<int, int>, const TruthBox2d*> judged;
  for (const auto& [frame, list] : detections) {
    const auto truth = boxes.find(frame);
    if (truth == boxes.end()) continue;
    for (std::size_t i = 0; i < list.size(); ++i) {
      const TruthBox2d* object = objectOf(list[i], truth->second);
      if (object != nullptr && isJudged(*object)) judged[{frame, static_cast<int>(i)}] = object;
    }
  }
  return judged;
}

FrustumErrors compareCamera(const RunFolders& folders, const Camera& camera, Evaluation& evaluation) {
  FrustumErrors errors;
  const fs::path csv = folders.out / "frustums" / (camera.name + ".csv");
  const auto boxes = readBoxesByFrame(folders.truth / "boxes2d" / (camera.name + ".csv"));
  const auto detections = readDetections(folders.record / "yolo" / (camera.name + ".txt"), camera);
  const auto judged = judgedDetections(detections, boxes);
  std::set<std::pair<int, int>> answered;
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);  // title
  while (std::getline(file, line)) {
    const auto row = parseRow(line);
    if (!row) {
      evaluation.skip("frustums/" + camera.name + ".csv: broken row");
      continue;
    }
    const auto object = judged.find({row->frame, row->detection});
    if (object == judged.end() || object->second->class_id != row->class_id) continue;
    answered.insert(object->first);
    errors.error_m.push_back(static_cast<float>(row->distance_m - object->second->depth_m));
  }
  errors.answered = {answered.size(), judged.size()};
  return errors;
}

}  // namespace

void evaluateFrustums(const RunFolders& folders, Evaluation& evaluation) {
  if (!fs::is_directory(folders.out / "frustums")) return evaluation.skip("frustums: no such folder");
  const auto cameras = camerasOfDrive(folders.truth);
  if (!cameras) return evaluation.skip("frustums: no rgb_scale in truth/meta.json");
  FrustumErrors all;
  std::vector<std::pair<std::string, FrustumErrors>> parts;
  for (const Camera& camera : *cameras) {
    if (!fs::exists(folders.out / "frustums" / (camera.name + ".csv"))) continue;
    parts.emplace_back(camera.name, compareCamera(folders, camera, evaluation));
    all.append(parts.back().second);
  }
  all.report("frustums", evaluation);
  for (auto& [name, errors] : parts) errors.report("frustums/" + name, evaluation);
}

}  // namespace atlas::synthetic
