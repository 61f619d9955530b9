// SPDX-License-Identifier: MIT
#include "atlas_ros/stage_diagnostics.hpp"

#include "atlas_ros/conversions.hpp"

namespace atlas_ros {

std::map<std::string, std::uint64_t> countsOf(const atlas::Stage& stage, const atlas::Counters& unusable) {
  std::map<std::string, std::uint64_t> counts = stage.counters().all();
  for (const auto& [name, value] : unusable.all()) counts[name] += value;
  const atlas::EventMerge& merge = stage.merge();
  for (std::size_t i = 0; i < merge.streams(); ++i) {
    counts["received " + merge.name(i)] = merge.received(i);
    counts["late " + merge.name(i)] = merge.late(i);
  }
  return counts;
}

void describeStage(const atlas::Stage* stage, const atlas::Counters& unusable, const std::string& error,
                   diagnostic_updater::DiagnosticStatusWrapper& status) {
  using Status = diagnostic_msgs::DiagnosticStatus;
  if (stage == nullptr) {
    status.summary(Status::OK, "waiting for a run");
    return;
  }
  const atlas::EventMerge& merge = stage->merge();
  std::uint64_t late = 0;
  for (std::size_t i = 0; i < merge.streams(); ++i) late += merge.late(i);
  status.summary(Status::OK, stage->ended() ? "ended" : "running");
  if (late > 0) status.mergeSummary(Status::WARN, std::to_string(late) + " messages came too late");
  if (!unusable.all().empty()) status.mergeSummary(Status::WARN, "unusable messages");
  if (!error.empty()) status.mergeSummary(Status::ERROR, error);
  const atlas::Stamp reached = stage->progress();
  if (reached != atlas::kBeginOfTime && reached != atlas::kEndOfTime) status.add("reached stamp_ns", reached);
  status.add("queued events", merge.queued());
  const std::size_t blocking = merge.blockingStream();
  if (blocking < merge.streams()) status.add("waits for", merge.name(blocking));
  for (const auto& [name, value] : countsOf(*stage, unusable)) status.add(name, value);
}

}  // namespace atlas_ros
