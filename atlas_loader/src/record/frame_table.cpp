// SPDX-License-Identifier: MIT
#include "record/frame_table.hpp"

#include <algorithm>
#include <limits>

#include "record/stamp_outlier.hpp"

namespace atlas::record {

FrameTable::FrameTable(const std::filesystem::path& path, const std::string& name, FrameColumns columns,
                       Duration latency, std::shared_ptr<RecordLog> log)
    : name_(name), log_(std::move(log)) {
  LineReader lines(path);
  log_->file(name_);
  if (!lines.opened()) log_->note(name_ + ": cannot be opened");
  read(lines, columns, latency);
  dropOutliers();
  dropRepeated();
  if (lines.opened() && rows_.empty()) log_->note(name_ + ": no usable rows");
  sortRows();
}

FrameTable::FrameTable(std::vector<FrameRow> rows, const std::string& name, std::shared_ptr<RecordLog> log)
    : name_(name), log_(std::move(log)), rows_(std::move(rows)), accounted_(name.empty()) {
  sortRows();
}

void FrameTable::read(LineReader& lines, FrameColumns columns, Duration latency) {
  RowFields fields(name_, ',');
  while (const auto line = lines.next()) {
    if (isBlank(line->text)) continue;
    ++log_->file(name_).rows;
    fields.assign(*line);
    FrameRow row;
    row.line = static_cast<std::uint32_t>(line->number);
    if (columns == FrameColumns::kTemperatures) {
      fields.expect(4);
      row.minimum_degc = fields.number(2, "t_min");
      row.maximum_degc = fields.number(3, "t_max");
    } else if (fields.size() != 2) {
      fields.expect(3);
      row.inner = fields.unsignedInteger(2, "inner_ts");
    }
    row.stamp = fields.stamp(0) - latency;
    constexpr std::int64_t kMaxIndex = std::numeric_limits<std::int32_t>::max();
    row.index = static_cast<std::uint32_t>(fields.integer(1, "index", 0, kMaxIndex));
    if (fields.ok()) {
      rows_.push_back(row);
    } else {
      log_->skip(name_, fields.reason(), fields.example());
    }
  }
}

void FrameTable::dropOutliers() {
  std::vector<Stamp> stamps;
  for (const FrameRow& row : rows_) stamps.push_back(row.stamp);
  const auto typical = typicalStamp(std::move(stamps));
  const auto gone = std::stable_partition(
      rows_.begin(), rows_.end(), [&](const FrameRow& row) { return !isOutlier(row.stamp, typical); });
  for (auto row = gone; row != rows_.end(); ++row) {
    log_->skip(name_, kOutlier,
               name_ + ":" + std::to_string(row->line) + ": field 1 (stamp): far from the others: '" +
                   std::to_string(row->stamp) + "'");
  }
  rows_.erase(gone, rows_.end());
}

/// The first row of an index counts; a second one is a fault of the file.
void FrameTable::dropRepeated() {
  std::stable_sort(rows_.begin(), rows_.end(),
                   [](const FrameRow& a, const FrameRow& b) { return a.index < b.index; });
  std::vector<FrameRow> kept;
  kept.reserve(rows_.size());
  for (const FrameRow& row : rows_) {
    if (kept.empty() || kept.back().index != row.index) {
      kept.push_back(row);
      continue;
    }
    log_->skip(name_, "frame index repeated",
               name_ + ":" + std::to_string(row.line) + ": field 2 (index): repeated: '" +
                   std::to_string(row.index) + "'");
  }
  rows_ = std::move(kept);
}

/// From the order of indices to the order of stamps.
void FrameTable::sortRows() {
  std::vector<std::uint32_t> place(rows_.size());
  for (std::uint32_t i = 0; i < place.size(); ++i) place[i] = i;
  std::sort(place.begin(), place.end(), [this](std::uint32_t a, std::uint32_t b) {
    return std::make_pair(rows_[a].stamp, a) < std::make_pair(rows_[b].stamp, b);
  });
  std::uint64_t moved = 0;
  std::vector<FrameRow> sorted;
  sorted.reserve(rows_.size());
  disorder_ = 0;
  for (std::uint32_t i = 0; i < place.size(); ++i) {
    const std::size_t distance = place[i] > i ? place[i] - i : i - place[i];
    moved += distance > 0 ? 1 : 0;
    disorder_ = std::max(disorder_, distance);
    sorted.push_back(rows_[place[i]]);
  }
  rows_ = std::move(sorted);
  indexRows();
  if (moved > 0) {
    log_->note(name_ + ": " + std::to_string(moved) + " rows out of order, sorted by stamp");
  }
}

void FrameTable::indexRows() {
  place_of_index_.clear();
  for (std::uint32_t i = 0; i < rows_.size(); ++i) place_of_index_.emplace_back(rows_[i].index, i);
  std::sort(place_of_index_.begin(), place_of_index_.end());
}

const FrameRow* FrameTable::find(std::uint64_t index) const {
  const auto it =
      std::lower_bound(place_of_index_.begin(), place_of_index_.end(), index,
                       [](const auto& entry, std::uint64_t wanted) { return entry.first < wanted; });
  return it != place_of_index_.end() && it->first == index ? &rows_[it->second] : nullptr;
}

void FrameTable::limitFrames(std::uint64_t frames) {
  const auto gone = std::remove_if(rows_.begin(), rows_.end(),
                                   [frames](const FrameRow& row) { return row.index >= frames; });
  without_frame_ += static_cast<std::uint64_t>(rows_.end() - gone);
  rows_.erase(gone, rows_.end());
  indexRows();
}

void FrameTable::account(const TimeSpan& span) {
  if (accounted_) return;
  accounted_ = true;
  const auto inside = static_cast<std::uint64_t>(std::count_if(
      rows_.begin(), rows_.end(), [&span](const FrameRow& row) { return span.contains(row.stamp); }));
  log_->file(name_).used += inside;
  log_->skip(name_, kOutsideSpan, "", rows_.size() - inside);
  log_->skip(name_, "the video has no such frame", "", without_frame_);
}

void FrameTable::accountUnused(const std::string& reason) {
  if (accounted_) return;
  accounted_ = true;
  log_->skip(name_, reason, "", rows_.size() + without_frame_);
}

FrameSource::FrameSource(std::shared_ptr<FrameTable> table, std::size_t stream, Make make, Limit on_limit)
    : table_(std::move(table)), stream_(stream), make_(std::move(make)), on_limit_(std::move(on_limit)) {}

std::optional<Stamp> FrameSource::firstStamp() {
  if (table_->rows().empty()) return std::nullopt;
  return table_->rows().front().stamp;
}

std::optional<Stamp> FrameSource::lastStamp() {
  if (table_->rows().empty()) return std::nullopt;
  return table_->rows().back().stamp;
}

void FrameSource::limit(const TimeSpan& span) {
  span_ = span;
  table_->account(span);
  if (on_limit_) on_limit_(span);
  while (next_ < table_->rows().size() && table_->rows()[next_].stamp < span_.begin) ++next_;
}

std::optional<Event> FrameSource::next() {
  const std::vector<FrameRow>& rows = table_->rows();
  while (next_ < rows.size() && span_.contains(rows[next_].stamp)) {
    const FrameRow& row = rows[next_];
    const FrameRow* previous = next_ > 0 ? &rows[next_ - 1] : nullptr;
    ++next_;
    auto payload = make_(row, previous);
    if (payload) return Event{row.stamp, stream_, std::move(*payload)};
  }
  return std::nullopt;
}

}  // namespace atlas::record
