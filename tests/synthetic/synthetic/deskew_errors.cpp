// SPDX-License-Identifier: MIT
#include "synthetic/deskew_errors.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <utility>

#include "atlas/lidar/batching.hpp"
#include "atlas/lidar/range_gate.hpp"
#include "synthetic/evaluate.hpp"
#include "synthetic/rigid_fit.hpp"
#include "synthetic/scan_files.hpp"

namespace atlas::synthetic {
namespace {

constexpr double kMinRange_m = 1.0, kMaxRange_m = 120.0;  // of the de-skew stage
constexpr double kStanding_mps = 0.5, kTurning_radps = 0.05;

void addTo(std::vector<float>& values, double error_m) { values.push_back(static_cast<float>(error_m)); }

}  // namespace

DeskewErrors::DeskewErrors(std::filesystem::path truth, const Geodetic& run_anchor,
                           const VehicleMotion& motion)
    : truth_(std::move(truth)), motion_(motion) {
  const auto anchor = readAnchor(truth_ / "anchor.json");
  if (!anchor) throw std::runtime_error(truth_.string() + ": no anchor.json of a synthetic drive");
  T_truth_run_ = betweenMaps(*anchor, run_anchor);
  settled_ = settledFrom(readTrajectory(truth_ / "trajectory.tum")).value_or(kEndOfTime);
}

std::string DeskewErrors::motionAt(Stamp stamp) const {
  constexpr Duration kHalf = 50 * kMillisecond;
  // in the motion that corrections are no part of: finding the heading is no turn
  const Outcome<Trajectory> poses = motion_.around(stamp, stamp - kHalf, stamp);
  if (!poses) return "unknown";
  const auto a = poses->at(stamp - kHalf), b = poses->at(stamp);
  if (!a || !b) return "unknown";
  const double dt_s = toSeconds(kHalf);
  if ((b->translation - a->translation).norm() < kStanding_mps * dt_s) return "standing";
  const bool turns = logSo3(a->rotation.conjugate() * b->rotation).norm() > kTurning_radps * dt_s;
  return turns ? "turning" : "straight";
}

void DeskewErrors::add(const std::string& lidar, int index, const SweepPtr& sweep, const Pose& T_imu_lidar) {
  char name[16];
  std::snprintf(name, sizeof name, "%06d.bin", index);
  const std::vector<TruthPoint> truth = readTruthPoints(truth_ / "points" / lidar / name);
  if (truth.size() != sweep->points.size()) return;
  const Outcome<SweepSpan> span = spanOf(*sweep);
  if (!span) return;
  const Outcome<Trajectory> poses = motion_.around(sweep->stamp, span->first, span->last);
  if (!poses) return;
  const SweepPtr gated = gateByRange(sweep, kMinRange_m, kMaxRange_m).sweep;
  for (const DeskewWay way : kDeskewWays) {
    const auto points = placed(gated, way, *poses, T_imu_lidar);
    if (!points) continue;
    Errors& errors = errors_[motionAt(sweep->stamp)][way];
    std::vector<PointPair> pairs;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const LidarPoint& p = (*points)[i];
      if (truth[i].object != 0.0F || !std::isfinite(truth[i].x) || !std::isfinite(p.x)) continue;
      const Eigen::Vector3d in_truth = T_truth_run_ * Eigen::Vector3d(p.x, p.y, p.z);
      const Eigen::Vector3f q(truth[i].x, truth[i].y, truth[i].z);
      const double error_m = (in_truth - q.cast<double>()).norm();
      addTo(errors.in_map_m, error_m);
      if (sweep->stamp >= settled_) addTo(errors.settled_m, error_m);
      pairs.emplace_back(in_truth.cast<float>(), q);
    }
    const auto T = rigidFit(pairs);
    if (!T) continue;
    for (const auto& [p, q] : pairs)
      addTo(errors.distortion_m, (*T * p.cast<double>() - q.cast<double>()).norm());
  }
}

void DeskewErrors::print(nlohmann::ordered_json& json) const {
  std::printf("\n%-9s %-14s %10s | %17s | %17s | %17s\n", "car", "de-skew", "points", "distortion, cm",
              "error in map, cm", "after 5 s driving");
  std::printf("%-9s %-14s %10s | %8s %8s | %8s %8s | %8s %8s\n", "", "", "", "median", "95 %", "median",
              "95 %", "median", "95 %");
  const auto cm = [](std::vector<float> values) {
    const auto statistics = statisticsOf(values);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return statistics ? std::make_pair(100 * statistics->median, 100 * statistics->p95)
                      : std::make_pair(kNone, kNone);
  };
  for (const auto& [motion, by_way] : errors_) {
    for (const auto& [way, errors] : by_way) {
      const auto d = cm(errors.distortion_m), m = cm(errors.in_map_m), s = cm(errors.settled_m);
      std::printf("%-9s %-14s %10zu | %8.2f %8.2f | %8.2f %8.2f | %8.2f %8.2f\n", motion.c_str(),
                  toString(way), errors.in_map_m.size(), d.first, d.second, m.first, m.second, s.first,
                  s.second);
      json[motion][toString(way)] = {{"points", errors.in_map_m.size()},
                                     {"distortion_cm", {d.first, d.second}},
                                     {"in_map_cm", {m.first, m.second}},
                                     {"in_map_after_5_s_of_driving_cm", {s.first, s.second}}};
    }
  }
}

}  // namespace atlas::synthetic
