// SPDX-License-Identifier: MIT
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "atlas/output/pcd.hpp"
#include "synthetic/evaluate.hpp"
#include "synthetic/record_files.hpp"
#include "synthetic/rigid_fit.hpp"
#include "synthetic/scan_files.hpp"

namespace atlas::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr double kDegree = M_PI / 180.0;

struct PointErrors {
  std::vector<float> static_m, object_m, distortion_m;  ///< by point
  std::vector<float> settled_m;                         ///< of static points, after 5 s of driving
  std::vector<float> scan_turn_deg;                     ///< by scan: rotation of the best rigid motion
  Share lost;                                           ///< returns without a point
  std::uint64_t invented = 0;

  void append(const PointErrors& other) {
    const auto join = [](std::vector<float>& to, const std::vector<float>& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    join(static_m, other.static_m);
    join(settled_m, other.settled_m);
    join(object_m, other.object_m);
    join(distortion_m, other.distortion_m);
    join(scan_turn_deg, other.scan_turn_deg);
    lost.add(other.lost);
    invented += other.invented;
  }
  void report(const std::string& group, Evaluation& evaluation) {
    evaluation.add(group, "static_error_m", statisticsOf(static_m));
    evaluation.add(group, "static_error_after_5_s_of_driving_m", statisticsOf(settled_m));
    evaluation.add(group, "object_error_m", statisticsOf(object_m));
    evaluation.add(group, "distortion_m", statisticsOf(distortion_m));
    evaluation.add(group, "scan_turn_deg", statisticsOf(scan_turn_deg));
    evaluation.add(group, "returns_lost_percent", lost.percent());
    if (lost.whole > 0) evaluation.addCount(group, "returns_invented", invented);
  }
};

std::string wholeFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

void compareScan(const std::vector<LidarPoint>& run, const std::vector<TruthPoint>& truth,
                 const Pose& T_truth_run, PointErrors& errors) {
  std::vector<PointPair> pairs;
  pairs.reserve(truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const bool is_return = std::isfinite(truth[i].x),
               is_answered = std::isfinite(run[i].x + run[i].y + run[i].z);
    if (is_return) errors.lost.add(!is_answered);
    errors.invented += is_answered && !is_return ? 1 : 0;
    if (!is_return || !is_answered) continue;
    const Eigen::Vector3d p = T_truth_run * Eigen::Vector3f(run[i].x, run[i].y, run[i].z).cast<double>();
    const Eigen::Vector3f q(truth[i].x, truth[i].y, truth[i].z);
    const auto error = static_cast<float>((p - q.cast<double>()).norm());
    (truth[i].object == 0.0F ? errors.static_m : errors.object_m).push_back(error);
    if (truth[i].object == 0.0F) pairs.emplace_back(p.cast<float>(), q);
  }
  const std::optional<Pose> T = rigidFit(pairs);
  if (!T) return;
  for (const PointPair& pair : pairs) {
    const Eigen::Vector3d left = *T * pair.first.cast<double>() - pair.second.cast<double>();
    errors.distortion_m.push_back(static_cast<float>(left.norm()));
  }
  errors.scan_turn_deg.push_back(static_cast<float>(logSo3(T->rotation).norm() / kDegree));
}

/// Index of the first scan after 5 s of driving; nothing when the record does not tell.
std::optional<int> settledScan(const RunFolders& folders, const std::string& lidar) {
  const auto settled = settledFrom(readTrajectory(folders.truth / "trajectory.tum"));
  if (!settled) return std::nullopt;
  for (const auto& [index, stamp] : readFrameStamps(folders.record / lidar / "timestamps.txt")) {
    if (stamp >= *settled) return index;
  }
  return std::nullopt;
}

PointErrors compareLidar(const RunFolders& folders, const std::string& lidar, const Pose& T_truth_run,
                         Evaluation& evaluation) {
  PointErrors errors;
  const std::string label = "deskewed/" + lidar;
  const std::optional<int> settled = settledScan(folders, lidar);
  for (const auto& [index, path] : numberedFiles(folders.truth / "points" / lidar, ".bin")) {
    const fs::path file = folders.out / "deskewed" / lidar / (path.stem().string() + ".pcd");
    if (!fs::exists(file)) {
      evaluation.skip(label + ": scan with truth but no file");
      continue;
    }
    const std::vector<TruthPoint> truth = readTruthPoints(path);
    const auto run = decodePcd(wholeFile(file));
    if (truth.empty()) {
      evaluation.skip(label + ": truth cannot be read: " + path.string());
    } else if (!run) {
      evaluation.skip(label + ": cannot be read: " + file.string());
    } else if (run->size() != truth.size()) {
      evaluation.skip(label + ": " + file.string() + " has " + std::to_string(run->size()) +
                      " points, the scan " + std::to_string(truth.size()));
    } else {
      const auto before = static_cast<std::ptrdiff_t>(errors.static_m.size());
      compareScan(*run, truth, T_truth_run, errors);
      if (settled && index >= *settled)
        errors.settled_m.insert(errors.settled_m.end(), errors.static_m.begin() + before,
                                errors.static_m.end());
    }
  }
  return errors;
}

/// Standard deviation of the noise along the beam; nothing when the drive does not tell.
std::optional<double> rangeNoise(const fs::path& truth) {
  std::ifstream file(truth / "meta.json");
  const auto meta = nlohmann::json::parse(file, nullptr, false);
  const auto pointer = nlohmann::json::json_pointer("/noise/lidar_range_m");
  if (meta.is_discarded() || !meta.contains(pointer) || !meta[pointer].is_number()) return std::nullopt;
  return meta[pointer].get<double>();
}

}  // namespace

void evaluatePoints(const RunFolders& folders, const Pose& T_truth_run, Evaluation& evaluation) {
  if (!fs::is_directory(folders.out / "deskewed"))
    return evaluation.skip("deskewed: no such folder (written with --write deskewed only)");
  PointErrors all;
  std::vector<std::pair<std::string, PointErrors>> lidars;
  for (const std::string& lidar : foldersOf(folders.truth / "points")) {
    lidars.emplace_back(lidar, compareLidar(folders, lidar, T_truth_run, evaluation));
    all.append(lidars.back().second);
  }
  if (all.lost.whole == 0) return;
  all.report("points", evaluation);
  // Noise acts along the beam and is normal: quantiles 0.75 and 0.975 of the normal distribution.
  if (const auto sigma_m = rangeNoise(folders.truth)) {
    evaluation.add("points", "noise_floor_median_m", 0.67449 * *sigma_m);
    evaluation.add("points", "noise_floor_p95_m", 1.95996 * *sigma_m);
  }
  for (auto& [lidar, errors] : lidars) errors.report("points/" + lidar, evaluation);
}

}  // namespace atlas::synthetic
