// SPDX-License-Identifier: MIT
// RECORD/truth: what really happened, in the true map (ENU at truth/anchor.json). Written with the drive,
// read by tests and by evaluate_run. truth/README.txt describes the files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/geodesy.hpp"
#include "atlas/base/trajectory.hpp"
#include "synthetic/world.hpp"

namespace atlas::synthetic {

/// anchor.json, meta.json, README.txt, trajectory.tum, objects.csv.
void writeTruth(const World& world, const std::filesystem::path& folder);

/// TUM lines "stamp x y z qx qy qz qw"; comment and broken lines are left out. Empty when the file is absent.
/// The stamps are parsed digit by digit, exact to 1 ns.
std::vector<StampedPose> readTrajectory(const std::filesystem::path& tum);
/// {latitude, longitude, altitude} of a JSON file; nothing when it is absent or broken.
std::optional<Geodetic> readAnchor(const std::filesystem::path& json);

struct TruthBox2d {
  Stamp stamp = 0;
  int frame = 0, object = 0, class_id = 0;
  double x1 = 0, y1 = 0, x2 = 0, y2 = 0;  ///< px, outer edges of the visible part
  double visible_fraction = 0;            ///< of the object's pixels within the image
  double depth_m = 0, range_m = 0;        ///< nearest visible point: along the optical axis, straight
};
std::vector<TruthBox2d> readBoxes2d(const std::filesystem::path& csv);

}  // namespace atlas::synthetic
