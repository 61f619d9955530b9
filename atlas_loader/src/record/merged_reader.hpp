// SPDX-License-Identifier: MIT
// RecordReader over several event sources: merges them by (stamp, stream index) with one event of each in
// memory.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "atlas/sensor/record_reader.hpp"
#include "record/event_source.hpp"
#include "record/open_record.hpp"
#include "record/record_log.hpp"

namespace atlas::record {

/// The streams that the caller has asked for, numbered in the order of the calls of add(); tf_static is
/// stream 0.
class StreamSet {
 public:
  explicit StreamSet(const std::vector<std::string>& topics);
  /// Index of the stream; nullopt when it was not asked for.
  std::optional<std::size_t> add(const std::string& topic, StreamKind kind, std::uint64_t expected = 0);
  /// True when add() would give the stream a number.
  [[nodiscard]] bool wants(const std::string& topic) const;
  /// True when any topic that begins with the sensor's name and a slash may be wanted.
  [[nodiscard]] bool wantsAnyOf(const std::string& sensor) const;
  [[nodiscard]] const std::vector<StreamInfo>& streams() const { return streams_; }
  /// Topics that were asked for and that add() has not seen.
  [[nodiscard]] std::vector<std::string> unknown() const;

 private:
  std::vector<std::string> topics_;
  std::vector<std::string> seen_;
  std::vector<StreamInfo> streams_;
};

/// What a format's assembly hands over.
struct RecordParts {
  std::shared_ptr<RecordLog> log;
  std::vector<StreamInfo> streams;
  std::vector<std::unique_ptr<EventSource>> sources;
  StaticTransforms static_transforms;
};

class MergedReader : public RecordReader {
 public:
  MergedReader(RecordParts parts, const RecordOptions& options);

  [[nodiscard]] const std::vector<StreamInfo>& streams() const override { return parts_.streams; }
  std::optional<Event> next() override;
  [[nodiscard]] std::map<std::string, FileReport> report() const override { return parts_.log->files(); }
  [[nodiscard]] std::vector<std::string> notes() const override { return parts_.log->notes(); }
  /// Of the whole record, not of the requested span.
  [[nodiscard]] std::pair<Stamp, Stamp> span() const override { return span_; }

 private:
  RecordParts parts_;
  std::vector<std::optional<Event>> heads_;
  std::pair<Stamp, Stamp> span_{0, 0};
  bool started_ = false;
};

}  // namespace atlas::record
