// SPDX-License-Identifier: MIT
// out/objects/objects.csv against the true objects. An object has to be known while some of its returns are
// in the newest scans; one that nobody can see counts neither for nor against. Boxes on houses, trees and
// poles are no objects of the truth and no errors either, unless the run gives them the class of an object.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <set>

#include "synthetic/evaluate.hpp"
#include "synthetic/obstacle_truth.hpp"
#include "synthetic/tracking_score.hpp"

namespace atlas::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr double kRange_m = 40.0;
constexpr int kFewestPoints = 10;    ///< returns of an object that has to be known
constexpr double kFarApart_m = 4.0;  ///< between the middles: similarity 0; half of it still is the object
constexpr double kSame = 0.5;
constexpr double kMoves_mps = 0.5;
constexpr double kMargin_m = 0.3;
constexpr double kSight = 0.02;     ///< half of the angle in which something hides an object, rad
constexpr int kHiding = 5;          ///< so many returns in it
constexpr double kSeenShare = 0.5;  ///< of an object in an image, for a camera to have told its class,
constexpr double kSeenLeast_px =
    8.0;  ///< and the smaller side of its box there: that of the smallest detections

struct RunObject {
  int id = 0, class_id = 0, is_static = 0;
  PlanBox box;
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
};
using RunObjects = std::map<Stamp, std::vector<RunObject>>;

RunObjects readRunObjects(const fs::path& csv, const Pose& T_truth_run, Evaluation& evaluation) {
  RunObjects objects;
  const double turn_rad = toRollPitchYaw(T_truth_run.rotation).yaw;
  std::ifstream file(csv);
  std::string line;
  std::getline(file, line);  // title
  while (std::getline(file, line)) {
    RunObject o;
    long long stamp = 0;
    double probability = 0, x = 0, y = 0, z = 0, height = 0, vx = 0, vy = 0, vz = 0, age = 0;
    const int fields =
        std::sscanf(line.c_str(), "%lld,%d,%d,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%d,%lf", &stamp,
                    &o.id, &o.class_id, &probability, &x, &y, &z, &o.box.yaw_rad, &o.box.length, &o.box.width,
                    &height, &vx, &vy, &vz, &o.is_static, &age);
    if (fields != 16 ||
        !std::isfinite(x + y + z + o.box.yaw_rad + o.box.length + o.box.width + height + vx + vy)) {
      evaluation.skip("objects.csv: broken row");
      continue;
    }
    const Eigen::Vector3d center = T_truth_run * Eigen::Vector3d(x, y, z);
    o.box.center = center.head<2>();
    o.box.bottom = center.z() - 0.5 * height;
    o.box.top = center.z() + 0.5 * height;
    o.box.yaw_rad += turn_rad;
    o.velocity = (T_truth_run.rotation * Eigen::Vector3d(vx, vy, vz)).head<2>();
    objects[stamp].push_back(o);
  }
  return objects;
}

/// First stamp at which a camera showed an object well enough.
std::map<int, Stamp> seenByCamera(const fs::path& truth) {
  std::map<int, Stamp> first;
  if (!fs::is_directory(truth / "boxes2d")) return first;
  for (const auto& entry : fs::directory_iterator(truth / "boxes2d")) {
    if (entry.path().stem() == "camera_ir") continue;
    for (const TruthBox2d& box : readBoxes2d(entry.path())) {
      if (box.visible_fraction < kSeenShare || std::min(box.x2 - box.x1, box.y2 - box.y1) < kSeenLeast_px)
        continue;
      const auto [it, is_new] = first.emplace(box.object, box.stamp);
      if (!is_new) it->second = std::min(it->second, box.stamp);
    }
  }
  return first;
}

struct Result {
  ScoredSequences frames = ScoredSequences(1);
  double object_seconds = 0;
  std::vector<float> speed_error, velocity_error, position_error, yaw_error;
  Share class_right, class_right_seen, motion_right, dynamic_right, false_dynamic, structures_dynamic;
};

/// True objects that matter at an instant, with how they are matched to what the run says.
class Instant {
 public:
  Instant(const std::vector<RunObject>& run, const std::map<int, TrueObject>& truth,
          const std::vector<OwnedPoint>& points, const Eigen::Vector2d& vehicle,
          const std::map<int, int>& kept)
      : run_(run), points_(points), vehicle_(vehicle) {
    std::map<int, int> returns;
    for (const OwnedPoint& point : points) ++returns[point.owner];
    for (const auto& [id, object] : truth) {
      const double distance = (object.box.center - vehicle).norm();
      if (distance > kRange_m + 5.0) continue;
      frame.truths.push_back({id, returns[id] < kFewestPoints || distance > kRange_m});
      truths_.push_back(&object);
    }
    frame.similarity.resize(frame.truths.size());
    for (const RunObject& object : run) {
      const bool far = (object.box.center - vehicle).norm() > kRange_m;
      const Ground ground = object.class_id < 0 ? groundOf(object) : Ground::kObject;
      frame.tracks.push_back({object.id, 0.0, far || ground != Ground::kObject || isOnIgnored(object)});
      for (std::size_t i = 0; i < truths_.size(); ++i) {
        // a tree above a car is no answer to the car
        const double apart = (truths_[i]->box.center - object.box.center).norm();
        const bool may_be = ground != Ground::kStructure;
        frame.similarity[i].push_back(may_be ? std::max(0.0, 1.0 - apart / kFarApart_m) : 0.0);
      }
    }
    pair = pairsOf(frame, kSame, kept);
  }
  /// What the newest scans show where the run says that something is.
  enum class Ground {
    kObject,     ///< what is judged
    kStructure,  ///< a house, a tree, a pole
    kHidden      ///< nothing, with something nearer before it: the run may well know more than these scans
  };
  [[nodiscard]] Ground groundOf(const RunObject& object) const {
    int structure = 0, others = 0, before = 0;
    const double reach = 0.5 * std::hypot(object.box.length, object.box.width) + kMargin_m;
    const Eigen::Vector2d sight = object.box.center - vehicle_;
    const double distance = sight.norm();
    for (const OwnedPoint& point : points_) {
      if (point.owner == kOwnerGround) continue;
      const Eigen::Vector2d p = point.p.head<2>() - vehicle_;
      const double along = p.dot(sight) / distance,
                   across = std::abs(p.x() * sight.y() - p.y() * sight.x()) / distance;
      if (along > 1.0 && along < distance - reach && across < kSight * along) ++before;
      if (std::abs(point.p.x() - object.box.center.x()) > reach ||
          std::abs(point.p.y() - object.box.center.y()) > reach ||
          point.p.z() < object.box.bottom - kMargin_m || point.p.z() > object.box.top + kMargin_m ||
          !object.box.holds(point.p.head<2>(), kMargin_m))
        continue;
      ++(point.owner == kOwnerStructure ? structure : others);
    }
    if (structure > 0 && structure >= others) return Ground::kStructure;
    return others == 0 && before >= kHiding ? Ground::kHidden : Ground::kObject;
  }
  /// On an object that need not be known: the part of it that is seen may be far from its middle.
  [[nodiscard]] bool isOnIgnored(const RunObject& object) const {
    for (std::size_t i = 0; i < truths_.size(); ++i) {
      if (frame.truths[i].ignored && truths_[i]->box.holds(object.box.center, kMargin_m)) return true;
    }
    return false;
  }
  void judge(Stamp stamp, double period_s, const std::map<int, Stamp>& seen, Result& result) const {
    for (std::size_t i = 0; i < truths_.size(); ++i) {
      if (frame.truths[i].ignored) continue;
      result.object_seconds += period_s;
      if (pair[i] < 0) continue;
      const RunObject& object = run_[static_cast<std::size_t>(pair[i])];
      const TrueObject& truth = *truths_[i];
      const bool moves = truth.velocity.norm() > kMoves_mps;
      result.position_error.push_back(static_cast<float>((object.box.center - truth.box.center).norm()));
      if (moves) {
        result.speed_error.push_back(static_cast<float>(object.velocity.norm() - truth.velocity.norm()));
        result.velocity_error.push_back(static_cast<float>((object.velocity - truth.velocity).norm()));
        result.dynamic_right.add(object.is_static == 0);
      } else {
        result.false_dynamic.add(object.is_static == 0);
      }
      result.motion_right.add((object.is_static == 0) == moves);
      result.class_right.add(object.class_id == truth.class_id);
      const auto first = seen.find(frame.truths[i].id);
      if (first != seen.end() && first->second <= stamp)
        result.class_right_seen.add(object.class_id == truth.class_id);
    }
    std::set<int> used(pair.begin(), pair.end());
    for (std::size_t j = 0; j < run_.size(); ++j) {
      if (used.count(static_cast<int>(j)) == 0 && frame.tracks[j].ignored && run_[j].class_id < 0)
        result.structures_dynamic.add(run_[j].is_static == 0);
    }
  }
  ScoredFrame frame;
  std::vector<int> pair;

 private:
  const std::vector<RunObject>& run_;
  const std::vector<OwnedPoint>& points_;
  Eigen::Vector2d vehicle_;
  std::vector<const TrueObject*> truths_;
};

void report(Result& result, std::uint64_t instants, Evaluation& evaluation) {
  const std::string group = "objects";
  const ClearScore clear = clearMot(result.frames, kSame, std::nullopt, Pairing::kKeep);
  const ScoredSequences judged = withoutIgnored(result.frames, kSame);
  const HotaScore hota = hotaScore(judged);
  evaluation.addCount(group, "instants", instants);
  evaluation.addCount(group, "truths", clear.truths);
  evaluation.add(group, "mota_percent", 100.0 * clear.mota());
  evaluation.add(group, "hota_percent", 100.0 * hota.hota);
  evaluation.add(group, "idf1_percent", 100.0 * identityScore(judged, kSame).idf1);
  evaluation.addCount(group, "missed", clear.false_negatives);
  evaluation.addCount(group, "wrong", clear.false_positives);
  evaluation.addCount(group, "identity_switches", clear.switches);
  evaluation.addCount(group, "fragments", clear.fragments);
  evaluation.add(group, "object_seconds", result.object_seconds);
  if (result.object_seconds > 0.0)
    evaluation.add(group, "switches_per_100_object_seconds",
                   100.0 * static_cast<double>(clear.switches) / result.object_seconds);
  evaluation.add(group, "position_error_m", statisticsOf(result.position_error));
  evaluation.add(group, "speed_error_of_moving_mps", statisticsOf(result.speed_error));
  evaluation.add(group, "velocity_error_of_moving_mps", statisticsOf(result.velocity_error));
  evaluation.add(group, "class_right_percent", result.class_right.percent());
  evaluation.add(group, "class_right_once_seen_by_camera_percent", result.class_right_seen.percent());
  evaluation.add(group, "motion_right_percent", result.motion_right.percent());
  evaluation.add(group, "moving_told_as_dynamic_percent", result.dynamic_right.percent());
  evaluation.add(group, "false_dynamic_percent", result.false_dynamic.percent());
  evaluation.add(group, "structures_told_as_dynamic_percent", result.structures_dynamic.percent());
}

}  // namespace

void evaluateObjects(const RunFolders& folders, const Pose& T_truth_run, Evaluation& evaluation) {
  const fs::path csv = folders.out / "objects" / "objects.csv";
  if (!fs::exists(csv)) return evaluation.skip("objects: no objects/objects.csv");
  if (!fs::is_directory(folders.truth / "points")) return evaluation.skip("objects: no truth of points");
  const RunObjects objects = readRunObjects(csv, T_truth_run, evaluation);
  if (objects.empty()) return evaluation.skip("objects: none in objects.csv");
  const ObstacleTruth truth(folders);
  const std::map<int, Stamp> seen = seenByCamera(folders.truth);
  Result result;
  std::uint64_t instants = 0;
  Stamp last = 0;
  std::map<int, int> kept;
  for (const Stamp stamp : truth.stamps()) {
    if (stamp < objects.begin()->first || stamp > objects.rbegin()->first)
      continue;  // no pose yet, or no more
    const auto points = truth.pointsAt(stamp);
    const auto vehicle = truth.vehicleAt(stamp);
    if (!points || !vehicle) continue;  // truth is written for every Nth scan
    const auto found = objects.find(stamp);
    const std::vector<RunObject> none;
    const std::map<int, TrueObject> at = truth.objectsAt(stamp);
    const Instant instant(found == objects.end() ? none : found->second, at, *points, *vehicle, kept);
    kept = idsOf(instant.frame, instant.pair);
    instant.judge(stamp, last == 0 ? 0.0 : toSeconds(stamp - last), seen, result);
    result.frames.front().push_back(instant.frame);
    last = stamp;
    ++instants;
  }
  if (instants == 0)
    return evaluation.skip("objects: no instant with truth of all lidars (make_drive --truth-points 1)");
  report(result, instants, evaluation);
}

}  // namespace atlas::synthetic
