// SPDX-License-Identifier: MIT
#include "record/merged_reader.hpp"

#include <algorithm>

#include "atlas/base/check.hpp"

namespace atlas::record {
namespace {
std::string withoutSlash(const std::string& topic) {
  return topic.rfind('/', 0) == 0 ? topic.substr(1) : topic;
}
}  // namespace

StreamSet::StreamSet(const std::vector<std::string>& topics) {
  for (const std::string& topic : topics) topics_.push_back(withoutSlash(topic));
  streams_.push_back({"tf_static", StreamKind::kStaticTransforms, 1});
  seen_.push_back("tf_static");
}

bool StreamSet::wants(const std::string& topic) const {
  return topics_.empty() || std::find(topics_.begin(), topics_.end(), topic) != topics_.end();
}

bool StreamSet::wantsAnyOf(const std::string& sensor) const {
  const auto of_sensor = [&](const std::string& topic) { return topic.rfind(sensor + "/", 0) == 0; };
  return topics_.empty() || std::any_of(topics_.begin(), topics_.end(), of_sensor);
}

std::optional<std::size_t> StreamSet::add(const std::string& topic, StreamKind kind, std::uint64_t expected) {
  seen_.push_back(topic);
  if (!wants(topic)) return std::nullopt;
  streams_.push_back({topic, kind, expected});
  return streams_.size() - 1;
}

std::vector<std::string> StreamSet::unknown() const {
  std::vector<std::string> unknown;
  for (const std::string& topic : topics_) {
    if (std::find(seen_.begin(), seen_.end(), topic) == seen_.end()) unknown.push_back(topic);
  }
  return unknown;
}

MergedReader::MergedReader(RecordParts parts, const RecordOptions& options) : parts_(std::move(parts)) {
  bool known = false;
  for (const auto& source : parts_.sources) {
    const auto first = source->firstStamp();
    if (!first) continue;
    const Stamp last = std::max(*first, source->lastStamp().value_or(*first));
    span_ = known ? std::make_pair(std::min(span_.first, *first), std::max(span_.second, last))
                  : std::make_pair(*first, last);
    known = true;
  }
  TimeSpan span;
  if (known && options.start_s > 0) span.begin = span_.first + fromSeconds(options.start_s);
  if (known && options.duration_s >= 0) {
    span.end = span_.first + fromSeconds(options.start_s) + fromSeconds(options.duration_s);
  }
  for (const auto& source : parts_.sources) source->limit(span);
}

std::optional<Event> MergedReader::next() {
  const bool first = !started_;
  if (first) {
    for (const auto& source : parts_.sources) heads_.push_back(source->next());
    started_ = true;
  }
  std::size_t earliest = heads_.size();
  for (std::size_t i = 0; i < heads_.size(); ++i) {
    if (!heads_[i]) continue;
    const auto key = [this](std::size_t k) { return std::make_pair(heads_[k]->stamp, heads_[k]->stream); };
    if (earliest == heads_.size() || key(i) < key(earliest)) earliest = i;
  }
  if (earliest == heads_.size()) return std::nullopt;
  if (first) return Event{heads_[earliest]->stamp, 0, parts_.static_transforms};
  std::optional<Event> event = std::move(heads_[earliest]);
  heads_[earliest] = parts_.sources[earliest]->next();
  if (heads_[earliest]) {
    ATLAS_CHECK(heads_[earliest]->stamp >= event->stamp,
                "source of " + parts_.streams[event->stream].topic + " goes back in time");
  }
  return event;
}

}  // namespace atlas::record
