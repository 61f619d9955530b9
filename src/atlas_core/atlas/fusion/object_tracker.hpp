// SPDX-License-Identifier: MIT
// Objects aggregator (paper III-E): scans of any sensors become objects with an identity. Each scan is
// assigned to the tracks by one optimal assignment; what is left begins tracks; a track lives by the
// probability that it exists, which a scan lowers only as far as it would have shown the object.
// Everything is in map: the vehicle's own motion is in the measurements' poses.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "atlas/base/counters.hpp"
#include "atlas/fusion/track.hpp"

namespace atlas {

struct TrackerParams {
  ClassParams classes;
  double confirm_existence = 0.85;     ///< probability from which an object is told of ...
  double tell_existence = 0.5;         ///< ... and below which it is not, until it is seen again
  double drop_existence = 0.05;        ///< below this a track ends
  double drop_position_sigma_m = 8.0;  ///< nobody knows where a track is that is less certain
  double static_probability = 0.5;     ///< from which an object is static
  double gate_sigmas = 4.0;            ///< of a measurement that may belong to a track
  double robust_sigmas = 2.5;          ///< measurements farther off weigh less; 0 = all weigh the same
  int history = 50;                    ///< past states kept of an object
  int max_tracks = 1000;               ///< further ones are counted, not begun
};
void validate(const TrackerParams& params);

/// One look of one sensor.
struct Scan {
  Stamp stamp = 0;
  std::string input;  ///< topic
  std::vector<MeasurementPtr> measurements;
  /// Probability that this scan shows an object that is there; empty: it cannot be told, nothing is missed.
  std::function<double(const TrackShape&)> detectability;
};

/// Cost of giving a measurement to a track, in halves of a squared sigma (a negative log likelihood): a plug
/// point. `nothing` when it must not be.
using AssociationCost =
    std::function<std::optional<double>(const TrackShape&, const Measurement&, double gate_sigmas)>;
/// Distance of the anchor rows, their uncertainty and the mismatch.
[[nodiscard]] std::optional<double> anchorCost(const TrackShape& track, const Measurement& measurement,
                                               double gate_sigmas);

class ObjectTracker {
 public:
  explicit ObjectTracker(const TrackerParams& params, AssociationCost cost = anchorCost,
                         MotionModels models = motionModels());

  /// Scans must come in order of time; one before the last is counted and left out.
  void update(const Scan& scan, Counters& counters);
  /// Every confirmed object at `stamp`, by id; what they were seen with since the last call.
  [[nodiscard]] Objects report(Stamp stamp);
  /// Tracks that may still become objects too, whatever their existence.
  [[nodiscard]] Objects reportAll(Stamp stamp);
  [[nodiscard]] const std::vector<Track>& tracks() const { return tracks_; }
  [[nodiscard]] const ClassModel& classes() const { return *classes_; }

 private:
  using Order = std::vector<const Measurement*>;
  [[nodiscard]] static Order usableInOrder(const Scan& scan, Counters& counters);
  [[nodiscard]] std::vector<int> associate(const std::vector<TrackShape>& shapes, const Order& order) const;
  /// The track that a measurement without one may belong to; tracks_.size() when none.
  [[nodiscard]] std::size_t absorber(const std::vector<TrackShape>& shapes,
                                     const Measurement& measurement) const;
  void begin(const Scan& scan, const Measurement& measurement, Counters& counters);
  void end(Counters& counters);
  void removeDoubles(Counters& counters);
  void predict(Stamp stamp);
  Objects reportFrom(Stamp stamp, bool confirmed_only);

  TrackerParams params_;
  AssociationCost cost_;
  std::shared_ptr<const MotionModels> models_;
  std::shared_ptr<const ClassModel> classes_;
  std::vector<Track> tracks_;  ///< by id
  std::uint32_t next_id_ = 1;
  Stamp stamp_ = kBeginOfTime;
};

}  // namespace atlas
