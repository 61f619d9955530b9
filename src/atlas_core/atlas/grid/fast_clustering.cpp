// SPDX-License-Identifier: MIT
#include "atlas/grid/fast_clustering.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "atlas/grid/share_out.hpp"

namespace atlas {
namespace {

constexpr double kCoreMargin_m = 0.25;  ///< around a predicted box: a cell and its noise
constexpr double kShareOfCluster = 0.25, kShareOfTrack = 0.5;  ///< see claims()
constexpr double kDrives_mps = 3.0;    ///< slower things are not told from people beside them by growth
constexpr double kStranger_sq = 2.25;  ///< m^2/s^2: clusters that differ by more are not parts of one object
constexpr double kAlike_sq = 9.0;      ///< Mahalanobis distance of velocities that may be the same

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("grid objects: " + what + ", got " + std::to_string(value));
}

struct ClusterMean {
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  double variance = 0;
};

ClusterMean meanOf(const Cluster& cluster) {
  ClusterMean mean;
  for (const ClusterCell& cell : cluster) {
    mean.velocity += cell.velocity;
    mean.variance += cell.variance;
  }
  const auto count = static_cast<double>(cluster.size());
  mean.velocity /= count;
  mean.variance /= count;
  return mean;
}

std::size_t cellsIn(const Cluster& cluster, const GroundBox& box) {
  return static_cast<std::size_t>(std::count_if(
      cluster.begin(), cluster.end(), [&](const ClusterCell& cell) { return contains(box, cell.position); }));
}

}  // namespace

void validate(const ClusterTrackParams& p) {
  need(p.occupied > 0.5 && p.occupied < 1.0, "occupied must lie in (0.5, 1)", p.occupied);
  need(p.velocity_gate_mps > 0.0, "velocity_gate_mps must be positive", p.velocity_gate_mps);
  need(p.min_cells >= 1, "min_cells must be at least 1", p.min_cells);
  need(p.max_length_m > 0.0, "max_length_m must be positive", p.max_length_m);
  need(p.region_margin_m >= 0.0, "region_margin_m must not be negative", p.region_margin_m);
  for (const auto& [name, value] : {std::pair<const char*, double>{"ambiguous_same", p.ambiguous_same},
                                    {"ambiguous_different", p.ambiguous_different},
                                    {"initial_same", p.initial_same},
                                    {"merge_above", p.merge_above}})
    need(value > 0.0 && value < 1.0, std::string(name) + " must lie in (0, 1)", value);
  need(p.ambiguous_same > p.ambiguous_different, "ambiguous_same must exceed ambiguous_different",
       p.ambiguous_same);
  need(p.acceleration_mps2 > 0.0, "acceleration_mps2 must be positive", p.acceleration_mps2);
  need(p.confirm_hits >= 1 && p.confirm_hits <= p.confirm_of && p.confirm_of <= 16,
       "confirm_hits must lie in [1, confirm_of], confirm_of at most 16", p.confirm_hits);
  need(p.lost_visible_s > 0.0, "lost_visible_s must be positive", p.lost_visible_s);
  need(p.lost_hidden_s >= p.lost_visible_s, "lost_hidden_s must not be below lost_visible_s",
       p.lost_hidden_s);
  need(p.static_speed_mps >= 0.0, "static_speed_mps must not be negative", p.static_speed_mps);
}

ClusterTracker::ClusterTracker(const ClusterTrackParams& params) : params_(params) { validate(params); }

void ClusterTracker::reset() {
  tracks_.clear();
  same_.clear();
  cluster_of_cell_.clear();
}

bool ClusterTracker::alike(const Cluster& cluster, const ClusterTrack& track) const {
  const ClusterMean mean = meanOf(cluster);
  const double difference_sq = (mean.velocity - track.velocity()).squaredNorm();
  const double variance = mean.variance + std::max(track.covariance()(2, 2), track.covariance()(3, 3));
  return difference_sq <=
         std::max(params_.velocity_gate_mps * params_.velocity_gate_mps, kAlike_sq * variance);
}

/// Tracks that claim each cluster: those whose predicted box holds a good part of it or most of the cells
/// that they had. A track that has no such cluster claims the one that fills most of its region.
std::vector<std::vector<std::size_t>> ClusterTracker::claims(const std::vector<Cluster>& clusters) const {
  std::vector<std::vector<std::size_t>> claimed(clusters.size());
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const ClusterTrack& track = tracks_[t];
    GroundBox core = track.box();
    core.length += 2.0 * kCoreMargin_m;
    core.width += 2.0 * kCoreMargin_m;
    const GroundBox region = track.region(params_.region_margin_m);
    bool any = false;
    std::size_t fallback = clusters.size(), most = 0;
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      const std::size_t in_region = cellsIn(clusters[c], region);
      if (in_region == 0 || !alike(clusters[c], track)) continue;
      const auto in_core = static_cast<double>(cellsIn(clusters[c], core));
      if (in_core >= kShareOfCluster * static_cast<double>(clusters[c].size()) ||
          in_core >= kShareOfTrack * static_cast<double>(track.cells())) {
        claimed[c].push_back(t);
        any = true;
      } else if (in_region > most) {
        most = in_region;
        fallback = c;
      }
    }
    if (!any && fallback < clusters.size()) claimed[fallback].push_back(t);
  }
  leaveStrangers(clusters, claimed);
  addGrowth(clusters, claimed);
  return claimed;
}

/// Of the clusters that one track alone claims, those that move otherwise than the largest are none of its.
void ClusterTracker::leaveStrangers(const std::vector<Cluster>& clusters,
                                    std::vector<std::vector<std::size_t>>& claimed) const {
  std::vector<std::size_t> largest(tracks_.size(), clusters.size());
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (claimed[c].size() != 1) continue;
    std::size_t& best = largest[claimed[c].front()];
    if (best == clusters.size() || clusters[c].size() > clusters[best].size()) best = c;
  }
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (claimed[c].size() != 1 || largest[claimed[c].front()] == c) continue;
    const ClusterMean a = meanOf(clusters[c]), b = meanOf(clusters[largest[claimed[c].front()]]);
    const double difference_sq = (a.velocity - b.velocity).squaredNorm();
    if (difference_sq > std::max(kStranger_sq, a.variance + b.variance)) claimed[c].clear();
  }
}

/// More of a thing that drives comes into view where it was not seen before: beside its box, moving with it.
void ClusterTracker::addGrowth(const std::vector<Cluster>& clusters,
                               std::vector<std::vector<std::size_t>>& claimed) const {
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    if (!claimed[c].empty()) continue;
    const ClusterMean mean = meanOf(clusters[c]);
    for (std::size_t t = 0; t < tracks_.size() && claimed[c].empty(); ++t) {
      const Eigen::Vector2d v = tracks_[t].velocity();
      if (v.norm() < kDrives_mps || (v - mean.velocity).squaredNorm() > std::max(kStranger_sq, mean.variance))
        continue;
      const auto inside =
          static_cast<double>(cellsIn(clusters[c], tracks_[t].region(params_.region_margin_m)));
      if (inside >= 0.5 * static_cast<double>(clusters[c].size())) claimed[c].push_back(t);
    }
  }
}

/// Each track gets the cells nearest to it; of a wall only those in its own region.
void ClusterTracker::shareAmong(const Cluster& cluster, const std::vector<std::size_t>& claimants, bool wall,
                                std::vector<Cluster>& observed) const {
  std::vector<Eigen::Vector4d> seeds;
  for (const std::size_t t : claimants) seeds.push_back(tracks_[t].state());
  const std::vector<std::size_t> owner = shareOut(cluster, seeds);
  for (std::size_t i = 0; i < cluster.size(); ++i) {
    const std::size_t t = claimants[owner[i]];
    if (!wall || contains(tracks_[t].region(params_.region_margin_m), cluster[i].position))
      observed[t].push_back(cluster[i]);
  }
}

void ClusterTracker::update(const GridView& view, Counters& counters) {
  stamp_ = view.stamp;
  road_m_ = view.road_m;
  for (ClusterTrack& track : tracks_) track.predict(view.stamp, params_.acceleration_mps2);
  CellClusters found = clusterCells({view.geometry, view.cells, view.evidence, view.top_m}, params_.occupied,
                                    params_.velocity_gate_mps);
  std::vector<Cluster> observed(tracks_.size());
  std::vector<const Cluster*> unclaimed;
  std::vector<Pair> ambiguous;
  const auto claimed = claims(found.clusters);
  for (std::size_t c = 0; c < found.clusters.size(); ++c) {
    const Cluster& cluster = found.clusters[c];
    const bool wall = principalBox(cluster, view.geometry.cell_m).length > params_.max_length_m;
    if (claimed[c].empty() && !wall) unclaimed.push_back(&cluster);
    if (claimed[c].empty()) continue;
    shareAmong(cluster, claimed[c], wall, observed);
    for (std::size_t i = 0; i < claimed[c].size() && !wall; ++i) {
      for (std::size_t j = i + 1; j < claimed[c].size(); ++j)
        ambiguous.emplace_back(claimed[c][i], claimed[c][j]);
    }
  }
  addPartsOfWholes(view, ambiguous);
  believe(ambiguous, observed);
  merge(observed, counters);
  correct(view, observed);
  cluster_of_cell_ = std::move(found.cluster_of_cell);
  for (std::size_t t = 0; t < observed.size(); ++t) {
    for (const ClusterCell& cell : observed[t])
      cluster_of_cell_[cell.index] = -static_cast<std::int32_t>(tracks_[t].id());
  }
  begin(unclaimed, view);
  end(view, counters);
}

Objects ClusterTracker::report() const {
  Objects objects;
  objects.stamp = stamp_;
  for (const ClusterTrack& track : tracks_) {
    if (track.confirmed()) objects.objects.push_back(track.report(road_m_, params_.static_speed_mps));
  }
  return objects;
}

}  // namespace atlas
