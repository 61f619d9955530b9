// SPDX-License-Identifier: MIT
#include "record/bud_lidar.hpp"

#include <algorithm>
#include <cstdio>

#include "record/frame_table.hpp"
#include "record/row_source.hpp"
#include "record/scan_store.hpp"
#include "record/sweep_timing.hpp"

namespace atlas::record {
namespace {

/// Makes the sweep of a row. A scan that is missing or damaged gives an empty sweep, so that indices stay
/// aligned.
class SweepMaker {
 public:
  SweepMaker(std::string lidar, std::unique_ptr<ScanStore> store, const FrameTable& table,
             const RecordOptions& options, std::shared_ptr<RecordLog> log)
      : lidar_(std::move(lidar)), store_(std::move(store)), log_(std::move(log)) {
    const std::string place = store_ ? store_->place() : "scans";
    name_ = lidar_ + "/" + (place.empty() ? "scan*.pcd" : place);
    timing_.stamp_marks = options.scan_stamp;
    timing_.rotating = lidar_ != "lidar_center";
    latency_ = fromSeconds(options.lidar_latency_s);
    usual_s_ = usualRevolution(intervals(table));
    if (!store_)
      log_->note(lidar_ + ": no scans (neither scan*.pcd nor scans/ nor scans.zip), sweeps are empty");
    if (store_ && !store_->listingError().empty()) log_->note(name_ + ": " + store_->listingError());
  }

  /// Books the scans that no row of `table` inside `span` asks for.
  void account(const FrameTable& table, const TimeSpan& span) {
    if (!store_) return;
    if (store_->repeated() > 0) {
      log_->file(name_).rows += store_->repeated();
      log_->skip(name_, "scan number repeated", "", store_->repeated());
    }
    for (const std::uint32_t index : store_->indices()) {
      const FrameRow* row = table.find(index);
      if (row && span.contains(row->stamp)) continue;
      ++log_->file(name_).rows;
      log_->skip(name_, row ? kOutsideSpan : "no row in timestamps.txt",
                 row ? "" : name_ + ": scan " + std::to_string(index) + " has no row in timestamps.txt");
    }
  }

  Payload make(const FrameRow& row, const FrameRow* previous) {
    ++log_->file(name_).rows;
    auto sweep = std::make_shared<Sweep>();
    sweep->stamp = row.stamp;
    sweep->frame = lidar_;
    const ScanBytes scan = store_ ? store_->read(row.index) : ScanBytes{"", "scan missing"};
    if (!scan.error.empty()) return skip(row, scan.error, std::move(sweep));
    PcdCloud cloud = parsePcd(scan.bytes);
    if (!cloud.error.empty()) return skip(row, cloud.error, std::move(sweep));
    if (cloud.points.empty()) return skip(row, "scan without points", std::move(sweep));
    timing_.duration_s = revolutionDuration(previous ? interval(row, *previous) : std::nullopt, usual_s_);
    MadeSweep made = makeSweep(std::move(cloud), row.stamp, lidar_, timing_);
    if (!made.remark.empty()) log_->note(name_ + ": " + made.remark);
    *sweep = std::move(made.sweep);
    ++log_->file(name_).used;
    return SweepPtr(std::move(sweep));
  }

 private:
  Payload skip(const FrameRow& row, const std::string& reason, std::shared_ptr<Sweep> empty) {
    log_->skip(name_, reason, name_ + ": scan " + std::to_string(row.index) + ": " + reason);
    return SweepPtr(std::move(empty));
  }

  /// The lidar's own clock has less jitter than the system's, if both rows have it. nullopt when a scan
  /// between the two is missing.
  [[nodiscard]] std::optional<Duration> interval(const FrameRow& row, const FrameRow& previous) const {
    if (row.index != previous.index + 1) return std::nullopt;
    const auto now = decodeInnerTime(row.inner, row.stamp + latency_);
    const auto before = decodeInnerTime(previous.inner, previous.stamp + latency_);
    if (now && before) return now->time - before->time;
    return row.stamp - previous.stamp;
  }

  [[nodiscard]] std::vector<Duration> intervals(const FrameTable& table) const {
    std::vector<Duration> intervals;
    for (std::size_t i = 1; i < table.rows().size(); ++i) {
      const auto duration = interval(table.rows()[i], table.rows()[i - 1]);
      if (duration) intervals.push_back(*duration);
    }
    return intervals;
  }

  std::string lidar_, name_;
  std::unique_ptr<ScanStore> store_;
  std::shared_ptr<RecordLog> log_;
  SweepTiming timing_;
  Duration latency_ = 0;
  double usual_s_ = 0.1;  ///< duration of a revolution
};

/// Summary of the inner clock for the notes.
void noteInnerClock(const FrameTable& table, Duration latency, RecordLog& log) {
  std::vector<Duration> offsets;
  std::uint64_t repaired = 0, undecodable = 0;
  for (const FrameRow& row : table.rows()) {
    if (row.inner == 0) continue;
    const auto inner = decodeInnerTime(row.inner, row.stamp + latency);
    if (!inner) {
      ++undecodable;
      continue;
    }
    repaired += inner->repaired ? 1 : 0;
    offsets.push_back(row.stamp + latency - inner->time);
  }
  if (undecodable > 0) {
    log.note(table.name() + ": " + std::to_string(undecodable) +
             " inner times that are no time near the stamp");
  }
  if (offsets.empty()) return;
  const auto middle = offsets.begin() + static_cast<std::ptrdiff_t>(offsets.size() / 2);
  std::nth_element(offsets.begin(), middle, offsets.end());
  char text[160];
  std::snprintf(text, sizeof(text),
                ": system stamp minus lidar clock %.3f ms (median of %zu), %llu times off by 1 s repaired",
                toSeconds(*middle) * 1e3, offsets.size(), static_cast<unsigned long long>(repaired));
  log.note(table.name() + text);
}
}  // namespace

void addBudLidar(const std::filesystem::path& record, const std::string& lidar, const RecordOptions& options,
                 StreamSet& streams, RecordParts& parts) {
  const std::filesystem::path folder = record / lidar;
  std::error_code error;
  if (!std::filesystem::exists(folder / "timestamps.txt", error)) {
    if (std::filesystem::is_directory(folder, error))
      parts.log->note(lidar + ": no timestamps.txt, sensor skipped");
    return;
  }
  const std::uint64_t rows = countRows(folder / "timestamps.txt");
  const auto points = streams.add(lidar + "/points", StreamKind::kPoints, rows);
  const auto time = streams.add(lidar + "/time", StreamKind::kTimeReference);
  if (!points && !time) return;
  const Duration latency = fromSeconds(options.lidar_latency_s);
  auto table = std::make_shared<FrameTable>(folder / "timestamps.txt", lidar + "/timestamps.txt",
                                            FrameColumns::kInner, latency, parts.log);
  noteInnerClock(*table, latency, *parts.log);
  if (points) {
    auto maker = std::make_shared<SweepMaker>(lidar, openScanStore(folder), *table, options, parts.log);
    parts.sources.push_back(std::make_unique<FrameSource>(
        table, *points,
        [maker](const FrameRow& row, const FrameRow* previous) { return maker->make(row, previous); },
        [maker, table](const TimeSpan& span) { maker->account(*table, span); }));
  }
  if (time) {
    const auto make = [lidar, latency](const FrameRow& row, const FrameRow*) -> std::optional<Payload> {
      const auto inner = decodeInnerTime(row.inner, row.stamp + latency);
      if (!inner) return std::nullopt;  // in the notes
      return TimeReference{row.stamp, inner->time, lidar};
    };
    parts.sources.push_back(std::make_unique<FrameSource>(table, *time, make));
  }
}

}  // namespace atlas::record
