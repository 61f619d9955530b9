// SPDX-License-Identifier: MIT
#include "record/bud_reader.hpp"

#include <algorithm>

#include "record/bud_camera.hpp"
#include "record/bud_contents.hpp"
#include "record/bud_lidar.hpp"
#include "record/bud_rows.hpp"
#include "record/gravity_test.hpp"
#include "record/row_source.hpp"

namespace atlas::record {
namespace {
namespace fs = std::filesystem;

/// A file that is read for its count only.
class UnusedRows : public EventSource {
 public:
  UnusedRows(fs::path path, std::string name, std::string reason, std::shared_ptr<RecordLog> log)
      : path_(std::move(path)), name_(std::move(name)), reason_(std::move(reason)), log_(std::move(log)) {}
  std::optional<Stamp> firstStamp() override { return std::nullopt; }
  std::optional<Stamp> lastStamp() override { return std::nullopt; }
  void limit(const TimeSpan&) override {
    LineReader lines(path_);
    std::uint64_t rows = 0;
    while (const auto line = lines.next()) rows += isBlank(line->text) ? 0 : 1;
    log_->file(name_).rows = rows;
    log_->skip(name_, reason_, "", rows);
  }
  std::optional<Event> next() override { return std::nullopt; }

 private:
  fs::path path_;
  std::string name_, reason_;
  std::shared_ptr<RecordLog> log_;
};

class Assembly {
 public:
  Assembly(const fs::path& record, const RecordOptions& options)
      : record_(record), options_(options), streams_(options.topics) {
    parts_.log = std::make_shared<RecordLog>();
  }

  RecordParts build() {
    const RigFiles rig = readCalibration();
    parts_.static_transforms = rig.transforms;
    addImu();
    addGnss();
    for (const char* lidar : kBudLidars) addBudLidar(record_, lidar, options_, streams_, parts_);
    addRows("radar_ti/scans.txt", {{"radar_ti/scan", StreamKind::kRadar}}, 0, [](const Streams& s) {
      return [s](RowFields& fields, std::vector<Event>& events) {
        RadarScan scan = parseRadar(fields, {});
        scan.frame = "radar_ti";
        const Stamp stamp = scan.stamp;
        if (s[0]) events.push_back({stamp, *s[0], std::move(scan)});
        return stamp;
      };
    });
    for (const char* camera : kBudCameras) addBudCamera(record_, camera, rig, options_, streams_, parts_);
    noteUnknown();
    parts_.streams = streams_.streams();
    return std::move(parts_);
  }

 private:
  using Streams = std::vector<std::optional<std::size_t>>;

  RigFiles readCalibration() {
    const fs::path of_record = calibrationIn(record_ / "calibrations");
    const fs::path given =
        options_.calibration_dir.empty() ? fs::path() : calibrationIn(options_.calibration_dir);
    if (of_record.empty() && given.empty() && !options_.calibration_dir.empty())
      throw std::invalid_argument("calibration_dir: no *.yaml in '" + options_.calibration_dir + "'");
    const fs::path packaged =
        options_.packaged_rig_dir.empty() ? fs::path() : calibrationIn(options_.packaged_rig_dir);
    const fs::path folder = !of_record.empty() ? of_record : !given.empty() ? given : packaged;
    if (folder.empty()) {
      parts_.log->note("calibration: none found, tf_static has the imu only and there is no camera_info");
      RigFiles none;
      none.transforms.transforms.push_back({"base_link", "imu", Pose{}});
      return none;
    }
    RigFiles rig = readRigFiles(folder);
    parts_.log->note(!of_record.empty() ? "calibration: of the record"
                     : !given.empty()   ? "calibration: of calibration_dir"
                                        : "calibration: packaged rig");
    for (const std::string& note : rig.notes) parts_.log->note(note);
    noteMissingFrames(record_, rig.transforms, *parts_.log);
    return rig;
  }

  /// A file of rows with its streams; `parser` is asked for once it is known which streams are wanted.
  template <class MakeParser>
  void addRows(const std::string& name, const std::vector<std::pair<std::string, StreamKind>>& topics,
               Duration latency, MakeParser make_parser, std::function<void()> at_end = {}) {
    const fs::path path = record_ / name;
    std::error_code error;
    if (!fs::exists(path, error)) return;
    const std::uint64_t rows = countRows(path);
    Streams wanted;
    bool any = false;
    for (const auto& [topic, kind] : topics) {
      wanted.push_back(streams_.add(topic, kind, rows));
      any = any || wanted.back();
    }
    if (!any) return;
    RowFile file{path, name, latency, make_parser(wanted), std::move(at_end)};
    parts_.sources.push_back(std::make_unique<RowSource>(std::move(file), parts_.log));
  }

  /// A file whose rows are one event each: parse(fields) gives a struct with a stamp.
  template <class Parse>
  void addSamples(const std::string& name, const std::string& topic, StreamKind kind, Duration latency,
                  Parse parse) {
    addRows(name, {{topic, kind}}, latency, [parse](const Streams& s) {
      return [parse, s](RowFields& fields, std::vector<Event>& events) {
        auto sample = parse(fields);
        const Stamp stamp = sample.stamp;
        if (s[0]) events.push_back({stamp, *s[0], std::move(sample)});
        return stamp;
      };
    });
  }

  void addImu() {
    BudRowOptions rows{fromSeconds(options_.imu_latency_s), false};
    const Duration latency = rows.latency;
    std::error_code error;
    if (fs::exists(record_ / "imu/imu.txt", error)) {
      const GravityVerdict verdict = testGravity(record_ / "imu/imu.txt");
      parts_.log->note(describe(verdict));
      rows.invert_acceleration = verdict.sign == GravityVerdict::Sign::kInverted;
    }
    auto without_orientation = std::make_shared<std::uint64_t>(0);
    addRows(
        "imu/imu.txt", {{"imu/data", StreamKind::kImu}}, latency,
        [rows, without_orientation](const Streams& s) {
          return [rows, without_orientation, s](RowFields& fields, std::vector<Event>& events) {
            const ImuSample sample = parseImu(fields, rows);
            if (fields.ok() && !sample.orientation) ++*without_orientation;
            if (s[0]) events.push_back({sample.stamp, *s[0], sample});
            return sample.stamp;
          };
        },
        [without_orientation, log = parts_.log] {
          if (*without_orientation == 0) return;
          log->note("imu/imu.txt: " + std::to_string(*without_orientation) +
                    " rows whose quaternion is no rotation, delivered without orientation");
        });
    addSamples("imu/mag.txt", "imu/mag", StreamKind::kMagnetic, latency,
               [rows](RowFields& f) { return parseMagnetic(f, rows); });
    addSamples("imu/pressure.txt", "imu/pressure", StreamKind::kPressure, latency,
               [rows](RowFields& f) { return parseScalar(f, rows, "pressure"); });
    addSamples("imu/temp.txt", "imu/temperature", StreamKind::kTemperature, latency,
               [rows](RowFields& f) { return parseScalar(f, rows, "temperature"); });
    addTimes("imu", rows);
    addSamples("imu/gnss.txt", "imu/gnss/fix", StreamKind::kGnssFix, latency,
               [rows](RowFields& f) { return parseFix(f, rows, 4); });
    if (options_.topics.empty() && fs::exists(record_ / "imu/d_quat.txt", error)) {
      parts_.sources.push_back(std::make_unique<UnusedRows>(record_ / "imu/d_quat.txt", "imu/d_quat.txt",
                                                            "not converted: imu/data carries the orientation",
                                                            parts_.log));
    }
  }

  void addGnss() {
    const BudRowOptions rows{fromSeconds(options_.gnss_latency_s), false};
    auto without_heading = std::make_shared<std::uint64_t>(0);
    addRows(
        "gnss/pose.txt", {{"gnss/fix", StreamKind::kGnssFix}, {"gnss/heading", StreamKind::kGnssHeading}},
        rows.latency,
        [rows, without_heading](const Streams& s) {
          return [rows, without_heading, s](RowFields& fields, std::vector<Event>& events) {
            const GnssFix fix = parseFix(fields, rows, 5);
            const auto heading = parseHeading(fields, rows);
            if (fields.ok() && !heading) ++*without_heading;
            if (s[0]) events.push_back({fix.stamp, *s[0], fix});
            if (s[1] && heading) events.push_back({fix.stamp, *s[1], *heading});
            return fix.stamp;
          };
        },
        [without_heading, log = parts_.log] {
          if (*without_heading == 0) return;
          log->note("gnss/pose.txt: " + std::to_string(*without_heading) +
                    " rows with azimuth 0: no heading (their position is used)");
        });
    addTimes("gnss", rows);
  }

  /// <sensor>/time.txt; how long after the sensor's own time its rows are stamped goes to the notes.
  void addTimes(const std::string& sensor, const BudRowOptions& rows) {
    auto delays = std::make_shared<std::vector<Duration>>();
    addRows(
        sensor + "/time.txt", {{sensor + "/time", StreamKind::kTimeReference}}, rows.latency,
        [sensor, rows, delays](const Streams& s) {
          return [sensor, rows, delays, s](RowFields& fields, std::vector<Event>& events) {
            const TimeReference time = parseTime(fields, rows, sensor);
            constexpr std::size_t kLookedAt = 4096;
            if (fields.ok() && delays->size() < kLookedAt) {
              delays->push_back(time.stamp + rows.latency - time.sensor_time);
            }
            if (s[0]) events.push_back({time.stamp, *s[0], time});
            return time.stamp;
          };
        },
        [sensor, delays, log = parts_.log] {
          if (delays->empty()) return;
          const auto middle = delays->begin() + static_cast<std::ptrdiff_t>(delays->size() / 2);
          std::nth_element(delays->begin(), middle, delays->end());
          char text[120];
          std::snprintf(text, sizeof(text),
                        "/time.txt: system stamp minus the sensor's UTC %.3f ms (median of %zu)",
                        toSeconds(*middle) * 1e3, delays->size());
          log->note(sensor + text);
        });
  }

  /// What lies in the record and is not read, and what was asked for and is not there.
  void noteUnknown() {
    if (options_.topics.empty()) {
      noteMissingFiles(record_, *parts_.log);
      noteUnreadFiles(record_, *parts_.log);
    }
    std::error_code error;
    for (const char* camera : kBudCameras) {
      const std::string name = "yolo/" + std::string(camera) + ".txt";
      if (!options_.topics.empty() || !fs::exists(record_ / name, error)) continue;
      if (fs::exists(record_ / camera / "timestamps.txt", error)) continue;
      parts_.sources.push_back(
          std::make_unique<UnusedRows>(record_ / name, name, "the camera has no timestamps.txt", parts_.log));
    }
    for (const std::string& topic : streams_.unknown()) {
      parts_.log->note("topic '" + topic + "' was asked for, the record has none of this name");
    }
  }

  fs::path record_;
  RecordOptions options_;
  StreamSet streams_;
  RecordParts parts_;
};
}  // namespace

bool isBudRecord(const fs::path& folder) {
  std::error_code error;
  for (const char* file : {"imu/imu.txt", "gnss/pose.txt", "radar_ti/scans.txt"}) {
    if (fs::exists(folder / file, error)) return true;
  }
  const auto has_stamps = [&](const char* sensor) {
    return fs::exists(folder / sensor / "timestamps.txt", error);
  };
  return std::any_of(std::begin(kBudLidars), std::end(kBudLidars), has_stamps) ||
         std::any_of(std::begin(kBudCameras), std::end(kBudCameras), has_stamps);
}

std::unique_ptr<RecordReader> openBudRecord(const fs::path& folder, const RecordOptions& options) {
  return std::make_unique<MergedReader>(Assembly(folder, options).build(), options);
}

}  // namespace atlas::record
