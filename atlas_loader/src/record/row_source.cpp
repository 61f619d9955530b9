// SPDX-License-Identifier: MIT
#include "record/row_source.hpp"

#include <algorithm>

#include "record/stamp_outlier.hpp"

namespace atlas::record {

RowSource::RowSource(RowFile file, std::shared_ptr<RecordLog> log)
    : file_(std::move(file)),
      log_(std::move(log)),
      lines_(file_.path),
      fields_(file_.name, ','),
      typical_(typicalStamp(file_.path, kReorderRows)) {
  log_->file(file_.name);
  if (!lines_.opened()) log_->note(file_.name + ": cannot be opened");
}

void RowSource::take(const Line& line) {
  if (isBlank(line.text)) return;
  ++log_->file(file_.name).rows;
  fields_.assign(line);
  std::vector<Event> events;
  const Stamp stamp = fields_.ok() ? file_.parser(fields_, events) : 0;
  if (fields_.ok() && isOutlier(stamp + file_.latency, typical_)) {
    fields_.fail(kOutlier,
                 "field 1 (stamp): far from the others: '" + std::to_string(stamp + file_.latency) + "'");
  }
  if (!fields_.ok()) {
    log_->skip(file_.name, fields_.reason(), fields_.example());
    return;
  }
  if (stamp < delivered_) {
    log_->skip(file_.name, kBeyondReorder,
               file_.name + ":" + std::to_string(line.number) + ": stamp " + std::to_string(stamp) +
                   " goes back behind " + std::to_string(delivered_));
    return;
  }
  if (stamp < newest_) ++inversions_;
  if (stamp == newest_) ++repeated_;
  newest_ = std::max(newest_, stamp);
  window_.emplace(Key(stamp, line.number), std::move(events));
}

void RowSource::fill() {
  while (!exhausted_ && window_.size() < kReorderRows) {
    const auto line = lines_.next();
    if (line) {
      take(*line);
    } else {
      exhausted_ = true;
    }
  }
}

std::optional<Stamp> RowSource::firstStamp() {
  fill();
  if (window_.empty()) return std::nullopt;
  return window_.begin()->first.first;
}

std::optional<Stamp> RowSource::lastStamp() {
  std::error_code error;
  const auto size = std::filesystem::file_size(file_.path, error);
  if (error) return std::nullopt;
  LineReader tail(file_.path);
  const std::uint64_t start = size > 4096 ? size - 4096 : 0;  // the last few rows; the first may be cut
  tail.seek(start, 1);
  std::optional<Stamp> last;
  RowFields fields(file_.name, ',');
  while (const auto line = tail.next()) {
    if ((start > 0 && line->number == 1) || isBlank(line->text)) continue;
    fields.assign(*line);
    const Stamp stamp = fields.stamp(0);
    if (fields.ok() && !isOutlier(stamp, typical_)) last = std::max(last.value_or(stamp), stamp);
  }
  if (last) *last -= file_.latency;
  return last;
}

/// Moves the rows of the earliest stamp to ready_, their events in the order of streams.
void RowSource::takeOut() {
  delivered_ = window_.begin()->first.first;
  while (!window_.empty() && window_.begin()->first.first == delivered_) {
    auto row = window_.extract(window_.begin());
    if (!span_.contains(delivered_)) {
      log_->skip(file_.name, kOutsideSpan);
      continue;
    }
    ++log_->file(file_.name).used;
    std::move(row.mapped().begin(), row.mapped().end(), std::back_inserter(ready_));
  }
  std::stable_sort(ready_.begin(), ready_.end(),
                   [](const Event& a, const Event& b) { return a.stream < b.stream; });
  std::reverse(ready_.begin(), ready_.end());
}

std::optional<Event> RowSource::next() {
  while (ready_.empty()) {
    fill();
    if (window_.empty()) {
      end();
      return std::nullopt;
    }
    takeOut();
  }
  Event event = std::move(ready_.back());
  ready_.pop_back();
  return event;
}

void RowSource::end() {
  if (ended_) return;
  ended_ = true;
  const FileReport& report = log_->file(file_.name);
  if (lines_.opened() && report.rows == 0) log_->note(file_.name + ": empty");
  if (inversions_ > 0) {
    log_->note(file_.name + ": " + std::to_string(inversions_) + " rows out of order, sorted by stamp");
  }
  if (repeated_ > 0) {
    log_->note(file_.name + ": " + std::to_string(repeated_) + " rows repeat the stamp before them");
  }
  if (file_.at_end) file_.at_end();
}

std::uint64_t countRows(const std::filesystem::path& path) {
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error || size > (64u << 20)) return 0;
  LineReader lines(path);
  std::uint64_t rows = 0;
  while (const auto line = lines.next()) rows += isBlank(line->text) ? 0 : 1;
  return rows;
}

}  // namespace atlas::record
