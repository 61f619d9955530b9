// SPDX-License-Identifier: MIT
// Objects of the occupancy grid with an identity: the Fast Clustering and Tracking algorithm (Mekhnacha, Mao,
// Raulo, Laugier 2008; Paromtchik, Perrollaz, Laugier 2011, III). Each track predicts where its cells are
// looked for; occupied cells that touch and move alike are a cluster; a cluster that several tracks claim is
// shared out among them (K-means, their number is known), and the belief that these tracks are one thing
// rises:
//   P(S | F) ~ P(F | S) P(S)
// until they are merged; it falls while each has a cluster of its own.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "atlas/base/counters.hpp"
#include "atlas/grid/cell_clusters.hpp"
#include "atlas/grid/cluster_track.hpp"
#include "atlas/sensor/object.hpp"

namespace atlas {

struct ClusterTrackParams {
  double occupied = 0.6;             ///< cells with at least this probability belong to objects
  double velocity_gate_mps = 2.5;    ///< neighbouring cells whose velocities differ by more are two things
  int min_cells = 2;                 ///< of a new object
  double max_length_m = 20.0;        ///< longer standing things are walls: no objects
  double region_margin_m = 0.4;      ///< around the predicted box, beside its uncertainty
  double ambiguous_same = 0.9;       ///< P(F | S): one thing's two tracks claim the same cluster
  double ambiguous_different = 0.2;  ///< P(F | not S)
  double initial_same = 0.1;         ///< P(S) of two tracks that meet
  double merge_above = 0.9;          ///< P(S) that merges, if their states agree as well
  double acceleration_mps2 = 4.0;    ///< standard deviation of what objects do against constant velocity
  int confirm_hits = 3, confirm_of = 5;  ///< a track is told of after so many observations of so many
  double lost_visible_s = 1.0;           ///< a track whose place is seen empty ends after
  double lost_hidden_s = 3.0;            ///< a track whose place is hidden ends after
  double static_speed_mps = 0.7;         ///< a slower object is not moving
};
void validate(const ClusterTrackParams& params);

/// What the tracker looks at.
struct GridView {
  Stamp stamp = 0;
  const GridGeometry& geometry;
  const CellEstimates& cells;
  const std::vector<float>& evidence;  ///< P(occupied | Z) of this time: what is visible
  const std::vector<float>& top_m;     ///< highest return above the road, NaN where there is none
  Eigen::Vector2d seen_from_map;
  double road_m = 0;  ///< z of the road in map under the vehicle
};

class ClusterTracker {
 public:
  explicit ClusterTracker(const ClusterTrackParams& params);

  void update(const GridView& view, Counters& counters);
  void reset();
  /// Confirmed tracks by id, as of the last update.
  [[nodiscard]] Objects report() const;
  /// Number of the cluster of each cell in the last update, 0 = none; those of tracks are negative, -id.
  [[nodiscard]] const std::vector<std::int32_t>& clusterOfCell() const { return cluster_of_cell_; }

 private:
  using Pair = std::pair<std::size_t, std::size_t>;  ///< of tracks, the older one first
  [[nodiscard]] bool alike(const Cluster& cluster, const ClusterTrack& track) const;
  [[nodiscard]] std::vector<std::vector<std::size_t>> claims(const std::vector<Cluster>& clusters) const;
  void leaveStrangers(const std::vector<Cluster>& clusters,
                      std::vector<std::vector<std::size_t>>& claimed) const;
  void addGrowth(const std::vector<Cluster>& clusters, std::vector<std::vector<std::size_t>>& claimed) const;
  void shareAmong(const Cluster& cluster, const std::vector<std::size_t>& claimants, bool wall,
                  std::vector<Cluster>& observed) const;
  void addPartsOfWholes(const GridView& view, std::vector<Pair>& ambiguous) const;
  void believe(const std::vector<Pair>& ambiguous, const std::vector<Cluster>& observed);
  [[nodiscard]] bool oneThing(const ClusterTrack& a, const ClusterTrack& b) const;
  void merge(std::vector<Cluster>& observed, Counters& counters);
  void correct(const GridView& view, const std::vector<Cluster>& observed);
  void begin(const std::vector<const Cluster*>& unclaimed, const GridView& view);
  void end(const GridView& view, Counters& counters);

  ClusterTrackParams params_;
  std::vector<ClusterTrack> tracks_;                                ///< by id
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> same_;  ///< P(S) by ids, the smaller first
  std::uint32_t next_id_ = 1;
  Stamp stamp_ = 0;
  double road_m_ = 0;
  std::vector<std::int32_t> cluster_of_cell_;
};

}  // namespace atlas
