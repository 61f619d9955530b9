// SPDX-License-Identifier: MIT
// A run's output folder against the truth of a synthetic drive, product by product. Nothing is aligned or
// fitted: the run's map and the true map are both east-north-up at an anchor, so WGS84 alone relates them. A
// product that is not there is counted as not compared; a file that makes no sense is too, with its name.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "atlas/base/geodesy.hpp"
#include "atlas/base/geometry.hpp"
#include "atlas/base/trajectory.hpp"
#include "synthetic/evaluation.hpp"
#include "synthetic/truth.hpp"

namespace atlas::synthetic {

struct RunFolders {
  std::filesystem::path truth;   ///< RECORD/truth
  std::filesystem::path record;  ///< for the detections that the run was given
  std::filesystem::path out;     ///< what the run wrote
};

/// Everything below, in order. Throws std::runtime_error when `truth` holds no trajectory or no anchor.
Evaluation evaluateRun(const RunFolders& folders);

/// T_truth_run between two maps: both are rigid in the earth, so it is one rotation and one translation.
Pose betweenMaps(const Geodetic& truth_anchor, const Geodetic& run_anchor);

/// First true stamp with 5 s of driving behind it, when a filter has had its chance to find the heading;
/// nothing when the car never drives that long.
std::optional<Stamp> settledFrom(const std::vector<StampedPose>& truth);

/// Errors of out/trajectory/<name>.tum at the true stamps, over all and after 5 s of driving.
void evaluateTrajectory(const RunFolders& folders, const std::string& name, const Pose& T_truth_run,
                        Evaluation& evaluation);
/// Points of out/deskewed: error in the map, and what is left of it after the best rigid motion of each scan.
void evaluatePoints(const RunFolders& folders, const Pose& T_truth_run, Evaluation& evaluation);
/// Boxes of out/obstacles against what the returns belong to: found objects, wrong boxes, overlap.
void evaluateObstacles(const RunFolders& folders, const Pose& T_truth_run, Evaluation& evaluation);
/// Objects of out/objects: MOTA, HOTA, IDF1, identity switches, velocities, classes, static or dynamic.
void evaluateObjects(const RunFolders& folders, const Pose& T_truth_run, Evaluation& evaluation);
/// Colours of out/map/map.pcd, if it has any, against those of the surfaces.
void evaluateMapColour(const RunFolders& folders, const Pose& T_truth_run, Evaluation& evaluation);
void evaluateDepth(const RunFolders& folders, Evaluation& evaluation);
/// Distances of out/frustums against the nearest visible point of the true object that the detection shows.
void evaluateFrustums(const RunFolders& folders, Evaluation& evaluation);
/// Labels of out/thermal against the true boxes of camera_ir.
void evaluateThermal(const RunFolders& folders, Evaluation& evaluation);

/// Files <6 digits><extension> of a folder with their numbers, sorted; none when there is no such folder.
std::vector<std::pair<int, std::filesystem::path>> numberedFiles(const std::filesystem::path& folder,
                                                                 const std::string& extension);
/// Folders inside a folder, sorted by name.
std::vector<std::string> foldersOf(const std::filesystem::path& folder);

}  // namespace atlas::synthetic
