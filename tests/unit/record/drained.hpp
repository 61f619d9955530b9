// SPDX-License-Identifier: MIT
// Everything that a reader delivers, and the check that no row was lost on the way.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "record/open_record.hpp"

namespace atlas::test {

struct Drained {
  std::vector<StreamInfo> streams;
  std::vector<Event> events;
  std::map<std::string, FileReport> report;
  std::vector<std::string> notes;
  std::pair<Stamp, Stamp> span;

  [[nodiscard]] std::vector<Event> of(const std::string& topic) const {
    std::vector<Event> found;
    std::copy_if(events.begin(), events.end(), std::back_inserter(found),
                 [&](const Event& event) { return streams[event.stream].topic == topic; });
    return found;
  }
  template <class T>
  [[nodiscard]] std::vector<T> payloads(const std::string& topic) const {
    std::vector<T> found;
    for (const Event& event : of(topic)) found.push_back(std::get<T>(event.payload));
    return found;
  }
  [[nodiscard]] bool hasStream(const std::string& topic) const {
    return std::any_of(streams.begin(), streams.end(), [&](const StreamInfo& s) { return s.topic == topic; });
  }
  /// True when a note contains the text.
  [[nodiscard]] bool notesSay(const std::string& text) const {
    return std::any_of(notes.begin(), notes.end(),
                       [&](const std::string& note) { return note.find(text) != std::string::npos; });
  }
  [[nodiscard]] std::uint64_t skipped(const std::string& file, const std::string& reason) const {
    const auto it = report.find(file);
    if (it == report.end() || it->second.skipped.count(reason) == 0) return 0;
    return it->second.skipped.at(reason);
  }
  [[nodiscard]] std::string allNotes() const {
    std::string text;
    for (const std::string& note : notes) text += note + "\n";
    return text;
  }
};

/// Every row of every file is used or skipped for a reason.
inline void expectAllAccounted(const std::map<std::string, FileReport>& report) {
  for (const auto& [name, file] : report) {
    std::uint64_t skipped = 0;
    for (const auto& [reason, rows] : file.skipped) {
      EXPECT_FALSE(reason.empty()) << name;
      skipped += rows;
    }
    EXPECT_EQ(file.rows, file.used + skipped) << name;
  }
}

/// Reads to the end and checks what holds for every record: order, known streams, rows accounted for.
inline Drained drain(RecordReader& reader) {
  Drained drained;
  drained.streams = reader.streams();
  drained.span = reader.span();
  while (auto event = reader.next()) {
    EXPECT_LT(event->stream, drained.streams.size());
    if (!drained.events.empty()) {
      const Event& before = drained.events.back();
      EXPECT_LE(std::make_pair(before.stamp, before.stream), std::make_pair(event->stamp, event->stream));
    }
    drained.events.push_back(std::move(*event));
  }
  EXPECT_FALSE(reader.next()) << "after the end comes the end";
  drained.report = reader.report();
  drained.notes = reader.notes();
  expectAllAccounted(drained.report);
  return drained;
}

inline Drained readRecord(const std::filesystem::path& folder, const RecordOptions& options = {}) {
  return drain(*openRecord(folder, options));
}

}  // namespace atlas::test
