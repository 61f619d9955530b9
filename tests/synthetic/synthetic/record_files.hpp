// SPDX-License-Identifier: MIT
// What evaluate_run reads back from a synthetic record, and how boxes of a picture are compared.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "synthetic/boxes2d.hpp"
#include "synthetic/rig.hpp"
#include "synthetic/truth.hpp"

namespace atlas::synthetic {

/// The cameras of the drive; nothing when truth/meta.json does not tell their scale.
std::optional<std::vector<Camera>> camerasOfDrive(const std::filesystem::path& truth);
const Camera* cameraNamed(const std::vector<Camera>& cameras, const std::string& name);

/// yolo/<camera>.txt of a synthetic record (layout B) by frame, in the order of the file, px.
std::map<int, std::vector<FakeDetection>> readDetections(const std::filesystem::path& file,
                                                         const Camera& camera);
/// <camera>/timestamps.txt: stamp by frame.
std::map<int, Stamp> readFrameStamps(const std::filesystem::path& file);
/// truth/boxes2d by frame.
std::map<int, std::vector<TruthBox2d>> readBoxesByFrame(const std::filesystem::path& csv);

/// Intersection over union of two boxes with x1 y1 x2 y2.
template <class A, class B>
double overlapOf(const A& a, const B& b) {
  const double width = std::min(a.x2, b.x2) - std::max(a.x1, b.x1);
  const double height = std::min(a.y2, b.y2) - std::max(a.y1, b.y1);
  if (width <= 0.0 || height <= 0.0) return 0.0;
  const double both = width * height;
  return both / ((a.x2 - a.x1) * (a.y2 - a.y1) + (b.x2 - b.x1) * (b.y2 - b.y1) - both);
}
/// The true object that a detection shows: its class, the largest overlap, at least one half; else null.
const TruthBox2d* objectOf(const FakeDetection& detection, const std::vector<TruthBox2d>& boxes);

}  // namespace atlas::synthetic
