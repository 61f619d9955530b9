// SPDX-License-Identifier: MIT
#include "synthetic/record_files.hpp"

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

namespace atlas::synthetic {
namespace {

constexpr double kSameObject = 0.5;  // overlap from which a detection is taken to show an object

}  // namespace

std::optional<std::vector<Camera>> camerasOfDrive(const std::filesystem::path& truth) {
  std::ifstream file(truth / "meta.json");
  const auto meta = nlohmann::json::parse(file, nullptr, false);
  if (!meta.is_object() || !meta.contains("rgb_scale") || !meta["rgb_scale"].is_number()) return std::nullopt;
  return rigCameras(meta["rgb_scale"].get<double>());
}

const Camera* cameraNamed(const std::vector<Camera>& cameras, const std::string& name) {
  for (const Camera& camera : cameras) {
    if (camera.name == name) return &camera;
  }
  return nullptr;
}

// Layout B: centre and size by width and height; the left edge of the image is pixel -1/2.
std::map<int, std::vector<FakeDetection>> readDetections(const std::filesystem::path& path,
                                                         const Camera& camera) {
  std::map<int, std::vector<FakeDetection>> detections;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    int frame = 0;
    double cx = 0, cy = 0, w = 0, h = 0;
    FakeDetection d{};
    if (std::sscanf(line.c_str(), "%d, %lf, %lf, %lf, %lf, %lf, %d", &frame, &cx, &cy, &w, &h, &d.confidence,
                    &d.class_id) != 7) {
      continue;
    }
    d.x1 = (cx - 0.5 * w) * camera.width - 0.5;
    d.x2 = (cx + 0.5 * w) * camera.width - 0.5;
    d.y1 = (cy - 0.5 * h) * camera.height - 0.5;
    d.y2 = (cy + 0.5 * h) * camera.height - 0.5;
    detections[frame].push_back(d);
  }
  return detections;
}

std::map<int, Stamp> readFrameStamps(const std::filesystem::path& path) {
  std::map<int, Stamp> stamps;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    long long stamp = 0;
    int frame = 0;
    if (std::sscanf(line.c_str(), "%lld,%d", &stamp, &frame) == 2) stamps[frame] = stamp;
  }
  return stamps;
}

std::map<int, std::vector<TruthBox2d>> readBoxesByFrame(const std::filesystem::path& csv) {
  std::map<int, std::vector<TruthBox2d>> frames;
  for (const TruthBox2d& box : readBoxes2d(csv)) frames[box.frame].push_back(box);
  return frames;
}

const TruthBox2d* objectOf(const FakeDetection& detection, const std::vector<TruthBox2d>& boxes) {
  const TruthBox2d* best = nullptr;
  double most = kSameObject;
  for (const TruthBox2d& box : boxes) {
    const double overlap = overlapOf(detection, box);
    if (box.class_id != detection.class_id || overlap < most) continue;
    best = &box;
    most = overlap;
  }
  return best;
}

}  // namespace atlas::synthetic
