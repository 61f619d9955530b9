// SPDX-License-Identifier: MIT
// A text file with one stamped row per sample, read as a stream. Rows out of order are sorted inside a
// bounded window, so memory does not depend on the length of the file.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "record/event_source.hpp"
#include "record/record_log.hpp"
#include "record/text_rows.hpp"

namespace atlas::record {

/// Turns the fields of a row into events with ascending streams and one stamp, which it returns; reports
/// faults through `fields`. A good row may have no event.
using RowParser = std::function<Stamp(RowFields& fields, std::vector<Event>& events)>;

struct RowFile {
  std::filesystem::path path;
  std::string name;      ///< in reports, relative to the record: "imu/imu.txt"
  Duration latency = 0;  ///< subtracted from stamps by the parser; here for lastStamp() only
  RowParser parser;
  std::function<void()> at_end;  ///< called once when all rows were delivered; may be empty
};

class RowSource : public EventSource {
 public:
  static constexpr std::size_t kReorderRows = 4096;  ///< 10 s of a 400 Hz file

  RowSource(RowFile file, std::shared_ptr<RecordLog> log);
  std::optional<Stamp> firstStamp() override;
  std::optional<Stamp> lastStamp() override;
  void limit(const TimeSpan& span) override { span_ = span; }
  std::optional<Event> next() override;

 private:
  using Key = std::pair<Stamp, std::uint64_t>;  ///< stamp, row

  void fill();
  void take(const Line& line);
  void takeOut();
  void end();

  RowFile file_;
  std::shared_ptr<RecordLog> log_;
  LineReader lines_;
  RowFields fields_;
  TimeSpan span_;
  std::map<Key, std::vector<Event>> window_;
  std::vector<Event> ready_;      ///< of one stamp, last first
  std::optional<Stamp> typical_;  ///< of the stamps in the file, before the latency is taken off
  Stamp newest_ = kBeginOfTime, delivered_ = kBeginOfTime;
  std::uint64_t inversions_ = 0, repeated_ = 0;
  bool exhausted_ = false, ended_ = false;
};

/// Number of non-empty lines, or 0 when the file is missing or larger than 64 MB (not worth a pass of its
/// own).
std::uint64_t countRows(const std::filesystem::path& path);

}  // namespace atlas::record
