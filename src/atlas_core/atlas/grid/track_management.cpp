// SPDX-License-Identifier: MIT
// Of the tracks of ClusterTracker: which of them are one thing, when one begins and ends.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "atlas/grid/fast_clustering.hpp"

namespace atlas {
namespace {

constexpr double kSame_sq = 9.49;  ///< chi-square, 4 degrees of freedom, 95 %
constexpr double kSharedSigma_mps = 0.8;
constexpr double kLeastBelief = 0.02, kMostBelief = 0.98;
constexpr double kTentativeLost_s = 0.3;
constexpr double kWholeGap_m = 6.0;      ///< between the parts of one long vehicle that are seen
constexpr double kWholeLength_m = 15.0;  ///< of such a vehicle
constexpr double kWholeWidth_m = 1.5;    ///< of its larger part, at least
constexpr double kWholeSpeed_mps = 1.5;  ///< parked vehicles in a row are not parts of one
constexpr double kSameVelocity_mps = 1.0;
constexpr float kSeenFree = 0.4F;  ///< evidence of a cell that is seen empty
constexpr double kMostFree = 0.1;  ///< share of the cells between two parts of one thing

/// Share of the cells of a box that are seen empty; nothing when none lies in the grid.
std::optional<double> freeShare(const GroundBox& box, const GridView& view) {
  const double reach = 0.5 * std::hypot(box.length, box.width);
  const GridGeometry& g = view.geometry;
  int all = 0, free = 0;
  for (int row = g.rowOf(box.center.y() - reach); row <= g.rowOf(box.center.y() + reach); ++row) {
    for (int column = g.columnOf(box.center.x() - reach); column <= g.columnOf(box.center.x() + reach);
         ++column) {
      if (!g.contains(column, row) || !contains(box, g.middleOf(column, row))) continue;
      ++all;
      free += view.evidence[g.indexOf(column, row)] < kSeenFree ? 1 : 0;
    }
  }
  if (all == 0) return std::nullopt;
  return static_cast<double>(free) / all;
}

/// The strip from the middle of one box to that of the other without what the boxes cover.
GroundBox between(const GroundBox& a, const GroundBox& b, double gap) {
  const Eigen::Vector2d d = (b.center - a.center).normalized();
  GroundBox strip;
  strip.center = 0.5 * (a.center + b.center);
  strip.yaw_rad = std::atan2(d.y(), d.x());
  strip.length = gap;
  strip.width = 0.4;
  return strip;
}

}  // namespace

/// Two parts of a long vehicle of which the middle is not seen: they move alike and nothing free lies
/// between.
void ClusterTracker::addPartsOfWholes(const GridView& view, std::vector<Pair>& ambiguous) const {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (tracks_[i].velocity().norm() < kWholeSpeed_mps) continue;
    for (std::size_t j = i + 1; j < tracks_.size(); ++j) {
      const Pair pair(i, j);
      if ((tracks_[i].velocity() - tracks_[j].velocity()).norm() > kSameVelocity_mps) continue;
      const GroundBox a = tracks_[i].box(), b = tracks_[j].box();
      const double gap = gapBetween(a, b),
                   length = (a.center - b.center).norm() + 0.5 * (a.length + b.length);
      if (gap > kWholeGap_m || length > kWholeLength_m) continue;
      if (std::max({a.width, b.width, a.length, b.length}) < kWholeWidth_m) continue;
      if (std::find(ambiguous.begin(), ambiguous.end(), pair) != ambiguous.end()) continue;
      const auto free = freeShare(between(a, b, gap), view);
      if (gap <= view.geometry.cell_m || (free && *free <= kMostFree)) ambiguous.push_back(pair);
    }
  }
}

void ClusterTracker::believe(const std::vector<Pair>& ambiguous, const std::vector<Cluster>& observed) {
  const double a = params_.ambiguous_same, b = params_.ambiguous_different;
  std::map<std::pair<std::uint32_t, std::uint32_t>, bool> claimed_both;
  for (const auto& [i, j] : ambiguous) claimed_both[{tracks_[i].id(), tracks_[j].id()}] = true;
  for (const auto& [ids, both] : claimed_both) {
    double& p = same_.emplace(ids, params_.initial_same).first->second;
    p = std::clamp(a * p / (a * p + b * (1.0 - p)), kLeastBelief, kMostBelief);
  }
  const auto is_observed = [&](std::uint32_t id) {
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      if (tracks_[t].id() == id) return !observed[t].empty();
    }
    return false;
  };
  for (auto& [ids, p] : same_) {
    if (claimed_both.count(ids) > 0 || !is_observed(ids.first) || !is_observed(ids.second)) continue;
    p = std::clamp((1.0 - a) * p / ((1.0 - a) * p + (1.0 - b) * (1.0 - p)), kLeastBelief, kMostBelief);
  }
}

/// Their states agree: velocities, and places up to what lies between their boxes. Where a cluster was shared
/// out is no edge of an object, so tracks that share one know their velocities less well than they think.
bool ClusterTracker::oneThing(const ClusterTrack& a, const ClusterTrack& b) const {
  Eigen::Vector4d d = a.state() - b.state();
  const double distance = d.head<2>().norm(), gap = gapBetween(a.box(), b.box());
  d.head<2>() *= distance > 1e-6 ? std::min(gap, params_.region_margin_m) / distance : 0.0;
  Eigen::Matrix4d P = a.covariance() + b.covariance();
  P.diagonal().tail<2>().array() += kSharedSigma_mps * kSharedSigma_mps;
  return d.dot(P.inverse() * d) < kSame_sq;
}

void ClusterTracker::merge(std::vector<Cluster>& observed, Counters& counters) {
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    for (std::size_t j = i + 1; j < tracks_.size();) {
      const auto believed = same_.find({tracks_[i].id(), tracks_[j].id()});
      if (believed == same_.end() || believed->second <= params_.merge_above ||
          !oneThing(tracks_[i], tracks_[j])) {
        ++j;
        continue;
      }
      tracks_[i].absorb(tracks_[j]);
      observed[i].insert(observed[i].end(), observed[j].begin(), observed[j].end());
      tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(j));
      observed.erase(observed.begin() + static_cast<std::ptrdiff_t>(j));
      counters.add("grid tracks merged");
    }
  }
}

void ClusterTracker::correct(const GridView& view, const std::vector<Cluster>& observed) {
  const auto seen_free = [&](const Eigen::Vector2d& place) {
    const int column = view.geometry.columnOf(place.x()), row = view.geometry.rowOf(place.y());
    return view.geometry.contains(column, row) &&
           view.evidence[view.geometry.indexOf(column, row)] < kSeenFree;
  };
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const bool seen = std::any_of(observed[t].begin(), observed[t].end(),
                                  [](const ClusterCell& cell) { return cell.seen; });
    if (seen) {
      tracks_[t].update(observed[t], view.seen_from_map, view.geometry.cell_m, seen_free);
    } else {
      tracks_[t].miss(freeShare(tracks_[t].box(), view).value_or(0.0));
    }
    tracks_[t].confirm(params_.confirm_hits, params_.confirm_of);
  }
}

void ClusterTracker::begin(const std::vector<const Cluster*>& unclaimed, const GridView& view) {
  for (const Cluster* cluster : unclaimed) {
    const auto seen =
        std::count_if(cluster->begin(), cluster->end(), [](const ClusterCell& c) { return c.seen; });
    if (seen < params_.min_cells) continue;
    tracks_.emplace_back(next_id_++, view.stamp, *cluster, view.seen_from_map, view.geometry.cell_m);
    tracks_.back().confirm(params_.confirm_hits, params_.confirm_of);
    for (const ClusterCell& cell : *cluster)
      cluster_of_cell_[cell.index] = -static_cast<std::int32_t>(tracks_.back().id());
  }
}

void ClusterTracker::end(const GridView& view, Counters& counters) {
  const auto is_over = [&](const ClusterTrack& track) {
    const Eigen::Vector2d at = track.box().center;
    const double unseen = track.unseenFor_s();
    if (!view.geometry.contains(view.geometry.columnOf(at.x()), view.geometry.rowOf(at.y()))) return true;
    if (!track.confirmed() && unseen > kTentativeLost_s) return true;
    return unseen > params_.lost_hidden_s || (unseen > params_.lost_visible_s && track.detectability() > 0.5);
  };
  const auto kept = std::stable_partition(tracks_.begin(), tracks_.end(),
                                          [&](const ClusterTrack& track) { return !is_over(track); });
  counters.add("grid tracks ended", static_cast<std::uint64_t>(tracks_.end() - kept));
  tracks_.erase(kept, tracks_.end());
  for (auto it = same_.begin(); it != same_.end();) {
    const auto lives = [&](std::uint32_t id) {
      return std::any_of(tracks_.begin(), tracks_.end(), [&](const ClusterTrack& t) { return t.id() == id; });
    };
    it = lives(it->first.first) && lives(it->first.second) ? std::next(it) : same_.erase(it);
  }
}

}  // namespace atlas
