// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "synthetic/evaluate.hpp"

namespace atlas::synthetic {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kDriving_mps = 0.5;  // slower is standing
constexpr double kSettled_s = 5.0;

/// Errors of one span of time.
struct PoseErrors {
  std::vector<float> horizontal_m, vertical_m, heading_deg, roll_deg, pitch_deg;

  void add(const Pose& truth, const Pose& run) {
    const Eigen::Vector3d offset = run.translation - truth.translation;
    const RollPitchYaw a = toRollPitchYaw(truth.rotation), b = toRollPitchYaw(run.rotation);
    horizontal_m.push_back(static_cast<float>(offset.head<2>().norm()));
    vertical_m.push_back(static_cast<float>(offset.z()));
    heading_deg.push_back(static_cast<float>(wrapAngle(b.yaw - a.yaw) / kDegree));
    roll_deg.push_back(static_cast<float>(wrapAngle(b.roll - a.roll) / kDegree));
    pitch_deg.push_back(static_cast<float>((b.pitch - a.pitch) / kDegree));
  }
  void report(const std::string& group, Evaluation& evaluation) {
    evaluation.add(group, "horizontal_error_m", statisticsOf(horizontal_m));
    evaluation.add(group, "vertical_error_m", statisticsOf(vertical_m));
    evaluation.add(group, "heading_error_deg", statisticsOf(heading_deg));
    evaluation.add(group, "roll_error_deg", statisticsOf(roll_deg));
    evaluation.add(group, "pitch_error_deg", statisticsOf(pitch_deg));
  }
};

}  // namespace

std::optional<Stamp> settledFrom(const std::vector<StampedPose>& truth) {
  Duration driven = 0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    const Duration step = truth[i].stamp - truth[i - 1].stamp;
    const double path_m = (truth[i].pose.translation - truth[i - 1].pose.translation).norm();
    if (path_m > kDriving_mps * toSeconds(step)) driven += step;
    if (driven >= fromSeconds(kSettled_s)) return truth[i].stamp;
  }
  return std::nullopt;
}

void evaluateTrajectory(const RunFolders& folders, const std::string& name, const Pose& T_truth_run,
                        Evaluation& evaluation) {
  const std::filesystem::path file = folders.out / "trajectory" / (name + ".tum");
  if (!std::filesystem::exists(file)) return evaluation.skip("trajectory/" + name + ".tum: no such file");
  const std::vector<StampedPose> truth = readTrajectory(folders.truth / "trajectory.tum");
  const std::vector<StampedPose> run = readTrajectory(file);
  const std::optional<Stamp> settled = settledFrom(truth);
  PoseErrors all, after;
  std::vector<bool> answered(truth.size(), false);
  std::uint64_t strange = 0, repeated = 0;
  for (const StampedPose& pose : run) {
    const auto match = std::lower_bound(truth.begin(), truth.end(), pose.stamp,
                                        [](const StampedPose& t, Stamp stamp) { return t.stamp < stamp; });
    if (match == truth.end() || match->stamp != pose.stamp) {
      ++strange;
      continue;
    }
    const auto index = static_cast<std::size_t>(match - truth.begin());
    if (answered[index]) ++repeated;
    answered[index] = true;
    const Pose in_truth = T_truth_run * pose.pose;
    all.add(match->pose, in_truth);
    if (settled && pose.stamp >= *settled) after.add(match->pose, in_truth);
  }
  all.report(name, evaluation);
  after.report(name + "_after_5_s_of_driving", evaluation);
  if (!truth.empty()) {
    const auto hits = static_cast<double>(std::count(answered.begin(), answered.end(), true));
    evaluation.add(name, "stamps_answered_percent", 100.0 * hits / static_cast<double>(truth.size()));
  }
  if (strange > 0) evaluation.skip("trajectory/" + name + ".tum: stamp without a true pose", strange);
  if (repeated > 0)
    evaluation.skip("trajectory/" + name + ".tum: stamp answered twice (both were compared)", repeated);
}

}  // namespace atlas::synthetic
