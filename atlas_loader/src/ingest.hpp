// SPDX-License-Identifier: MIT
// Brings messages that arrive on topics in any order (rosbag play, other nodes) into the order of their
// stamps, for the graph. A stream that is silent for `max_delay_s` of event time is not waited for; what
// comes later than that is counted as late.
//
// A bag that loops begins a new epoch. Every stream gets there by itself, as the last messages of one may
// come after the first ones of another: what is of the next epoch is held back until all streams are there,
// or for `max_delay_s` of its event time.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "atlas/base/event_merge.hpp"
#include "atlas/sensor/record_reader.hpp"

namespace atlas_loader {

class Ingest {
 public:
  struct Item {
    enum class Kind { kEvent, kEndOfEpoch, kEndOfRun } kind = Kind::kEvent;
    std::optional<atlas::Event> event;
  };

  Ingest(std::vector<atlas::StreamInfo> streams, atlas::Duration max_delay);

  /// A message of `stream`. A stamp more than a second before the newest of its stream is of the next epoch.
  void push(std::size_t stream, atlas::Stamp stamp, atlas::Payload payload);
  /// Every publisher has gone: nothing more will come.
  void finish();
  /// Blocks for the next item; nullopt when `stop` was called.
  std::optional<Item> pop();
  void stop();

  [[nodiscard]] std::uint64_t late() const;
  [[nodiscard]] std::uint64_t received() const { return received_; }

 private:
  /// What the merge needs of a stream.
  struct Stream {
    atlas::Stamp newest = atlas::kBeginOfTime;  ///< in the epoch that it is in
    bool ahead = false;                         ///< is in the next epoch
    bool behind = false;                        ///< not seen since the last epoch ended
  };
  struct Held {
    std::size_t stream;
    atlas::Stamp stamp;
    atlas::Payload payload;
  };
  void startEpoch();
  void endEpoch();
  void nextEpoch();
  [[nodiscard]] bool isOfNextEpoch(const Stream& stream, atlas::Stamp stamp) const;
  void hold(std::size_t stream, atlas::Stamp stamp, atlas::Payload payload);
  void take(std::size_t stream, atlas::Stamp stamp, atlas::Payload payload);
  void advanceSilent();
  void pushToMerge(std::size_t stream, atlas::Stamp order, atlas::Stamp stamp, atlas::Payload payload);
  [[nodiscard]] bool isKnown(const atlas::Payload& static_transforms) const;
  void put(Item item);

  std::vector<atlas::StreamInfo> streams_;
  atlas::Duration max_delay_;
  std::unique_ptr<atlas::EventMerge> merge_;
  std::vector<std::pair<std::size_t, atlas::Event>>
      transforms_;  ///< static ones by stream; given again to each epoch
  std::vector<Stream> state_;
  atlas::Stamp newest_ = atlas::kBeginOfTime, oldest_ = atlas::kBeginOfTime;  ///< of this epoch
  std::vector<Held> held_;                                                    ///< of the next epoch
  atlas::Stamp newest_held_ = atlas::kBeginOfTime;
  std::uint64_t late_before_ = 0, received_ = 0;

  mutable std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  std::deque<Item> ready_;
  bool stopped_ = false;
};

/// Kind of a topic of the graph by its name, e.g. "lidar_left/points"; nullopt for names that no sensor has.
std::optional<atlas::StreamKind> kindOfTopicName(const std::string& topic);

}  // namespace atlas_loader
