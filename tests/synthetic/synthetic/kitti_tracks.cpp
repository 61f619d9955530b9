// SPDX-License-Identifier: MIT
#include "synthetic/kitti_tracks.hpp"

#include <algorithm>
#include <fstream>
#include <locale>
#include <sstream>
#include <stdexcept>

#include "synthetic/plan_box.hpp"

namespace atlas::synthetic {
namespace {

constexpr double kLeastHeight_px = 25.0, kDontCareOverlap = 0.5;
constexpr int kMostOccluded = 2, kMostTruncated = 0;

struct Row {
  int frame = 0, id = 0, truncated = 0, occluded = 0;
  std::string type;
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0, score = 0;
  PlanBox box;  ///< x right, y forward; bottom and top are heights
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::vector<Row> readRows(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path.string() + ": cannot be opened");
  std::vector<Row> rows;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.find_first_not_of(" \r\t") == std::string::npos) continue;
    std::istringstream fields(line);
    fields.imbue(std::locale::classic());
    Row row;
    double truncated = 0, alpha = 0, height = 0, x = 0, y = 0, z = 0, rotation_y = 0;
    if (!(fields >> row.frame >> row.id >> row.type >> truncated >> row.occluded >> alpha >> row.x1 >>
          row.y1 >> row.x2 >> row.y2 >> height >> row.box.width >> row.box.length >> x >> y >> z >>
          rotation_y) ||
        row.frame < 0)
      throw std::runtime_error(path.string() + ":" + std::to_string(number) +
                               ": 17 fields of a track, got '" + line + "'");
    fields >> row.score;
    row.truncated = static_cast<int>(truncated);
    row.type = lower(row.type);
    row.box.center = {x, z};
    row.box.yaw_rad = -rotation_y;
    row.box.bottom = -y;
    row.box.top = height - y;
    rows.push_back(row);
  }
  return rows;
}

/// Of the boxes' volumes.
double overlap3d(const PlanBox& a, const PlanBox& b) {
  const double height = std::min(a.top, b.top) - std::max(a.bottom, b.bottom);
  if (height <= 0.0) return 0.0;
  const double both = sharedArea(a, b) * height;
  const double either =
      a.length * a.width * (a.top - a.bottom) + b.length * b.width * (b.top - b.bottom) - both;
  return either > 0.0 ? both / either : 0.0;
}

/// Share of the track's image box that lies in a region which nobody labelled.
double shareInside(const Row& track, const Row& region) {
  const double w = std::min(track.x2, region.x2) - std::max(track.x1, region.x1);
  const double h = std::min(track.y2, region.y2) - std::max(track.y1, region.y1);
  if (w <= 0.0 || h <= 0.0) return 0.0;
  return w * h / ((track.x2 - track.x1) * (track.y2 - track.y1));
}

}  // namespace

std::vector<ScoredFrame> readKittiTracks(const std::filesystem::path& labels,
                                         const std::filesystem::path& results,
                                         const std::string& kitti_class) {
  const std::string wanted = lower(kitti_class);
  const std::string neighbour = wanted == "car" ? "van" : wanted == "pedestrian" ? "person_sitting" : "";
  std::map<int, std::vector<Row>> truths, regions, tracks;
  int last = -1;
  for (const Row& row : readRows(labels)) {
    last = std::max(last, row.frame);
    if (row.type == "dontcare") regions[row.frame].push_back(row);
    if (row.type == wanted || (!neighbour.empty() && row.type == neighbour)) truths[row.frame].push_back(row);
  }
  for (const Row& row : readRows(results)) {
    if (row.type == wanted) tracks[row.frame].push_back(row);
  }
  std::vector<ScoredFrame> frames;
  for (int f = 0; f <= last; ++f) {
    ScoredFrame frame;
    for (const Row& track : tracks[f]) {
      const bool small = track.y2 - track.y1 <= kLeastHeight_px;
      const bool unlabelled = std::any_of(regions[f].begin(), regions[f].end(), [&](const Row& region) {
        return shareInside(track, region) > kDontCareOverlap;
      });
      frame.tracks.push_back({track.id, track.score, small || unlabelled});
    }
    for (const Row& truth : truths[f]) {
      const bool hard = truth.occluded > kMostOccluded || truth.truncated > kMostTruncated;
      frame.truths.push_back({truth.id, hard || truth.type != wanted});
      frame.similarity.emplace_back();
      for (const Row& track : tracks[f]) frame.similarity.back().push_back(overlap3d(truth.box, track.box));
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace atlas::synthetic
