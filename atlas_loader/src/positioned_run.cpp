// SPDX-License-Identifier: MIT
#include "positioned_run.hpp"

#include <map>
#include <stdexcept>

#include "atlas/base/geodesy.hpp"
#include "atlas/localization/eskf_history.hpp"
#include "atlas/pipeline.hpp"

namespace atlas_loader {
namespace {

using atlas::GnssFix;
using atlas::ImuSample;

bool isAfter(const PositionedRun& run, atlas::Stamp stamp) {
  const atlas::Trajectory& known = run.motion.inMap();
  return known.empty() || stamp > known.poses().back().stamp;
}

void take(const atlas::Odometry& odometry, PositionedRun& run, bool velocities) {
  if (velocities) {
    run.motion.push(odometry);
  } else {
    run.motion.push(atlas::StampedPose{odometry.stamp, odometry.T_map_imu});
  }
}

/// The stage with its answers led into a run.
void addPositioning(atlas::LocalGraph& graph, const atlas::LocalizationParams& params, PositionedRun& run,
                    bool velocities, atlas::eskf::History* history) {
  graph.add([&params, &run, velocities, history](atlas::LocalGraph::Bus& bus) -> atlas::StageFactory {
    const atlas::StageFactory factory = bindLocalization(bus, params);
    return [factory, &run, velocities, history] {
      auto stage = factory();
      auto& localization = static_cast<atlas::LocalizationStage&>(*stage);
      localization.on_odometry = [&run, velocities](const atlas::Odometry& o) {
        if (isAfter(run, o.stamp)) take(o, run, velocities);
      };
      localization.on_anchor = [&run](const atlas::Anchor& anchor) { run.anchor = anchor.position; };
      if (history != nullptr) localization.record(history);
      return stage;
    };
  });
}

void takeSmoothed(atlas::eskf::History& history, PositionedRun& run, bool velocities) {
  if (history.size() == 0) return;
  history.smooth();
  run.motion = atlas::VehicleMotion();
  for (std::size_t i = 0; i < history.size(); ++i) take(history.odometry(i), run, velocities);
}

/// Fixes and attitudes of the same stamp, by the first fix as anchor.
class RecordedPoses {
 public:
  void add(const GnssFix& fix, PositionedRun& run) {
    fixes_[fix.stamp] = fix.position;
    join(fix.stamp, run);
  }
  void add(const ImuSample& sample, PositionedRun& run) {
    if (!sample.orientation) return;
    attitudes_[sample.stamp] = *sample.orientation;
    join(sample.stamp, run);
  }

 private:
  void join(atlas::Stamp stamp, PositionedRun& run) {
    const auto fix = fixes_.find(stamp);
    const auto attitude = attitudes_.find(stamp);
    if (fix == fixes_.end() || attitude == attitudes_.end()) return;
    if (!run.anchor) run.anchor = fix->second;
    if (isAfter(run, stamp)) {
      run.motion.push(atlas::StampedPose{
          stamp, atlas::Pose{attitude->second, atlas::LocalEnu(*run.anchor).toMap(fix->second)}});
    }
    fixes_.erase(fixes_.begin(), std::next(fix));
    attitudes_.erase(attitudes_.begin(), std::next(attitude));
  }
  std::map<atlas::Stamp, atlas::Geodetic> fixes_;
  std::map<atlas::Stamp, Eigen::Quaterniond> attitudes_;
};

}  // namespace

PoseSource poseSourceNamed(const std::string& name) {
  if (name == "filtered") return PoseSource::kFiltered;
  if (name == "smoothed") return PoseSource::kSmoothed;
  if (name == "recorded") return PoseSource::kRecorded;
  throw std::invalid_argument("poses must be filtered, smoothed or recorded, got " + name);
}

PositionedRun positionRun(const InputOptions& input, const atlas::LocalizationParams& params,
                          PoseSource source, bool velocities) {
  PositionedRun run;
  atlas::eskf::History history;
  atlas::LocalGraph graph;
  if (source != PoseSource::kRecorded)
    addPositioning(graph, params, run, velocities, source == PoseSource::kSmoothed ? &history : nullptr);
  RecordedPoses recorded;
  const auto reader = openInput(input);
  while (const auto event = reader->next()) {
    const std::string& topic = reader->streams()[event->stream].topic;
    if (const auto* rig = std::get_if<atlas::StaticTransforms>(&event->payload)) run.rig.add(*rig);
    if (source == PoseSource::kRecorded) {
      const auto* fix = std::get_if<GnssFix>(&event->payload);
      const auto* sample = std::get_if<ImuSample>(&event->payload);
      if (fix != nullptr && topic == "gnss/fix") recorded.add(*fix, run);
      if (sample != nullptr && topic == "imu/data") recorded.add(*sample, run);
    } else if (graph.wants(topic)) {
      std::visit([&](const auto& value) { graph.publish(topic, value); }, event->payload);
      if (event->stream != 0) graph.advance(event->stamp - 1);
    }
  }
  graph.finish();
  if (source == PoseSource::kSmoothed) takeSmoothed(history, run, velocities);
  return run;
}

}  // namespace atlas_loader
