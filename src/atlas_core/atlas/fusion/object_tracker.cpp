// SPDX-License-Identifier: MIT
#include "atlas/fusion/object_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "atlas/fusion/assignment.hpp"
#include "atlas/fusion/neighbour_grid.hpp"

namespace atlas {
namespace {

constexpr double kCell_m = 5.0;
constexpr double kFarthest_m = 15.0;                  ///< a measurement is not looked for farther away
constexpr double kReach_m = 2.0;                      ///< around a track's own size and uncertainty
constexpr std::size_t kCandidates = 32;               ///< nearest measurements that a track looks at
constexpr double kLargest_m = 14.0, kWidest_m = 4.0;  ///< walls hold nothing
constexpr double kTellSpeedSigma_mps = 1.2;           ///< nobody is told of an object that may move anyhow
constexpr double kMargin_m = 0.4;                     ///< around a box: what begins there belongs to it

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("objects: " + what + ", got " + std::to_string(value));
}

double reachOf(const TrackShape& shape) {
  const double sigma =
      std::sqrt(std::max(shape.state.covariance(kPx, kPx), shape.state.covariance(kPy, kPy)));
  return std::min(kFarthest_m, 4.0 * sigma + 0.5 * std::hypot(shape.length(), shape.width()) + kReach_m);
}

bool holds(const TrackShape& box, const Eigen::Vector2d& p, double margin_m) {
  if (box.length() > kLargest_m || box.width() > kWidest_m) return false;
  const Eigen::Vector2d d = p - box.position();
  return std::abs(d.dot(box.along())) <= 0.5 * box.length() + margin_m &&
         std::abs(d.dot(box.across())) <= 0.5 * box.width() + margin_m;
}

bool sameHeight(const TrackShape& a, double z, double height) {
  return std::abs(a.middle_z_m.value - z) <= 0.5 * (a.height_m.value + height) + 1.0;
}

}  // namespace

void validate(const TrackerParams& p) {
  validate(p.classes);
  const auto probability = [](const char* name, double value) {
    need(value > 0.0 && value < 1.0, std::string(name) + " must lie in (0, 1)", value);
  };
  probability("confirm_existence", p.confirm_existence);
  probability("tell_existence", p.tell_existence);
  probability("drop_existence", p.drop_existence);
  probability("static_probability", p.static_probability);
  need(p.drop_existence < p.tell_existence, "drop_existence must be below tell_existence", p.drop_existence);
  need(p.tell_existence <= p.confirm_existence, "tell_existence must not exceed confirm_existence",
       p.tell_existence);
  need(p.drop_position_sigma_m > 0.0, "drop_position_sigma_m must be positive", p.drop_position_sigma_m);
  need(p.gate_sigmas > 0.0, "gate_sigmas must be positive", p.gate_sigmas);
  need(p.robust_sigmas >= 0.0, "robust_sigmas must not be negative", p.robust_sigmas);
  need(p.history >= 0 && p.history <= 10000, "history must lie in [0, 10000]", p.history);
  need(p.max_tracks >= 1 && p.max_tracks <= 10000, "max_tracks must lie in [1, 10000]", p.max_tracks);
}

std::optional<double> anchorCost(const TrackShape& track, const Measurement& measurement,
                                 double gate_sigmas) {
  const RowDistance distance = distanceOf(track.state, measurement.anchor(track));
  const double gate = gate_sigmas * gate_sigmas;
  if (!(distance.mahalanobis_sq < gate)) return std::nullopt;
  const double mismatch = measurement.mismatch(track);
  if (!(2.0 * mismatch < gate)) return std::nullopt;
  return 0.5 * (distance.mahalanobis_sq + distance.log_determinant) + mismatch;
}

ObjectTracker::ObjectTracker(const TrackerParams& params, AssociationCost cost, MotionModels models)
    : params_(params),
      cost_(std::move(cost)),
      models_(std::make_shared<const MotionModels>(std::move(models))) {
  validate(params);
  classes_ = std::make_shared<const ClassModel>(params.classes);
  for (std::size_t i = 0; i <= classes_->classes(); ++i)
    validate(classes_->physics(i).motion, models_->size());
}

ObjectTracker::Order ObjectTracker::usableInOrder(const Scan& scan, Counters& counters) {
  struct Keyed {
    std::array<double, 8> key;
    const Measurement* measurement;
  };
  std::vector<Keyed> keyed;
  keyed.reserve(scan.measurements.size());
  for (const MeasurementPtr& measurement : scan.measurements) {
    if (const auto defect = measurement->defect()) {
      counters.skip(scan.input, *defect);
    } else {
      keyed.push_back({measurement->key(), measurement.get()});
    }
  }
  std::stable_sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
  Order order;
  for (const Keyed& entry : keyed) order.push_back(entry.measurement);
  return order;
}

std::vector<int> ObjectTracker::associate(const std::vector<TrackShape>& shapes, const Order& order) const {
  std::vector<Eigen::Vector2d> places;
  places.reserve(order.size());
  for (const Measurement* measurement : order) places.emplace_back(measurement->place().head<2>());
  const NeighbourGrid grid(places, kCell_m);
  std::vector<std::vector<AssignmentEdge>> edges(shapes.size());
  for (std::size_t t = 0; t < shapes.size(); ++t) {
    for (const std::uint32_t m : grid.nearest(shapes[t].position(), reachOf(shapes[t]), kCandidates)) {
      if (const auto cost = cost_(shapes[t], *order[m], params_.gate_sigmas)) edges[t].push_back({m, *cost});
    }
  }
  return assign(edges, order.size(), 0.5 * params_.gate_sigmas * params_.gate_sigmas);
}

void ObjectTracker::predict(Stamp stamp) {
  for (Track& track : tracks_) track.predict(stamp);
}

void ObjectTracker::update(const Scan& scan, Counters& counters) {
  if (scan.stamp < stamp_) {
    counters.skip(scan.input, Reason::kOutOfOrder);
    return;
  }
  stamp_ = scan.stamp;
  const Order order = usableInOrder(scan, counters);
  predict(scan.stamp);
  std::vector<TrackShape> shapes;
  shapes.reserve(tracks_.size());
  for (const Track& track : tracks_) shapes.push_back(track.shape());
  const std::vector<int> column_of = associate(shapes, order);
  std::vector<char> taken(order.size(), 0);
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const double detectability = scan.detectability ? scan.detectability(shapes[t]) : 0.0;
    if (scan.detectability) tracks_[t].setDetectability(detectability);
    if (column_of[t] == kUnassigned) {
      tracks_[t].miss(detectability);
      continue;
    }
    const Measurement& measurement = *order[static_cast<std::size_t>(column_of[t])];
    taken[static_cast<std::size_t>(column_of[t])] = 1;
    tracks_[t].witness(measurement, scan.input);
    tracks_[t].update(measurement, params_.robust_sigmas);
  }
  for (std::size_t t = 0; t < tracks_.size(); ++t) shapes[t] = tracks_[t].shape();
  for (std::size_t m = 0; m < order.size(); ++m) {
    if (taken[m] != 0) continue;
    const std::size_t owner = absorber(shapes, *order[m]);
    if (owner == shapes.size()) {
      begin(scan, *order[m], counters);
      continue;
    }
    counters.add("further measurements of an object");
    tracks_[owner].witness(*order[m], scan.input);
    if (scan.detectability && column_of[owner] == kUnassigned) tracks_[owner].contradict(*order[m]);
  }
  end(counters);
}

std::size_t ObjectTracker::absorber(const std::vector<TrackShape>& shapes,
                                    const Measurement& measurement) const {
  const Eigen::Vector3d place = measurement.place();
  std::size_t best = shapes.size();
  double least = 0.0;
  for (std::size_t t = 0; t < shapes.size(); ++t) {
    if (!tracks_[t].confirmed() || !holds(shapes[t], place.head<2>(), kMargin_m) ||
        !sameHeight(shapes[t], place.z(), 0.0))
      continue;
    const double distance = (shapes[t].position() - place.head<2>()).squaredNorm();
    if (best == shapes.size() || distance < least) {
      best = t;
      least = distance;
    }
  }
  return best;
}

void ObjectTracker::begin(const Scan& scan, const Measurement& measurement, Counters& counters) {
  const std::optional<TrackBirth> birth = measurement.birth();
  if (!birth) {
    counters.add("measurements that begin nothing");
    return;
  }
  if (tracks_.size() >= static_cast<std::size_t>(params_.max_tracks)) {
    counters.add("tracks not begun: max_tracks");
    return;
  }
  tracks_.emplace_back(next_id_++, scan.stamp, *birth, models_, classes_);
  counters.add("tracks begun");
  tracks_.back().witness(measurement, scan.input);
}

void ObjectTracker::end(Counters& counters) {
  for (Track& track : tracks_) track.confirmFrom(params_.confirm_existence);
  const std::size_t before = tracks_.size();
  tracks_.erase(std::remove_if(tracks_.begin(), tracks_.end(),
                               [&](const Track& track) {
                                 return track.existence() < params_.drop_existence || !track.finite() ||
                                        track.positionSigma() > params_.drop_position_sigma_m;
                               }),
                tracks_.end());
  counters.add("tracks ended", before - tracks_.size());
  removeDoubles(counters);
}

void ObjectTracker::removeDoubles(Counters& counters) {
  std::vector<TrackShape> shapes;
  std::vector<Eigen::Vector2d> places;
  for (const Track& track : tracks_) {
    shapes.push_back(track.shape());
    places.push_back(shapes.back().position());
  }
  const NeighbourGrid grid(places, kCell_m);
  std::vector<char> doubled(tracks_.size(), 0);
  for (std::size_t a = 0; a < tracks_.size(); ++a) {  // the older one stays
    if (doubled[a] != 0) continue;
    const double reach = 0.5 * std::hypot(shapes[a].length(), shapes[a].width());
    for (const std::uint32_t b : grid.nearest(places[a], std::min(reach, kFarthest_m), kCandidates)) {
      if (b <= a || doubled[b] != 0 || tracks_[b].confirmed() > tracks_[a].confirmed()) continue;
      if (!sameHeight(shapes[a], shapes[b].middle_z_m.value, shapes[b].height_m.value - 2.0)) continue;
      if (holds(shapes[a], places[b], 0.0) || holds(shapes[b], places[a], 0.0)) doubled[b] = 1;
    }
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (doubled[i] != 0) continue;
    if (kept != i) tracks_[kept] = std::move(tracks_[i]);
    ++kept;
  }
  counters.add("tracks that were doubles", tracks_.size() - kept);
  tracks_.erase(tracks_.begin() + static_cast<std::ptrdiff_t>(kept), tracks_.end());
}

Objects ObjectTracker::report(Stamp stamp) { return reportFrom(stamp, true); }
Objects ObjectTracker::reportAll(Stamp stamp) { return reportFrom(stamp, false); }

Objects ObjectTracker::reportFrom(Stamp stamp, bool confirmed_only) {
  if (stamp > stamp_) {
    stamp_ = stamp;
    predict(stamp);
  }
  Objects result;
  result.stamp = stamp;
  for (Track& track : tracks_) {
    const bool known = track.confirmed() && track.existence() >= params_.tell_existence &&
                       (track.told() || track.velocitySigma() <= kTellSpeedSigma_mps);
    track.remember(static_cast<std::size_t>(params_.history));
    if (confirmed_only && !known) continue;
    result.objects.push_back(track.report(params_.static_probability));
  }
  return result;
}

}  // namespace atlas
