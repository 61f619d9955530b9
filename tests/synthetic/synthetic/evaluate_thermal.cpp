// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>

#include "synthetic/evaluate.hpp"
#include "synthetic/record_files.hpp"
#include "synthetic/thermal_ceiling.hpp"

namespace atlas::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSource = "camera_left_front";  // whose detections become labels
constexpr double kTouches = 0.1;                      // overlap from which a label belongs to an object
constexpr double kVisible = 0.5, kHidden = 0.3;       // of an object's pixels
constexpr double kNear_m = 40.0;
constexpr Duration kNearInTime = 50 * kMillisecond;  // the run pairs images up to this difference

struct Label {
  double x1, y1, x2, y2;  ///< px
  int class_id;
};

struct ThermalErrors {
  std::vector<double> overlap, ceiling, overlap_with_ceiling;
  Share of_nothing, of_hidden;  ///< of all labels
  std::uint64_t riders = 0, broken = 0;
  Share recall, recall_of_detected, recall_near, recall_of_detected_near;
};

/// What is known about one labelled frame.
struct Frame {
  std::vector<Label> labels;
  std::vector<TruthBox2d> thermal_truth;
  SourceImage source;  ///< the RGB image nearest in time
  std::vector<TruthBox2d> source_truth;
  Stamp thermal_stamp = 0;
};

std::vector<Label> readLabels(const fs::path& path, const Camera& camera, std::uint64_t& broken) {
  std::vector<Label> labels;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    fields.imbue(std::locale::classic());
    int class_id = 0;
    double cx = 0, cy = 0, w = 0, h = 0;
    if (!(fields >> class_id >> cx >> cy >> w >> h) || !(std::min(w, h) > 0.0)) {
      ++broken;
      continue;
    }
    // The left edge of the image is pixel -1/2, as in the detections.
    labels.push_back({(cx - 0.5 * w) * camera.width - 0.5, (cy - 0.5 * h) * camera.height - 0.5,
                      (cx + 0.5 * w) * camera.width - 0.5, (cy + 0.5 * h) * camera.height - 0.5, class_id});
  }
  return labels;
}

/// The frame nearest in time, up to kNearInTime.
std::optional<int> nearestFrame(const std::map<int, Stamp>& stamps, Stamp stamp) {
  std::optional<int> nearest;
  Duration smallest = kNearInTime;
  for (const auto& [frame, at] : stamps) {
    if (std::llabs(at - stamp) > smallest) continue;
    smallest = std::llabs(at - stamp);
    nearest = frame;
  }
  return nearest;
}

/// Object of each label, one label an object, best overlaps first; null for none.
std::vector<const TruthBox2d*> assign(const std::vector<Label>& labels,
                                      const std::vector<TruthBox2d>& truth) {
  struct Pair {
    double overlap;
    std::size_t label, object;
  };
  std::vector<Pair> pairs;
  for (std::size_t l = 0; l < labels.size(); ++l) {
    for (std::size_t o = 0; o < truth.size(); ++o) {
      const double overlap = overlapOf(labels[l], truth[o]);
      if (labels[l].class_id == truth[o].class_id && overlap >= kTouches) pairs.push_back({overlap, l, o});
    }
  }
  std::sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) {
    return a.overlap != b.overlap ? a.overlap > b.overlap
                                  : std::tie(a.label, a.object) < std::tie(b.label, b.object);
  });
  std::vector<const TruthBox2d*> object_of(labels.size(), nullptr);
  std::vector<bool> taken(truth.size(), false);
  for (const Pair& pair : pairs) {
    if (object_of[pair.label] != nullptr || taken[pair.object]) continue;
    object_of[pair.label] = &truth[pair.object];
    taken[pair.object] = true;
  }
  return object_of;
}

/// A person on a bicycle is part of the bicycle in the truth: neither right nor wrong here.
bool isRider(const Label& label, const std::vector<TruthBox2d>& truth) {
  return label.class_id == static_cast<int>(ObjectClass::kPerson) &&
         std::any_of(truth.begin(), truth.end(), [&](const TruthBox2d& box) {
           return box.class_id == static_cast<int>(ObjectClass::kBicycle) &&
                  overlapOf(label, box) >= kTouches;
         });
}

const FakeDetection* detectionOf(int object, const Frame& frame) {
  for (const FakeDetection& detection : frame.source.detections) {
    const TruthBox2d* shown = objectOf(detection, frame.source_truth);
    if (shown != nullptr && shown->object == object) return &detection;
  }
  return nullptr;
}

const TruthBox2d* boxOf(int object, const std::vector<TruthBox2d>& boxes) {
  const auto at =
      std::find_if(boxes.begin(), boxes.end(), [&](const TruthBox2d& b) { return b.object == object; });
  return at == boxes.end() ? nullptr : &*at;
}

void compareLabels(const Frame& frame, const std::vector<const TruthBox2d*>& object_of,
                   const ThermalCeiling& ceiling, ThermalErrors& errors) {
  for (std::size_t i = 0; i < frame.labels.size(); ++i) {
    const TruthBox2d* object = object_of[i];
    if (object == nullptr && isRider(frame.labels[i], frame.thermal_truth)) {
      ++errors.riders;
      continue;
    }
    errors.of_nothing.add(object == nullptr);
    errors.of_hidden.add(object != nullptr && object->visible_fraction < kHidden);
    if (object == nullptr) continue;
    const double overlap = overlapOf(frame.labels[i], *object);
    errors.overlap.push_back(overlap);
    const FakeDetection* detection = detectionOf(object->object, frame);
    const TruthBox2d* seen = boxOf(object->object, frame.source_truth);
    if (detection == nullptr || seen == nullptr) continue;
    const auto best = ceiling.boxOf(*detection, seen->depth_m, frame.source.stamp, frame.thermal_stamp);
    if (!best) continue;
    errors.ceiling.push_back(overlapOf(*best, *object));
    errors.overlap_with_ceiling.push_back(overlap);
  }
}

void compareRecall(const Frame& frame, const std::vector<const TruthBox2d*>& object_of,
                   ThermalErrors& errors) {
  for (const TruthBox2d& object : frame.thermal_truth) {
    const TruthBox2d* seen = boxOf(object.object, frame.source_truth);
    if (object.visible_fraction < kVisible || seen == nullptr || seen->visible_fraction < kVisible) continue;
    const bool found = std::find(object_of.begin(), object_of.end(), &object) != object_of.end();
    const bool is_near = object.depth_m <= kNear_m;
    errors.recall.add(found);
    if (is_near) errors.recall_near.add(found);
    if (detectionOf(object.object, frame) == nullptr) continue;
    errors.recall_of_detected.add(found);
    if (is_near) errors.recall_of_detected_near.add(found);
  }
}

std::optional<double> mean(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

void report(const ThermalErrors& errors, Evaluation& evaluation) {
  const std::string group = "thermal_labels";
  evaluation.add(group, "mean_overlap", mean(errors.overlap));
  evaluation.add(group, "mean_overlap_ceiling", mean(errors.ceiling));
  const auto ceiling = mean(errors.ceiling), reached = mean(errors.overlap_with_ceiling);
  if (ceiling && reached && *ceiling > 0.0)
    evaluation.add(group, "share_of_ceiling_percent", 100.0 * *reached / *ceiling);
  evaluation.add(group, "recall_percent", errors.recall.percent());
  evaluation.add(group, "recall_of_detected_percent", errors.recall_of_detected.percent());
  evaluation.add(group, "recall_within_40_m_percent", errors.recall_near.percent());
  evaluation.add(group, "recall_of_detected_within_40_m_percent", errors.recall_of_detected_near.percent());
  evaluation.add(group, "of_nothing_percent", errors.of_nothing.percent());
  evaluation.add(group, "of_hidden_percent", errors.of_hidden.percent());
  evaluation.addCount(group, "labels", errors.of_nothing.whole);
  if (errors.riders > 0) evaluation.skip("thermal labels: person on a bicycle", errors.riders);
  if (errors.broken > 0) evaluation.skip("thermal labels: broken row", errors.broken);
}

}  // namespace

void evaluateThermal(const RunFolders& folders, Evaluation& evaluation) {
  const auto files = numberedFiles(folders.out / "thermal" / "labels", ".txt");
  if (files.empty()) return evaluation.skip("thermal: no labels");
  const auto cameras = camerasOfDrive(folders.truth);
  if (!cameras) return evaluation.skip("thermal: no rgb_scale in truth/meta.json");
  const Camera &thermal = *cameraNamed(*cameras, "camera_ir"), &rgb = *cameraNamed(*cameras, kSource);
  const auto thermal_truth = readBoxesByFrame(folders.truth / "boxes2d" / "camera_ir.csv");
  const auto source_truth = readBoxesByFrame(folders.truth / "boxes2d" / (rgb.name + ".csv"));
  const auto detections = readDetections(folders.record / "yolo" / (rgb.name + ".txt"), rgb);
  const auto thermal_stamps = readFrameStamps(folders.record / "camera_ir" / "timestamps.txt");
  const auto source_stamps = readFrameStamps(folders.record / rgb.name / "timestamps.txt");
  const ThermalCeiling ceiling(rgb, thermal, readTrajectory(folders.truth / "trajectory.tum"));
  ThermalErrors errors;
  const auto listed = [](const auto& map, int key) {
    const auto at = map.find(key);
    return at == map.end() ? typename std::decay_t<decltype(map)>::mapped_type{} : at->second;
  };
  for (const auto& [number, path] : files) {
    const auto stamp = thermal_stamps.find(number);
    if (stamp == thermal_stamps.end()) {
      evaluation.skip("thermal labels: frame that the record does not have");
      continue;
    }
    Frame frame;
    frame.labels = readLabels(path, thermal, errors.broken);
    frame.thermal_truth = listed(thermal_truth, number);
    frame.thermal_stamp = stamp->second;
    if (const auto nearest = nearestFrame(source_stamps, frame.thermal_stamp)) {
      frame.source = {source_stamps.at(*nearest), listed(detections, *nearest)};
      frame.source_truth = listed(source_truth, *nearest);
    }
    const auto object_of = assign(frame.labels, frame.thermal_truth);
    compareLabels(frame, object_of, ceiling, errors);
    compareRecall(frame, object_of, errors);
  }
  report(errors, evaluation);
}

}  // namespace atlas::synthetic
