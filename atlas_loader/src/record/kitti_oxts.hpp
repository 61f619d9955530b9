// SPDX-License-Identifier: MIT
// OXTS of a KITTI raw drive: imu/data, gnss/fix and gnss/heading from one file a frame.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "record/event_source.hpp"
#include "record/kitti_frames.hpp"
#include "record/open_record.hpp"

namespace atlas::record {

class OxtsSource : public EventSource {
 public:
  struct Streams {
    std::optional<std::size_t> imu, fix, heading;
  };
  OxtsSource(const KittiStamps& stamps, KittiFrames files, Streams streams, const RecordOptions& options,
             std::shared_ptr<RecordLog> log);
  std::optional<Stamp> firstStamp() override;
  std::optional<Stamp> lastStamp() override;
  void limit(const TimeSpan& span) override;
  std::optional<Event> next() override;

 private:
  void read(Stamp stamp, std::uint32_t index);
  void add(const std::optional<std::size_t>& stream, Stamp stamp, Payload payload);

  KittiFrames files_;
  Streams streams_;
  std::shared_ptr<RecordLog> log_;
  Duration imu_latency_, gnss_latency_;
  std::vector<std::pair<Stamp, std::uint32_t>> order_;
  TimeSpan span_;
  std::multimap<std::pair<Stamp, std::size_t>, Event> ready_;
  std::size_t next_ = 0;
};

}  // namespace atlas::record
