// SPDX-License-Identifier: MIT
// The one interface of everything that can be replayed: BUD record, KITTI raw drive, bag. Events come in
// stamp order and one by one, so memory does not depend on the length of the record.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// What a topic carries; decides the ROS message type.
enum class StreamKind {
  kStaticTransforms,
  kImu,
  kMagnetic,
  kPressure,
  kTemperature,
  kTimeReference,
  kGnssFix,
  kGnssHeading,
  kPoints,
  kCameraInfo,
  kVideoPackets,
  kCompressedImage,
  kImage,
  kDetections,
  kTemperatureRange,
  kRadar
};

struct StreamInfo {
  std::string topic;  ///< without leading slash, e.g. "lidar_left/points"
  StreamKind kind = StreamKind::kImu;
  std::uint64_t expected = 0;  ///< number of events if known beforehand, else 0 (for the progress bar)
};

struct Event {
  Stamp stamp = 0;
  std::size_t stream = 0;  ///< index into streams()
  Payload payload;
};

/// What was read of one file, so that every row is accounted for: rows == used + sum(skipped).
struct FileReport {
  std::uint64_t rows = 0, used = 0;
  std::map<std::string, std::uint64_t> skipped;  ///< reason -> rows
  std::vector<std::string>
      examples;  ///< first few skipped rows: "imu/imu.txt:17: field 3 (ay): not a number: 'abc'"
};

class RecordReader {
 public:
  virtual ~RecordReader() = default;
  /// Streams in their fixed order; the index breaks ties of equal stamps. Stream 0 is tf_static.
  [[nodiscard]] virtual const std::vector<StreamInfo>& streams() const = 0;
  /// The next event in (stamp, stream) order; nullopt at the end. tf_static comes first, with the first
  /// event's stamp.
  virtual std::optional<Event> next() = 0;
  /// Per file; complete after next() has returned nullopt.
  [[nodiscard]] virtual std::map<std::string, FileReport> report() const = 0;
  /// Notes for the user: "acceleration sign inverted, corrected", "video has 12 frames, timestamps 14 rows",
  /// ...
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;
  /// First and last stamp of the record if known, else both 0.
  [[nodiscard]] virtual std::pair<Stamp, Stamp> span() const = 0;
};

}  // namespace atlas
