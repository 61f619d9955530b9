// SPDX-License-Identifier: MIT
#include "synthetic/evaluate.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace atlas::synthetic {
namespace {

namespace fs = std::filesystem;

}  // namespace

Pose betweenMaps(const Geodetic& truth_anchor, const Geodetic& run_anchor) {
  const LocalEnu truth(truth_anchor), run(run_anchor);
  constexpr double kLever_m = 1000.0;  // long enough that rounding of the geodesy (1 nm) turns nothing
  const auto inTruth = [&](const Eigen::Vector3d& p_run) { return truth.toMap(run.toGeodetic(p_run)); };
  const Eigen::Vector3d origin = inTruth(Eigen::Vector3d::Zero());
  Eigen::Matrix3d R;
  for (int axis = 0; axis < 3; ++axis)
    R.col(axis) = (inTruth(kLever_m * Eigen::Vector3d::Unit(axis)) - origin) / kLever_m;
  return {Eigen::Quaterniond(R).normalized(), origin};
}

std::vector<std::pair<int, fs::path>> numberedFiles(const fs::path& folder, const std::string& extension) {
  std::vector<std::pair<int, fs::path>> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string stem = entry.path().stem().string();
    const bool is_number = stem.size() == 6 && stem.find_first_not_of("0123456789") == std::string::npos;
    if (is_number && entry.path().extension() == extension) files.emplace_back(std::stoi(stem), entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> foldersOf(const fs::path& folder) {
  std::vector<std::string> names;
  if (!fs::is_directory(folder)) return names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Evaluation evaluateRun(const RunFolders& folders) {
  const auto truth_anchor = readAnchor(folders.truth / "anchor.json");
  if (!truth_anchor || !fs::exists(folders.truth / "trajectory.tum"))
    throw std::runtime_error(folders.truth.string() +
                             ": no anchor.json with trajectory.tum of a synthetic drive");
  Evaluation evaluation;
  const auto run_anchor = readAnchor(folders.out / "trajectory" / "anchor.json");
  if (run_anchor) {
    const Pose T_truth_run = betweenMaps(*truth_anchor, *run_anchor);
    evaluateTrajectory(folders, "trajectory", T_truth_run, evaluation);
    if (fs::exists(folders.out / "trajectory" / "smoothed.tum"))
      evaluateTrajectory(folders, "smoothed", T_truth_run, evaluation);
    evaluatePoints(folders, T_truth_run, evaluation);
    evaluateObstacles(folders, T_truth_run, evaluation);
    evaluateObjects(folders, T_truth_run, evaluation);
    evaluateMapColour(folders, T_truth_run, evaluation);
  } else {
    evaluation.skip("trajectory and points: no trajectory/anchor.json");
  }
  evaluateDepth(folders, evaluation);
  evaluateFrustums(folders, evaluation);
  evaluateThermal(folders, evaluation);
  return evaluation;
}

}  // namespace atlas::synthetic
