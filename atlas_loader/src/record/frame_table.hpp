// SPDX-License-Identifier: MIT
// timestamps.txt of a camera or lidar: which stamp belongs to frame k. Kept whole (48 bytes a frame);
// payloads never are.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

#include "record/event_source.hpp"
#include "record/record_log.hpp"
#include "record/text_rows.hpp"

namespace atlas::record {

struct FrameRow {
  Stamp stamp = 0;
  std::uint32_t index = 0;                    ///< 0-based frame or scan number
  std::uint32_t line = 0;                     ///< of the file, for messages
  std::uint64_t inner = 0;                    ///< clock of the sensor as written; 0 when the file has none
  double minimum_degc = 0, maximum_degc = 0;  ///< thermal camera only
};

enum class FrameColumns {
  kInner,        ///< ts, index, inner clock; the last may be missing
  kTemperatures  ///< ts, index, t_min, t_max
};

class FrameTable {
 public:
  /// Reads the file; faults go to the log under `name`.
  FrameTable(const std::filesystem::path& path, const std::string& name, FrameColumns columns,
             Duration latency, std::shared_ptr<RecordLog> log);

  /// From rows by ascending index that the caller has read, checked and counted; `name` "" = account() books
  /// nothing.
  FrameTable(std::vector<FrameRow> rows, const std::string& name, std::shared_ptr<RecordLog> log);

  /// Only frames with index < `frames` exist; to be called before account().
  void limitFrames(std::uint64_t frames);
  /// Books every row as used, without a picture, or outside of `span`. Later calls do nothing.
  void account(const TimeSpan& span);
  /// Books every row as skipped, when no stream is made of it.
  void accountUnused(const std::string& reason);

  /// Existing frames by (stamp, index).
  [[nodiscard]] const std::vector<FrameRow>& rows() const { return rows_; }
  /// nullptr when the frame has no row.
  [[nodiscard]] const FrameRow* find(std::uint64_t index) const;
  /// Largest number of places by which a frame's place in time differs from its place in the file.
  [[nodiscard]] std::size_t disorder() const { return disorder_; }
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  void read(LineReader& lines, FrameColumns columns, Duration latency);
  void dropOutliers();
  void dropRepeated();
  void sortRows();
  void indexRows();

  std::string name_;
  std::shared_ptr<RecordLog> log_;
  std::vector<FrameRow> rows_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> place_of_index_;  ///< (index, place in rows_), sorted
  std::uint64_t without_frame_ = 0;
  std::size_t disorder_ = 0;
  bool accounted_ = false;
};

/// One event a frame, in order of stamps, made on demand. `previous` is the frame before in time or nullptr.
class FrameSource : public EventSource {
 public:
  /// nullopt = no event for this frame; whoever makes events counts why.
  using Make = std::function<std::optional<Payload>(const FrameRow& row, const FrameRow* previous)>;
  using Limit = std::function<void(const TimeSpan& span)>;  ///< further accounting; may be empty

  FrameSource(std::shared_ptr<FrameTable> table, std::size_t stream, Make make, Limit on_limit = {});
  std::optional<Stamp> firstStamp() override;
  std::optional<Stamp> lastStamp() override;
  void limit(const TimeSpan& span) override;
  std::optional<Event> next() override;

 private:
  std::shared_ptr<FrameTable> table_;
  std::size_t stream_;
  Make make_;
  Limit on_limit_;
  TimeSpan span_;
  std::size_t next_ = 0;
};

}  // namespace atlas::record
