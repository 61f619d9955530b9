// SPDX-License-Identifier: MIT
#include "ingest.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace atlas_loader {

Ingest::Ingest(std::vector<atlas::StreamInfo> streams, atlas::Duration max_delay)
    : streams_(std::move(streams)), max_delay_(max_delay) {
  startEpoch();
}

void Ingest::startEpoch() {
  std::vector<std::string> names;
  for (const atlas::StreamInfo& stream : streams_) names.push_back(stream.topic);
  merge_ = std::make_unique<atlas::EventMerge>(std::move(names));
  newest_of_.assign(streams_.size(), atlas::kBeginOfTime);
  newest_ = oldest_ = atlas::kBeginOfTime;
  for (const auto& [stream, event] : transforms_) pushToMerge(stream, 0, event.stamp, event.payload);
}

void Ingest::endEpoch() {
  for (std::size_t i = 0; i < streams_.size(); ++i) merge_->finish(i);
  for (std::size_t i = 0; i < streams_.size(); ++i) late_before_ += merge_->late(i);
}

void Ingest::push(std::size_t stream, atlas::Stamp stamp, atlas::Payload payload) {
  ++received_;
  const bool is_static = streams_[stream].kind == atlas::StreamKind::kStaticTransforms;
  if (!is_static && newest_of_[stream] != atlas::kBeginOfTime &&
      stamp < newest_of_[stream] - atlas::kSecond) {
    endEpoch();
    put({Item::Kind::kEndOfEpoch, std::nullopt});
    startEpoch();
  }
  if (is_static) {  // they hold until the publisher has gone: a recording that loops may repeat them or not
    if (isKnown(payload)) return;
    transforms_.push_back({stream, {stamp, stream, payload}});
    pushToMerge(stream, 0, stamp, std::move(payload));  // transforms that never change come first
    return;
  }
  pushToMerge(stream, stamp, stamp, std::move(payload));
  newest_of_[stream] = std::max(newest_of_[stream], stamp);
  oldest_ = oldest_ == atlas::kBeginOfTime ? stamp : std::min(oldest_, stamp);
  if (stamp <= newest_) return;
  newest_ = stamp;
  advanceSilent();
}

void Ingest::pushToMerge(std::size_t stream, atlas::Stamp order, atlas::Stamp stamp, atlas::Payload payload) {
  auto shared = std::make_shared<atlas::Payload>(std::move(payload));
  merge_->push(stream, order, [this, stream, stamp, shared] {
    put({Item::Kind::kEvent, atlas::Event{stamp, stream, std::move(*shared)}});
  });
}

bool Ingest::isKnown(const atlas::Payload& payload) const {
  const auto& transforms = std::get<atlas::StaticTransforms>(payload).transforms;
  const auto same = [](const atlas::StaticTransform& a, const atlas::StaticTransform& b) {
    return a.parent == b.parent && a.child == b.child &&
           a.T_parent_child.translation == b.T_parent_child.translation &&
           a.T_parent_child.rotation.coeffs() == b.T_parent_child.rotation.coeffs();
  };
  return std::any_of(transforms_.begin(), transforms_.end(), [&](const auto& entry) {
    const auto& known = std::get<atlas::StaticTransforms>(entry.second.payload).transforms;
    return std::equal(known.begin(), known.end(), transforms.begin(), transforms.end(), same);
  });
}

/// Static transforms may arrive after the first measurements (another connection), so they get max_delay from
/// the oldest one.
void Ingest::advanceSilent() {
  const bool static_known = newest_ - oldest_ >= max_delay_;
  for (std::size_t i = 0; i < streams_.size(); ++i) {
    const bool is_static = streams_[i].kind == atlas::StreamKind::kStaticTransforms;
    if (!is_static || static_known) merge_->advance(i, newest_ - max_delay_);
  }
}

void Ingest::finish() {
  endEpoch();
  transforms_.clear();
  put({Item::Kind::kEndOfRun, std::nullopt});
  startEpoch();
}

void Ingest::put(Item item) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ready_.push_back(std::move(item));
  changed_.notify_one();
}

std::optional<Ingest::Item> Ingest::pop() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait(lock, [this] { return stopped_ || !ready_.empty(); });
  if (stopped_) return std::nullopt;
  Item item = std::move(ready_.front());
  ready_.pop_front();
  return item;
}

void Ingest::stop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  stopped_ = true;
  changed_.notify_all();
}

std::uint64_t Ingest::late() const {
  std::uint64_t sum = late_before_;
  for (std::size_t i = 0; i < streams_.size(); ++i) sum += merge_->late(i);
  return sum;
}

std::optional<atlas::StreamKind> kindOfTopicName(const std::string& topic) {
  using atlas::StreamKind;
  static const std::vector<std::pair<std::string, StreamKind>> kEndings = {
      {"tf_static", StreamKind::kStaticTransforms},
      {"imu/data", StreamKind::kImu},
      {"gnss/heading", StreamKind::kGnssHeading},
      {"gnss/fix", StreamKind::kGnssFix},
      {"/points", StreamKind::kPoints},
      {"/camera_info", StreamKind::kCameraInfo},
      {"/packets", StreamKind::kVideoPackets},
      {"/image_raw/compressed", StreamKind::kCompressedImage},
      {"/image_raw", StreamKind::kImage},
      {"/detections", StreamKind::kDetections},
      {"/temperature_range", StreamKind::kTemperatureRange},
      {"/scan", StreamKind::kRadar},
      {"imu/mag", StreamKind::kMagnetic},
      {"imu/pressure", StreamKind::kPressure},
      {"imu/temperature", StreamKind::kTemperature},
      {"/time", StreamKind::kTimeReference}};
  for (const auto& [ending, kind] : kEndings) {
    if (topic.size() >= ending.size() &&
        topic.compare(topic.size() - ending.size(), ending.size(), ending) == 0)
      return kind;
  }
  return std::nullopt;
}

}  // namespace atlas_loader
