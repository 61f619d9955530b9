// SPDX-License-Identifier: MIT
#include "record/kitti_reader.hpp"

#include "record/frame_table.hpp"
#include "record/kitti_calibration.hpp"
#include "record/kitti_files.hpp"
#include "record/kitti_frames.hpp"
#include "record/kitti_oxts.hpp"
#include "record/kitti_sweep.hpp"
#include "record/kitti_times.hpp"
#include "record/merged_reader.hpp"

namespace atlas::record {
namespace {
namespace fs = std::filesystem;
constexpr const char* kVelodyne = "velodyne_points";

/// Makes the sweep of a row. A frame that is missing or damaged gives an empty sweep, so that indices stay
/// aligned.
Payload makeSweep(const FrameRow& row, const KittiFrames& frames, const KittiSpin& spin) {
  auto sweep = std::make_shared<Sweep>();
  sweep->frame = "velodyne";
  if (const auto bytes = frames.read(row.index)) {
    auto parsed = parseKittiSweep(*bytes, spin);
    if (parsed) {
      *sweep = std::move(*parsed);
      frames.bookUsed();
    } else {
      frames.bookSkipped(row.index, "not a whole number of points of 16 bytes",
                         std::to_string(bytes->size()) + " bytes");
    }
  }
  sweep->stamp = row.stamp;
  return SweepPtr(std::move(sweep));
}

/// nullopt, and booked why, when there is no whole picture.
std::optional<Payload> makePicture(const FrameRow& row, const KittiFrames& frames, bool pixels) {
  const auto bytes = frames.read(row.index);
  if (!bytes) return std::nullopt;
  auto image = kittiImage(*bytes, pixels);
  if (!image) {
    frames.bookSkipped(row.index, "picture damaged", "no whole PNG or JPEG");
    return std::nullopt;
  }
  image->stamp = row.stamp;
  image->frame = frames.sensor();
  frames.bookUsed();
  return ImagePtr(std::move(image));
}

class Assembly {
 public:
  Assembly(const fs::path& record, const RecordOptions& options)
      : options_(options),
        streams_(options.topics),
        files_(findKittiFiles(record, options.calibration_dir)) {}

  RecordParts build() {
    readCalibration();
    addOxts();
    addVelodyne();
    for (const char* camera : {"image_02", "image_03"}) addCamera(camera);
    times_.book();
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
    const bool wanted =
        streams_.wants("imu/data") || streams_.wants("gnss/fix") || streams_.wants("gnss/heading");
    const std::uint64_t rows = wanted ? times_.read("oxts").size() : 0;
    OxtsSource::Streams streams;
    streams.imu = streams_.add("imu/data", StreamKind::kImu, rows);
    streams.fix = streams_.add("gnss/fix", StreamKind::kGnssFix, rows);
    streams.heading = streams_.add("gnss/heading", StreamKind::kGnssHeading, rows);
    if (!wanted) return;
    times_.leaveToCaller("oxts");
    parts_.sources.push_back(std::make_unique<OxtsSource>(times_.read("oxts"),
                                                          KittiFrames("oxts", folder, {".txt"}, parts_.log),
                                                          streams, options_, parts_.log));
  }

  static std::shared_ptr<FrameTable> makeTable(const KittiStamps& stamps, const std::string& file,
                                               Duration latency, const std::shared_ptr<RecordLog>& log) {
    std::vector<FrameRow> rows;
    for (const auto& [index, stamp] : stamps) {
      FrameRow row;
      row.stamp = stamp - latency;
      row.index = index;
      rows.push_back(row);
    }
    return std::make_shared<FrameTable>(std::move(rows), file, log);
  }

  void addVelodyne() {
    const fs::path folder = files_.sensor(kVelodyne);
    if (folder.empty()) {
      log().note("velodyne_points: missing, no lidar");
      return;
    }
    if (!streams_.wants("velodyne/points")) {
      streams_.add("velodyne/points", StreamKind::kPoints);
      return;
    }
    auto frames =
        std::make_shared<KittiFrames>(kVelodyne, folder, std::vector<std::string>{".bin"}, parts_.log);
    const KittiTimes::Frames times = times_.of(kVelodyne, frames->indices());
    frames->bookStampless(times.stamps);
    auto spins = readSpins(times.stamps);
    KittiStamps ends;
    for (const auto& [index, spin] : spins) ends[index] = spin.end();
    const auto table = makeTable(ends, times.file, fromSeconds(options_.lidar_latency_s), parts_.log);
    const auto stream = streams_.add("velodyne/points", StreamKind::kPoints, ends.size());
    const auto make = [frames, spins = std::move(spins)](const FrameRow& row, const FrameRow*) {
      return makeSweep(row, *frames, spins.at(row.index));
    };
    parts_.sources.push_back(std::make_unique<FrameSource>(
        table, *stream, make, [frames, table](const TimeSpan& span) { frames->bookOutside(*table, span); }));
  }

  /// With timestamps_start.txt and timestamps_end.txt the period is measured, else it is the sensor's usual
  /// one.
  std::map<std::uint32_t, KittiSpin> readSpins(const KittiStamps& forward) {
    std::map<std::uint32_t, KittiSpin> spins;
    const KittiStamps& starts = times_.read(kVelodyne, "timestamps_start.txt");
    const KittiStamps& ends = times_.read(kVelodyne, "timestamps_end.txt");
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

  void addCamera(const std::string& camera) {
    const fs::path folder = files_.sensor(camera);
    if (folder.empty()) return;
    const bool pixels = options_.images == RecordOptions::Images::kPixels;
    const std::string pictures = camera + (pixels ? "/image_raw" : "/image_raw/compressed");
    const StreamKind kind = pixels ? StreamKind::kImage : StreamKind::kCompressedImage;
    const auto info = calibration_.cameras.find(camera);
    if (info == calibration_.cameras.end()) log().note(camera + ": no calibration, no camera_info");
    if (!streams_.wants(camera + "/camera_info") && !streams_.wants(pictures)) {
      if (info != calibration_.cameras.end()) streams_.add(camera + "/camera_info", StreamKind::kCameraInfo);
      streams_.add(pictures, kind);
      return;
    }
    const auto frames = std::make_shared<KittiFrames>(
        camera, folder, std::vector<std::string>{".png", ".jpg", ".jpeg"}, parts_.log);
    const KittiTimes::Frames times = times_.of(camera, frames->indices());
    const auto table = makeTable(times.stamps, times.file, 0, parts_.log);
    std::size_t sources = 0;
    if (info != calibration_.cameras.end()) sources += addInfo(info->second, frames, table) ? 1 : 0;
    if (const auto stream = streams_.add(pictures, kind, table->rows().size())) {
      frames->bookStampless(times.stamps);
      const auto make = [frames, pixels](const FrameRow& row, const FrameRow*) {
        return makePicture(row, *frames, pixels);
      };
      parts_.sources.push_back(std::make_unique<FrameSource>(
          table, *stream, make,
          [frames, table](const TimeSpan& span) { frames->bookOutside(*table, span); }));
      ++sources;
    }
    if (sources == 0) table->accountUnused("nothing of this camera is read");
  }

  bool addInfo(const CameraInfo& info, const std::shared_ptr<KittiFrames>& frames,
               const std::shared_ptr<FrameTable>& table) {
    const std::string& camera = frames->sensor();
    noteSize(*frames, info);
    const auto stream = streams_.add(camera + "/camera_info", StreamKind::kCameraInfo, table->rows().size());
    if (!stream) return false;
    const auto make = [info, frames](const FrameRow& row, const FrameRow*) -> std::optional<Payload> {
      if (frames->find(row.index) == nullptr) return std::nullopt;
      CameraInfo stamped = info;
      stamped.stamp = row.stamp;
      return stamped;
    };
    parts_.sources.push_back(std::make_unique<FrameSource>(table, *stream, make));
    return true;
  }

  void noteSize(const KittiFrames& frames, const CameraInfo& info) {
    if (frames.indices().empty()) return;
    const auto bytes = readWholeFile(*frames.find(*frames.indices().begin()));
    const auto first = bytes ? kittiImage(*bytes, true) : nullptr;
    if (!first) return;
    const cv::Mat& picture = first->pixels;
    if (picture.cols == static_cast<int>(info.width) && picture.rows == static_cast<int>(info.height)) return;
    log().note(frames.sensor() + ": pictures are " + std::to_string(picture.cols) + "x" +
               std::to_string(picture.rows) + ", calibration is for " + std::to_string(info.width) + "x" +
               std::to_string(info.height) + ", camera_info is not scaled");
  }

  RecordOptions options_;
  StreamSet streams_;
  KittiFiles files_;
  KittiCalibration calibration_;
  RecordParts parts_{std::make_shared<RecordLog>(), {}, {}, {}};
  KittiTimes times_{files_, parts_.log};
};
}  // namespace

bool isKittiDrive(const fs::path& folder) { return !findKittiFiles(folder, "").sensors.empty(); }

std::unique_ptr<RecordReader> openKittiDrive(const fs::path& folder, const RecordOptions& options) {
  return std::make_unique<MergedReader>(Assembly(folder, options).build(), options);
}

}  // namespace atlas::record
