// SPDX-License-Identifier: MIT
#include "record/kitti_reader.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <stdexcept>

#include "record/frame_table.hpp"
#include "record/kitti_calibration.hpp"
#include "record/kitti_files.hpp"
#include "record/kitti_rows.hpp"
#include "record/kitti_sweep.hpp"
#include "record/merged_reader.hpp"

namespace atlas::record {
namespace {
namespace fs = std::filesystem;

/// The frame time of a sensor without timestamps: drive_0057, whose Velodyne stamps are known, has its OXTS
/// stamps 11.7 .. 25.0 ms (mean 17.2 ms) after the moment at which the lidar looks forward and the cameras
/// are triggered.
constexpr Duration kOxtsDelay = 17 * kMillisecond;

/// imu/data, gnss/fix and gnss/heading from one file per frame.
class OxtsSource : public EventSource {
 public:
  struct Streams {
    std::optional<std::size_t> imu, fix, heading;
  };
  OxtsSource(std::map<std::uint32_t, Stamp> stamps, std::map<std::uint32_t, fs::path> files, Streams streams,
             const RecordOptions& options, std::shared_ptr<RecordLog> log)
      : files_(std::move(files)), streams_(streams), log_(std::move(log)), fields_("oxts/data", ' ') {
    const auto latency = [](double seconds) { return fromSeconds(seconds); };
    imu_latency_ = latency(options.imu_latency_s);
    gnss_latency_ = latency(options.gnss_latency_s);
    for (const auto& [index, stamp] : stamps) order_.emplace_back(stamp, index);
    std::sort(order_.begin(), order_.end());
  }
  std::optional<Stamp> firstStamp() override {
    if (order_.empty()) return std::nullopt;
    return order_.front().first - std::max(imu_latency_, gnss_latency_);
  }
  std::optional<Stamp> lastStamp() override {
    if (order_.empty()) return std::nullopt;
    return order_.back().first - std::min(imu_latency_, gnss_latency_);
  }
  void limit(const TimeSpan& span) override {
    span_ = span;
    std::set<std::uint32_t> stamped;
    for (const auto& [stamp, index] : order_) stamped.insert(index);
    for (const auto& [index, path] : files_) {
      if (stamped.count(index) > 0) continue;
      ++log_->file("oxts/data").rows;
      log_->skip("oxts/data", "no row in timestamps.txt",
                 "oxts/data/" + path.filename().string() + ": no stamp");
    }
  }
  std::optional<Event> next() override {
    // Latencies shift the streams against each other: read ahead until nothing earlier can come.
    const Duration spread = std::max(imu_latency_, gnss_latency_) - std::min(imu_latency_, gnss_latency_);
    while (next_ < order_.size() &&
           (ready_.empty() || order_[next_].first - std::max(imu_latency_, gnss_latency_) <=
                                  ready_.begin()->first.first + spread)) {
      read(order_[next_].first, order_[next_].second);
      ++next_;
    }
    if (ready_.empty()) return std::nullopt;
    Event event = std::move(ready_.extract(ready_.begin()).mapped());
    return event;
  }

 private:
  void read(Stamp stamp, std::uint32_t index) {
    FileReport& data = log_->file("oxts/data");
    ++data.rows;
    const bool inside = span_.contains(stamp - imu_latency_) || span_.contains(stamp - gnss_latency_);
    if (!inside) {
      log_->skip("oxts/timestamps.txt", kOutsideSpan);
      log_->skip("oxts/data", kOutsideSpan);
      return;
    }
    ++log_->file("oxts/timestamps.txt").used;
    const std::string name = "oxts/data/" + kittiFileName(index, ".txt");
    const auto file = files_.find(index);
    LineReader lines(file == files_.end() ? fs::path() : file->second);
    const auto line = lines.next();
    if (!line) {
      log_->skip("oxts/data", file == files_.end() ? "file missing" : "file empty or unreadable",
                 name + ": missing");
      return;
    }
    fields_ = RowFields(name, ' ');
    fields_.assign(*line);
    OxtsSample sample = parseOxts(fields_, stamp);
    if (!fields_.ok()) {
      log_->skip("oxts/data", fields_.reason(), fields_.example());
      return;
    }
    ++data.used;
    sample.imu.stamp = stamp - imu_latency_;
    sample.fix.stamp = sample.heading.stamp = stamp - gnss_latency_;
    add(streams_.imu, sample.imu.stamp, sample.imu);
    add(streams_.fix, sample.fix.stamp, sample.fix);
    add(streams_.heading, sample.heading.stamp, sample.heading);
  }
  void add(const std::optional<std::size_t>& stream, Stamp stamp, Payload payload) {
    if (!stream || !span_.contains(stamp)) return;
    ready_.emplace(std::make_pair(stamp, *stream), Event{stamp, *stream, std::move(payload)});
  }

  std::map<std::uint32_t, fs::path> files_;
  Streams streams_;
  std::shared_ptr<RecordLog> log_;
  RowFields fields_;
  Duration imu_latency_ = 0, gnss_latency_ = 0;
  std::vector<std::pair<Stamp, std::uint32_t>> order_;
  TimeSpan span_;
  std::multimap<std::pair<Stamp, std::size_t>, Event> ready_;
  std::size_t next_ = 0;
};

class Assembly {
 public:
  Assembly(const fs::path& record, const RecordOptions& options)
      : options_(options), streams_(options.topics), files_(findKittiFiles(record, options.calibration_dir)) {
    parts_.log = std::make_shared<RecordLog>();
  }

  RecordParts build() {
    readCalibration();
    addOxts();
    addVelodyne();
    for (const char* camera : {"image_02", "image_03"}) addCamera(camera);
    for (const std::string& note : files_.notes) log().note(note);
    for (const std::string& topic : streams_.unknown()) {
      log().note("topic '" + topic + "' was asked for, the record has none of this name");
    }
    parts_.streams = streams_.streams();
    return std::move(parts_);
  }

 private:
  RecordLog& log() { return *parts_.log; }

  void readCalibration() {
    if (files_.calibration.empty()) {
      log().note("calibration: no calib_*.txt found, tf_static has the imu only and there is no camera_info");
      calibration_.transforms.transforms.push_back({"base_link", "imu", Pose{}});
    } else {
      calibration_ = readKittiCalibration(files_.calibration);
    }
    for (const std::string& note : calibration_.notes) log().note(note);
    parts_.static_transforms = calibration_.transforms;
  }

  void addOxts() {
    const fs::path folder = files_.sensor("oxts");
    if (folder.empty()) {
      log().note("oxts: missing, no imu and no gnss");
      return;
    }
    oxts_stamps_ = readKittiStamps(folder / "timestamps.txt", "oxts/timestamps.txt", log());
    if (oxts_stamps_.empty()) log().note("oxts/timestamps.txt: no usable rows");
    const auto rows = static_cast<std::uint64_t>(oxts_stamps_.size());
    OxtsSource::Streams streams;
    streams.imu = streams_.add("imu/data", StreamKind::kImu, rows);
    streams.fix = streams_.add("gnss/fix", StreamKind::kGnssFix, rows);
    streams.heading = streams_.add("gnss/heading", StreamKind::kGnssHeading, rows);
    if (!streams.imu && !streams.fix && !streams.heading) return;
    parts_.sources.push_back(std::make_unique<OxtsSource>(
        oxts_stamps_, kittiFrames(folder / "data", {".txt"}), streams, options_, parts_.log));
  }

  /// Frame times of a sensor: its own timestamps.txt, else from OXTS for the files that are there.
  std::map<std::uint32_t, Stamp> frameTimes(const std::string& sensor,
                                            const std::map<std::uint32_t, fs::path>& files, bool& own) {
    const fs::path path = files_.sensor(sensor) / "timestamps.txt";
    std::error_code error;
    own = fs::exists(path, error);
    if (own) return readKittiStamps(path, sensor + "/timestamps.txt", log());
    std::map<std::uint32_t, Stamp> times;
    for (const auto& [index, file] : files) {
      const auto velodyne = velodyne_times_.find(index);
      const auto oxts = oxts_stamps_.find(index);
      if (velodyne != velodyne_times_.end()) {
        times[index] = velodyne->second;
      } else if (oxts != oxts_stamps_.end()) {
        times[index] = oxts->second - kOxtsDelay;
      }
    }
    if (!times.empty())
      log().note(sensor + ": no timestamps.txt, times from those of the lidar or of OXTS - 17 ms");
    return times;
  }

  void bookStampless(const std::string& sensor, const std::map<std::uint32_t, fs::path>& files,
                     const std::map<std::uint32_t, Stamp>& times) {
    const std::string name = sensor + "/data";
    for (const auto& [index, path] : files) {
      if (times.count(index) > 0) continue;
      ++log().file(name).rows;
      log().skip(name, "no stamp for this frame", name + "/" + path.filename().string() + ": no stamp");
    }
  }

  std::shared_ptr<FrameTable> makeTable(const std::string& sensor,
                                        const std::map<std::uint32_t, Stamp>& times, bool own,
                                        Duration latency) {
    std::vector<FrameRow> rows;
    for (const auto& [index, stamp] : times) {
      FrameRow row;
      row.stamp = stamp - latency;
      row.index = index;
      rows.push_back(row);
    }
    return std::make_shared<FrameTable>(std::move(rows), own ? sensor + "/timestamps.txt" : "", parts_.log);
  }

  /// Reads the frame's file; what went wrong is booked under <sensor>/data.
  static std::optional<std::string> readFrame(const std::map<std::uint32_t, fs::path>& files,
                                              const FrameRow& row, const std::string& sensor,
                                              RecordLog& log) {
    const std::string name = sensor + "/data";
    ++log.file(name).rows;
    const auto it = files.find(row.index);
    auto bytes = it == files.end() ? std::nullopt : readWholeFile(it->second);
    if (bytes) return bytes;
    log.skip(name, it == files.end() ? "file missing" : "file unreadable",
             name + "/" + kittiFileName(row.index, "") + ": missing or unreadable");
    return std::nullopt;
  }

  void addVelodyne() {
    const std::string sensor = "velodyne_points";
    const fs::path folder = files_.sensor(sensor);
    if (folder.empty()) return;
    auto files = kittiFrames(folder / "data", {".bin"});
    bool own = false;
    const auto forward = frameTimes(sensor, files, own);
    velodyne_times_ = forward;
    bookStampless(sensor, files, forward);
    auto spins = readSpins(folder, forward);
    std::map<std::uint32_t, Stamp> ends;
    for (const auto& [index, spin] : spins) ends[index] = spin.end();
    const auto stream = streams_.add("velodyne/points", StreamKind::kPoints, ends.size());
    if (!stream) return;
    const Duration latency = fromSeconds(options_.lidar_latency_s);
    const auto table = makeTable(sensor, ends, own, latency);
    const auto make = [files = std::move(files), spins = std::move(spins), log = parts_.log, sensor](
                          const FrameRow& row, const FrameRow*) -> std::optional<Payload> {
      auto sweep = std::make_shared<Sweep>();
      sweep->frame = "velodyne";
      if (const auto bytes = readFrame(files, row, sensor, *log)) {
        auto parsed = parseKittiSweep(*bytes, spins.at(row.index));
        if (parsed) {
          *sweep = std::move(*parsed);
          ++log->file(sensor + "/data").used;
        } else {
          log->skip(sensor + "/data", "not a whole number of points of 16 bytes",
                    sensor + "/data/" + kittiFileName(row.index, ".bin") + ": " +
                        std::to_string(bytes->size()) + " bytes");
        }
      }
      sweep->stamp = row.stamp;
      return SweepPtr(std::move(sweep));
    };
    parts_.sources.push_back(std::make_unique<FrameSource>(table, *stream, make, bookOutside(sensor, table)));
  }

  /// With timestamps_start.txt and timestamps_end.txt the period is measured, else it is the sensor's usual
  /// one.
  std::map<std::uint32_t, KittiSpin> readSpins(const fs::path& folder,
                                               const std::map<std::uint32_t, Stamp>& forward) {
    std::map<std::uint32_t, KittiSpin> spins;
    const std::string name = "velodyne_points/timestamps_";
    const auto starts = readKittiStamps(folder / "timestamps_start.txt", name + "start.txt", log());
    const auto ends = readKittiStamps(folder / "timestamps_end.txt", name + "end.txt", log());
    if (!starts.empty()) log().file(name + "start.txt").used = starts.size();
    if (!ends.empty()) log().file(name + "end.txt").used = ends.size();
    for (const auto& [index, stamp] : forward) {
      KittiSpin spin;
      spin.forward = stamp;
      const auto start = starts.find(index), end = ends.find(index);
      if (start != starts.end() && end != ends.end()) {
        const double period_s = toSeconds(end->second - start->second);
        if (period_s > 0.05 && period_s < 0.2) spin.period_s = period_s;
      }
      spins[index] = spin;
    }
    return spins;
  }

  FrameSource::Limit bookOutside(const std::string& sensor, const std::shared_ptr<FrameTable>& table) {
    return [sensor, table, log = parts_.log](const TimeSpan& span) {
      for (const FrameRow& row : table->rows()) {
        if (span.contains(row.stamp)) continue;
        ++log->file(sensor + "/data").rows;
        log->skip(sensor + "/data", kOutsideSpan);
      }
    };
  }

  void addCamera(const std::string& camera) {
    const fs::path folder = files_.sensor(camera);
    if (folder.empty()) return;
    auto files = kittiFrames(folder / "data", {".png", ".jpg", ".jpeg"});
    bool own = false;
    const auto times = frameTimes(camera, files, own);
    bookStampless(camera, files, times);
    const auto table = makeTable(camera, times, own, 0);
    const auto info = calibration_.cameras.find(camera);
    if (info == calibration_.cameras.end()) {
      log().note(camera + ": no calibration, no camera_info");
    } else {
      noteSize(camera, files, info->second);
      const auto stream = streams_.add(camera + "/camera_info", StreamKind::kCameraInfo, times.size());
      const auto make = [camera_info = info->second, indices = indicesOf(files)](
                            const FrameRow& row, const FrameRow*) -> std::optional<Payload> {
        if (indices.count(row.index) == 0) return std::nullopt;
        CameraInfo stamped = camera_info;
        stamped.stamp = row.stamp;
        return stamped;
      };
      if (stream) parts_.sources.push_back(std::make_unique<FrameSource>(table, *stream, make));
    }
    addPictures(camera, std::move(files), table);
  }

  static std::set<std::uint32_t> indicesOf(const std::map<std::uint32_t, fs::path>& files) {
    std::set<std::uint32_t> indices;
    for (const auto& [index, path] : files) indices.insert(index);
    return indices;
  }

  void noteSize(const std::string& camera, const std::map<std::uint32_t, fs::path>& files,
                const CameraInfo& info) {
    if (files.empty()) return;
    const cv::Mat first = cv::imread(files.begin()->second.string(), cv::IMREAD_UNCHANGED);
    if (first.empty()) return;
    if (first.cols == static_cast<int>(info.width) && first.rows == static_cast<int>(info.height)) return;
    log().note(camera + ": pictures are " + std::to_string(first.cols) + "x" + std::to_string(first.rows) +
               ", calibration is for " + std::to_string(info.width) + "x" + std::to_string(info.height) +
               ", camera_info is not scaled");
  }

  void addPictures(const std::string& camera, std::map<std::uint32_t, fs::path> files,
                   const std::shared_ptr<FrameTable>& table) {
    const bool pixels = options_.images == RecordOptions::Images::kPixels;
    const auto stream =
        streams_.add(camera + (pixels ? "/image_raw" : "/image_raw/compressed"),
                     pixels ? StreamKind::kImage : StreamKind::kCompressedImage, table->rows().size());
    if (!stream) return;
    const auto make = [files = std::move(files), log = parts_.log, camera, pixels](
                          const FrameRow& row, const FrameRow*) -> std::optional<Payload> {
      const auto bytes = readFrame(files, row, camera, *log);
      if (!bytes) return std::nullopt;
      auto image = kittiImage(*bytes, pixels);
      if (!image) {
        log->skip(camera + "/data", "picture damaged",
                  camera + "/data/" + files.at(row.index).filename().string() + ": no whole PNG or JPEG");
        return std::nullopt;
      }
      image->stamp = row.stamp;
      image->frame = camera;
      ++log->file(camera + "/data").used;
      return ImagePtr(std::move(image));
    };
    parts_.sources.push_back(std::make_unique<FrameSource>(table, *stream, make, bookOutside(camera, table)));
  }

  RecordOptions options_;
  StreamSet streams_;
  KittiFiles files_;
  KittiCalibration calibration_;
  std::map<std::uint32_t, Stamp> oxts_stamps_, velodyne_times_;
  RecordParts parts_;
};
}  // namespace

bool isKittiDrive(const fs::path& folder) { return !findKittiFiles(folder, "").sensors.empty(); }

std::unique_ptr<RecordReader> openKittiDrive(const fs::path& folder, const RecordOptions& options) {
  return std::make_unique<MergedReader>(Assembly(folder, options).build(), options);
}

}  // namespace atlas::record
