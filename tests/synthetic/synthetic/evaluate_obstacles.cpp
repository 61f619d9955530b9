// SPDX-License-Identifier: MIT
// out/obstacles/obstacles.csv against the returns of the true scans. Whether an object was found is decided
// by whose returns lie in a box; how well the box fits, by its overlap with the whole true object from above.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

#include "synthetic/evaluate.hpp"
#include "synthetic/obstacle_truth.hpp"
#include "synthetic/scene.hpp"

namespace atlas::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr double kRange_m = 30.0;  ///< of the objects and boxes that are judged
constexpr int kFewestPoints = 20;  ///< of an object that has to be found
constexpr double kMargin_m = 0.1;  ///< around a box: noise and the pose's error
constexpr double kBelow_m = 0.4;   ///< a box ends above the ground, what it holds may not
constexpr double kHalf = 0.5, kGoodOverlap = 0.5;

using BoxesByStamp = std::map<Stamp, std::vector<PlanBox>>;
using Census = std::map<int, int>;  ///< returns by owner

BoxesByStamp readBoxes(const fs::path& csv, const Pose& T_truth_run, Evaluation& evaluation) {
  BoxesByStamp boxes;
  const double turn_rad = toRollPitchYaw(T_truth_run.rotation).yaw;
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);  // title
  while (std::getline(file, line)) {
    PlanBox box;
    long long stamp = 0;
    int index = 0;
    double x = 0, y = 0, z = 0, height = 0;
    const int fields = std::sscanf(line.c_str(), "%lld,%d,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &stamp, &index, &x,
                                   &y, &z, &box.yaw_rad, &box.length, &box.width, &height);
    if (fields != 9 || !std::isfinite(x + y + z + box.yaw_rad + box.length + box.width + height)) {
      evaluation.skip("obstacles.csv: broken row");
      continue;
    }
    const Eigen::Vector3d center = T_truth_run * Eigen::Vector3d(x, y, z);
    box.center = center.head<2>();
    box.bottom = center.z() - 0.5 * height;
    box.top = center.z() + 0.5 * height;
    box.yaw_rad += turn_rad;
    boxes[stamp].push_back(box);
  }
  return boxes;
}

struct Result {
  std::uint64_t instants = 0;
  Share found, found_and_fitting;
  std::map<int, Share> found_of_class;
  std::uint64_t boxes = 0, on_objects = 0, on_structures = 0;        ///< right
  std::uint64_t fragments = 0, mixed = 0, on_ground = 0, empty = 0;  ///< wrong
  std::vector<float> overlap;

  void report(const std::string& group, Evaluation& evaluation) {
    const std::uint64_t wrong = fragments + mixed + on_ground + empty;
    evaluation.addCount(group, "instants", instants);
    evaluation.add(group, "objects_found_percent", found.percent());
    for (const auto& [class_id, share] : found_of_class)
      evaluation.add(group, "objects_found_" + toString(static_cast<ObjectClass>(class_id)) + "_percent",
                     share.percent());
    evaluation.add(group, "objects_found_with_half_overlap_percent", found_and_fitting.percent());
    evaluation.add(group, "precision_percent", Share{boxes - wrong, boxes}.percent());
    evaluation.add(group, "precision_without_structures_percent",
                   Share{on_objects, on_objects + wrong}.percent());
    if (auto statistics = statisticsOf(overlap))
      evaluation.add(group, "overlap_from_above_median", statistics->median);
    evaluation.addCount(group, "objects_to_find", found.whole);
    evaluation.addCount(group, "boxes_on_objects", on_objects);
    evaluation.addCount(group, "boxes_on_structures", on_structures);
    evaluation.addCount(group, "boxes_that_are_fragments", fragments);
    evaluation.addCount(group, "boxes_that_mix_things", mixed);
    evaluation.addCount(group, "boxes_on_the_ground", on_ground);
    evaluation.addCount(group, "boxes_of_nothing", empty);
  }
};

Census returnsIn(const PlanBox& box, const std::vector<OwnedPoint>& points) {
  const double reach_m = 0.5 * std::hypot(box.length, box.width) + 2.0 * kMargin_m;
  Census census;
  for (const OwnedPoint& point : points) {
    const double from = point.owner == kOwnerGround ? box.bottom : box.bottom - kBelow_m;
    if (std::abs(point.p.x() - box.center.x()) > reach_m ||
        std::abs(point.p.y() - box.center.y()) > reach_m || point.p.z() < from ||
        point.p.z() > box.top + kMargin_m || !box.holds(point.p.head<2>(), kMargin_m))
      continue;
    ++census[point.owner];
  }
  return census;
}

/// Whoever owns at least half of the returns; nothing when nobody does.
std::optional<int> majorityOf(const Census& census) {
  int all = 0;
  for (const auto& [owner, count] : census) all += count;
  for (const auto& [owner, count] : census) {
    if (count >= kHalf * all) return owner;
  }
  return std::nullopt;
}

/// One instant: a box belongs to the owner of most of its returns and finds an object when it holds at least
/// half of the object's. Further boxes on an object are wrong; where an object is not judged, one is right.
void judge(const std::vector<PlanBox>& boxes, const std::vector<OwnedPoint>& points,
           const std::map<int, TrueObject>& objects, const Eigen::Vector2d& vehicle, Result& result) {
  Census returns;
  for (const OwnedPoint& point : points) ++returns[point.owner];
  std::map<int, const PlanBox*> finder;  // of each object: the box with most of its returns
  std::map<int, int> held;
  for (const PlanBox& box : boxes) {
    if ((box.center - vehicle).norm() > kRange_m + 5.0)
      continue;  // objects at the rim may have their box beyond
    const Census census = returnsIn(box, points);
    const std::optional<int> owner = majorityOf(census);
    if (owner && *owner > 0 && census.at(*owner) > held[*owner]) {
      held[*owner] = census.at(*owner);
      finder[*owner] = &box;
    }
    if ((box.center - vehicle).norm() > kRange_m) continue;
    ++result.boxes;
    if (census.empty())
      ++result.empty;
    else if (!owner)
      ++result.mixed;
    else if (*owner == kOwnerGround)
      ++result.on_ground;
    else if (*owner == kOwnerStructure)
      ++result.on_structures;
    else
      ++result.fragments;  // taken back below for the best box of each object
  }
  for (const auto& [id, box] : finder) {
    if ((box->center - vehicle).norm() > kRange_m) continue;
    --result.fragments;
    ++result.on_objects;
  }
  for (const auto& [id, object] : objects) {
    if ((object.box.center - vehicle).norm() > kRange_m || returns[id] < kFewestPoints) continue;
    const bool found = finder.count(id) != 0 && held[id] >= kHalf * returns[id];
    const double overlap = found ? overlapOfAreas(*finder[id], object.box) : 0.0;
    result.found.add(found);
    result.found_of_class[object.class_id].add(found);
    result.found_and_fitting.add(overlap >= kGoodOverlap);
    if (found) result.overlap.push_back(static_cast<float>(overlap));
  }
}

Trajectory trajectoryOf(const fs::path& tum) {
  Trajectory trajectory;
  for (const StampedPose& pose : readTrajectory(tum)) trajectory.push(pose);
  return trajectory;
}

/// The boxes as the vehicle saw them: where they are once the error of the run's pose is taken out. Those of
/// stamps without a pose stay out.
BoxesByStamp withoutPoseError(const BoxesByStamp& boxes, const RunFolders& folders, const Pose& T_truth_run) {
  const Trajectory truth = trajectoryOf(folders.truth / "trajectory.tum"),
                   run = trajectoryOf(folders.out / "trajectory" / "trajectory.tum");
  BoxesByStamp result;
  for (const auto& [stamp, seen] : boxes) {
    const auto T_map_imu = truth.at(stamp), T_run_imu = run.at(stamp);
    if (!T_map_imu || !T_run_imu) continue;
    const Pose T = *T_map_imu * (T_truth_run * *T_run_imu).inverse();
    for (PlanBox box : seen) {
      const Eigen::Vector3d center =
          T * Eigen::Vector3d(box.center.x(), box.center.y(), 0.5 * (box.bottom + box.top));
      const double half_height = 0.5 * (box.top - box.bottom);
      box.center = center.head<2>();
      box.bottom = center.z() - half_height;
      box.top = center.z() + half_height;
      box.yaw_rad += toRollPitchYaw(T.rotation).yaw;
      result[stamp].push_back(box);
    }
  }
  return result;
}

Result resultOf(const BoxesByStamp& boxes, const ObstacleTruth& truth) {
  Result result;
  if (boxes.empty()) return result;
  for (const Stamp stamp : truth.stamps()) {
    if (stamp < boxes.begin()->first || stamp > boxes.rbegin()->first) continue;  // no pose yet, or no more
    const auto points = truth.pointsAt(stamp);
    const auto vehicle = truth.vehicleAt(stamp);
    if (!points || !vehicle) continue;  // truth is written for every Nth scan
    ++result.instants;
    const auto found = boxes.find(stamp);
    judge(found == boxes.end() ? std::vector<PlanBox>{} : found->second, *points, truth.objectsAt(stamp),
          *vehicle, result);
  }
  return result;
}

}  // namespace

void evaluateObstacles(const RunFolders& folders, const Pose& T_truth_run, Evaluation& evaluation) {
  const fs::path csv = folders.out / "obstacles" / "obstacles.csv";
  if (!fs::exists(csv)) return evaluation.skip("obstacles: no obstacles/obstacles.csv");
  if (!fs::is_directory(folders.truth / "points")) return evaluation.skip("obstacles: no truth of points");
  const BoxesByStamp boxes = readBoxes(csv, T_truth_run, evaluation);
  if (boxes.empty()) return evaluation.skip("obstacles: none in obstacles.csv");
  const ObstacleTruth truth(folders);
  Result result = resultOf(boxes, truth);
  if (result.instants == 0)
    return evaluation.skip("obstacles: no instant with truth of all lidars (make_drive --truth-points 1)");
  result.report("obstacles", evaluation);
  Result as_seen = resultOf(withoutPoseError(boxes, folders, T_truth_run), truth);
  if (as_seen.instants > 0) as_seen.report("obstacles_without_pose_error", evaluation);
}

}  // namespace atlas::synthetic
