// SPDX-License-Identifier: MIT
#include "record/kitti_oxts.hpp"

#include <algorithm>

#include "record/kitti_files.hpp"
#include "record/kitti_rows.hpp"

namespace atlas::record {
namespace {
constexpr const char* kRows = "oxts/timestamps.txt";
}

OxtsSource::OxtsSource(const KittiStamps& stamps, KittiFrames files, Streams streams,
                       const RecordOptions& options, std::shared_ptr<RecordLog> log)
    : files_(std::move(files)),
      streams_(streams),
      log_(std::move(log)),
      imu_latency_(fromSeconds(options.imu_latency_s)),
      gnss_latency_(fromSeconds(options.gnss_latency_s)) {
  for (const auto& [index, stamp] : stamps) order_.emplace_back(stamp, index);
  std::sort(order_.begin(), order_.end());
  files_.bookStampless(stamps);
}

std::optional<Stamp> OxtsSource::firstStamp() {
  if (order_.empty()) return std::nullopt;
  return order_.front().first - std::max(imu_latency_, gnss_latency_);
}

std::optional<Stamp> OxtsSource::lastStamp() {
  if (order_.empty()) return std::nullopt;
  return order_.back().first - std::min(imu_latency_, gnss_latency_);
}

void OxtsSource::limit(const TimeSpan& span) { span_ = span; }

std::optional<Event> OxtsSource::next() {
  // Latencies shift the streams against each other: read ahead until nothing earlier can come.
  const Duration latest = std::max(imu_latency_, gnss_latency_);
  while (next_ < order_.size() &&
         (ready_.empty() || order_[next_].first - latest <= ready_.begin()->first.first)) {
    read(order_[next_].first, order_[next_].second);
    ++next_;
  }
  if (ready_.empty()) return std::nullopt;
  return std::move(ready_.extract(ready_.begin()).mapped());
}

void OxtsSource::read(Stamp stamp, std::uint32_t index) {
  const bool inside = span_.contains(stamp - imu_latency_) || span_.contains(stamp - gnss_latency_);
  if (!inside) {
    log_->skip(kRows, kOutsideSpan);
    ++log_->file("oxts/data").rows;
    log_->skip("oxts/data", kOutsideSpan);
    return;
  }
  ++log_->file(kRows).used;
  const auto text = files_.read(index);
  if (!text) return;
  RowFields fields("oxts/data/" + kittiFileName(index, ".txt"), ' ');
  const std::string_view row = std::string_view(*text).substr(0, text->find('\n'));
  fields.assign(Line{row.substr(0, LineReader::kMaxLine), 1, 0, row.size() > LineReader::kMaxLine});
  OxtsSample sample = parseOxts(fields, stamp);
  if (!fields.ok()) {
    log_->skip("oxts/data", isBlank(row) ? "file empty" : fields.reason(), fields.example());
    return;
  }
  files_.bookUsed();
  sample.imu.stamp = stamp - imu_latency_;
  sample.fix.stamp = sample.heading.stamp = stamp - gnss_latency_;
  add(streams_.imu, sample.imu.stamp, sample.imu);
  add(streams_.fix, sample.fix.stamp, sample.fix);
  add(streams_.heading, sample.heading.stamp, sample.heading);
}

void OxtsSource::add(const std::optional<std::size_t>& stream, Stamp stamp, Payload payload) {
  if (!stream || !span_.contains(stamp)) return;
  ready_.emplace(std::make_pair(stamp, *stream), Event{stamp, *stream, std::move(payload)});
}

}  // namespace atlas::record
