// SPDX-License-Identifier: MIT
#include "ingest.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace atlas_loader {

Ingest::Ingest(std::vector<atlas::StreamInfo> streams, atlas::Duration max_delay)
    : streams_(std::move(streams)), max_delay_(max_delay), state_(streams_.size()) {
  startEpoch();
}

void Ingest::startEpoch() {
  std::vector<std::string> names;
  for (const atlas::StreamInfo& stream : streams_) names.push_back(stream.topic);
  merge_ = std::make_unique<atlas::EventMerge>(std::move(names));
  newest_ = oldest_ = atlas::kBeginOfTime;
  for (const auto& [stream, event] : transforms_) pushToMerge(stream, 0, event.stamp, event.payload);
}

void Ingest::endEpoch() {
  for (std::size_t i = 0; i < streams_.size(); ++i) merge_->finish(i);
  for (std::size_t i = 0; i < streams_.size(); ++i) late_before_ += merge_->late(i);
}

void Ingest::nextEpoch() {
  endEpoch();
  put({Item::Kind::kEndOfEpoch, std::nullopt});
  startEpoch();
  for (Stream& stream : state_) {
    stream.behind = !stream.ahead && stream.newest != atlas::kBeginOfTime;
    stream.ahead = false;
    stream.newest = atlas::kBeginOfTime;
  }
  newest_held_ = atlas::kBeginOfTime;
  std::vector<Held> held;
  held.swap(held_);
  for (Held& message : held) take(message.stream, message.stamp, std::move(message.payload));
}

bool Ingest::isOfNextEpoch(const Stream& stream, atlas::Stamp stamp) const {
  if (stream.newest != atlas::kBeginOfTime && stamp < stream.newest - atlas::kSecond) return true;
  // Other streams are there already, and this one would come too late for the epoch that they left.
  return !held_.empty() && !stream.ahead && stamp < newest_ - max_delay_;
}

void Ingest::push(std::size_t stream, atlas::Stamp stamp, atlas::Payload payload) {
  ++received_;
  if (streams_[stream].kind == atlas::StreamKind::kStaticTransforms) {
    if (isKnown(payload)) return;  // they hold until the publisher has gone: a loop may repeat them or not
    transforms_.push_back({stream, {stamp, stream, payload}});
    pushToMerge(stream, 0, stamp, std::move(payload));  // transforms that never change come first
    return;
  }
  Stream& state = state_[stream];
  if (isOfNextEpoch(state, stamp)) {
    if (state.ahead) nextEpoch();  // there already, and on to the one after it
    state.ahead = true;
    state.newest = atlas::kBeginOfTime;
  }
  if (state.ahead) {
    hold(stream, stamp, std::move(payload));
  } else {
    take(stream, stamp, std::move(payload));
  }
}

void Ingest::hold(std::size_t stream, atlas::Stamp stamp, atlas::Payload payload) {
  state_[stream].newest = std::max(state_[stream].newest, stamp);
  held_.push_back({stream, stamp, std::move(payload)});
  newest_held_ = std::max(newest_held_, stamp);
  const bool all = std::all_of(state_.begin(), state_.end(), [](const Stream& other) {
    return other.ahead || other.newest == atlas::kBeginOfTime;
  });
  if (all || newest_held_ - held_.front().stamp >= max_delay_) nextEpoch();
}

void Ingest::take(std::size_t stream, atlas::Stamp stamp, atlas::Payload payload) {
  Stream& state = state_[stream];
  if (state.behind && newest_ != atlas::kBeginOfTime && stamp > newest_ + max_delay_) {
    ++late_before_;  // of the epoch before, which waited for it long enough
    return;
  }
  state.behind = false;
  pushToMerge(stream, stamp, stamp, std::move(payload));
  state.newest = std::max(state.newest, stamp);
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
  if (!held_.empty()) nextEpoch();
  endEpoch();
  transforms_.clear();
  state_.assign(streams_.size(), {});
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
