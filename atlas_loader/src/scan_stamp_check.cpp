// SPDX-License-Identifier: MIT
#include "scan_stamp_check.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>

#include "atlas/lidar/batching.hpp"
#include "atlas/lidar/deskew_trial.hpp"
#include "atlas/lidar/range_gate.hpp"
#include "positioned_run.hpp"
#include "smooth_run.hpp"

namespace atlas_loader {
namespace {

using atlas::SweepPtr;

constexpr std::size_t kSweeps = 10;  // of a window
constexpr std::size_t kQueries = 5000;
constexpr double kMinSpeed_mps = 1.0;
constexpr double kMinRange_m = 3.0, kMaxRange_m = 40.0;
constexpr double kRadius_m = 0.4;

struct Differences {
  std::vector<double> earlier, later;
};

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}
double errorOfMean(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double middle = mean(values);
  double squares = 0;
  for (const double v : values) squares += (v - middle) * (v - middle);
  return n > 1 ? std::sqrt(squares / (n - 1) / n) : std::numeric_limits<double>::infinity();
}

bool moved(const std::vector<SweepPtr>& sweeps, const atlas::Trajectory& trajectory) {
  const auto a = trajectory.at(sweeps.front()->stamp), b = trajectory.at(sweeps.back()->stamp);
  const double span_s = atlas::toSeconds(sweeps.back()->stamp - sweeps.front()->stamp);
  return a && b && (b->translation - a->translation).norm() >= kMinSpeed_mps * span_s;
}

void tryWindow(const std::vector<SweepPtr>& sweeps, const PositionedRun& run, const atlas::Pose& T_imu_lidar,
               Differences& differences) {
  const auto span = atlas::spanOf(*sweeps.front());
  if (!span || !moved(sweeps, run.motion.inMap())) return;
  const std::size_t points = kSweeps * sweeps.front()->points.size();
  const atlas::MapQualityParams params{kRadius_m, 12, std::max<std::size_t>(1, points / kQueries)};
  const auto entropy = [&](atlas::Duration shift) -> std::optional<double> {
    const auto quality =
        qualityOf(sweeps, atlas::DeskewWay::kPerPoint, run.motion.inMap(), T_imu_lidar, params, shift);
    if (!quality || quality->neighbourhoods == 0) return std::nullopt;
    return quality->mean_entropy;
  };
  const atlas::Duration sweep = span->last - span->first;
  const auto as_is = entropy(0), earlier = entropy(-sweep), later = entropy(sweep);
  if (!as_is || !earlier || !later) return;
  differences.earlier.push_back(*earlier - *as_is);
  differences.later.push_back(*later - *as_is);
}

}  // namespace

std::vector<ScanStampFit> tryScanStamps(const InputOptions& input) {
  InputOptions positions = input;
  positions.topics = {"tf_static", "imu/data", "imu/gnss/fix", "gnss/fix", "gnss/heading"};
  const PositionedRun run = positionRun(positions, localizationParams("", input), PoseSource::kSmoothed);
  std::map<std::string, std::vector<SweepPtr>> waiting;
  std::map<std::string, Differences> differences;
  const auto reader = openInput(input);
  while (const auto event = reader->next()) {
    const auto* sweep = std::get_if<SweepPtr>(&event->payload);
    if (sweep == nullptr || (*sweep)->points.empty()) continue;
    const std::string& topic = reader->streams()[event->stream].topic;
    const auto T_imu_lidar = run.rig.T_imu((*sweep)->frame);
    if (!T_imu_lidar) continue;
    std::vector<SweepPtr>& sweeps = waiting[topic];
    sweeps.push_back(atlas::gateByRange(*sweep, kMinRange_m, kMaxRange_m).sweep);
    if (sweeps.size() < kSweeps) continue;
    tryWindow(sweeps, run, *T_imu_lidar, differences[topic]);
    sweeps.clear();
  }
  std::vector<ScanStampFit> result;
  for (const auto& [topic, d] : differences) {
    if (d.earlier.empty()) continue;
    result.push_back({topic, d.earlier.size(), mean(d.earlier), errorOfMean(d.earlier), mean(d.later),
                      errorOfMean(d.later)});
  }
  return result;
}

ScanStampVerdict judge(const ScanStampFit& fit) {
  char figures[160];
  std::snprintf(figures, sizeof figures,
                " (entropy %+.3f +- %.3f one sweep earlier, %+.3f +- %.3f later, %zu windows)", fit.earlier,
                fit.earlier_error, fit.later, fit.later_error, fit.windows);
  const bool earlier_wins = fit.earlier < -2.0 * fit.earlier_error,
             later_wins = fit.later < -2.0 * fit.later_error;
  if (earlier_wins && (!later_wins || fit.earlier < fit.later)) {
    return {fit.topic +
                ": stamps seem to mark the end of sweeps, but the times of the points count from the start" +
                figures,
            true};
  }
  if (later_wins) {
    return {fit.topic + ": stamps seem to mark the start of sweeps, but the times of the points end at them" +
                figures,
            true};
  }
  const bool sure = fit.earlier > 2.0 * fit.earlier_error && fit.later > 2.0 * fit.later_error;
  return {fit.topic +
              (sure ? ": stamps and times of the points fit together"
                    : ": the drive does not tell whether stamps and times of the points fit together") +
              figures,
          false};
}

}  // namespace atlas_loader
