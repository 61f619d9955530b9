// SPDX-License-Identifier: MIT
#include "atlas/camera/frustum_motion.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "atlas/camera/box_overlap.hpp"

namespace atlas {
namespace {

using Partners = std::vector<std::optional<std::size_t>>;

[[noreturn]] void reject(const std::string& field, const std::string& need, double value) {
  throw std::invalid_argument("frustum motion: " + field + " must be " + need + ", got " +
                              std::to_string(value));
}

/// Index in `others` of the nearest frustum of the same class, up to `reach_m` away; of equal ones the first.
std::optional<std::size_t> nearestTo(const Frustum& object, const Frustums& others, double reach_m) {
  std::optional<std::size_t> nearest;
  double smallest = reach_m;
  for (std::size_t i = 0; i < others.frustums.size(); ++i) {
    const Frustum& other = others.frustums[i];
    const double distance = (other.position - object.position).norm();
    if (other.detection.class_id != object.detection.class_id || distance > smallest) continue;
    if (nearest && distance == smallest) continue;
    nearest = i;
    smallest = distance;
  }
  return nearest;
}

/// For every frustum of `a` the one of `b` that is the same object: each is the other's nearest.
Partners partners(const Frustums* a, const Frustums* b, const FrustumMotionParams& params) {
  if (a == nullptr) return {};
  Partners result(a->frustums.size());
  if (b == nullptr) return result;
  const double reach_m =
      params.place_noise_m + params.largest_speed_mps * std::abs(toSeconds(b->stamp - a->stamp));
  for (std::size_t i = 0; i < result.size(); ++i) {
    const auto there = nearestTo(a->frustums[i], *b, reach_m);
    if (there && nearestTo(b->frustums[*there], *a, reach_m) == i) result[i] = there;
  }
  return result;
}

/// Where an object was seen; without frustum when it was not.
struct Sighting {
  const Frustum* frustum = nullptr;
  Stamp stamp = 0;
};
Sighting sighting(const Frustums* image, const std::optional<std::size_t>& index) {
  if (!index) return {};
  return {&image->frustums[*index], image->stamp};
}

Eigen::Vector3d velocityOf(const Sighting& from, const Sighting& to) {
  return (to.frustum->position - from.frustum->position) / toSeconds(to.stamp - from.stamp);
}

/// From where the object was before to where it will be after; with one neighbour only, from or to there.
/// Zero when that way is within the noise of the places, or when its two halves contradict each other: a jump
/// of the distance looks like speed.
Eigen::Vector3d velocityIn(const Sighting& was, const Sighting& is, const Sighting& will_be,
                           const FrustumMotionParams& params) {
  const Eigen::Vector3d standing = Eigen::Vector3d::Zero();
  const Sighting& first = was.frustum != nullptr ? was : is;
  const Sighting& last = will_be.frustum != nullptr ? will_be : is;
  if ((last.frustum->position - first.frustum->position).norm() <= params.place_noise_m) return standing;
  if (first.stamp != is.stamp && last.stamp != is.stamp) {
    const Eigen::Vector3d change = velocityOf(is, last) - velocityOf(first, is);
    if (change.norm() * 0.5 * toSeconds(last.stamp - first.stamp) > params.place_noise_m) return standing;
  }
  const Eigen::Vector3d velocity = velocityOf(first, last);
  return velocity.norm() <= params.largest_speed_mps ? velocity : standing;
}

/// `share` of the way from one to the other.
Frustum between(const Frustum& a, const Frustum& b, double share, double confidence) {
  const auto mix = [share](const auto& from, const auto& to) -> std::decay_t<decltype(from)> {
    return (1.0 - share) * from + share * to;
  };
  Frustum result = a;
  result.detection.x_min = mix(a.detection.x_min, b.detection.x_min);
  result.detection.y_min = mix(a.detection.y_min, b.detection.y_min);
  result.detection.x_max = mix(a.detection.x_max, b.detection.x_max);
  result.detection.y_max = mix(a.detection.y_max, b.detection.y_max);
  result.detection.confidence = confidence * std::min(a.detection.confidence, b.detection.confidence);
  result.distance_m = mix(a.distance_m, b.distance_m);
  result.range_m = mix(a.range_m, b.range_m);
  result.depth_sigma_m = std::max(a.depth_sigma_m, b.depth_sigma_m);
  result.points = std::min(a.points, b.points);
  result.position = mix(a.position, b.position);
  for (std::size_t i = 0; i < result.corners.size(); ++i) result.corners[i] = mix(a.corners[i], b.corners[i]);
  return result;
}

bool isInImage(const Frustum& object, const Frustums& image, double most_overlap) {
  return std::any_of(image.frustums.begin(), image.frustums.end(), [&](const Frustum& other) {
    return other.detection.class_id == object.detection.class_id &&
           overlapOf(other.detection, object.detection) > most_overlap;
  });
}

bool holds(const Partners& partners, std::size_t index) {
  return std::find(partners.begin(), partners.end(), std::optional<std::size_t>(index)) != partners.end();
}

/// Objects of both neighbours that the image lacks.
std::vector<MovingFrustum> bridged(const Frustums& before, const Partners& of_before, const Frustums& image,
                                   const Frustums& after, const Partners& of_after,
                                   const FrustumMotionParams& params) {
  std::vector<MovingFrustum> result;
  const Partners across = partners(&before, &after, params);
  const double share = toSeconds(image.stamp - before.stamp) / toSeconds(after.stamp - before.stamp);
  for (std::size_t i = 0; i < across.size(); ++i) {
    if (!across[i] || holds(of_before, i) || holds(of_after, *across[i])) continue;
    const Frustum &was = before.frustums[i], &will_be = after.frustums[*across[i]];
    const Frustum now = between(was, will_be, share, params.bridged_confidence);
    if (isInImage(now, image, params.most_overlap)) continue;
    result.push_back({now, kBridged, velocityOf({&was, before.stamp}, {&will_be, after.stamp})});
  }
  return result;
}

}  // namespace

void validate(const FrustumMotionParams& params) {
  if (!(params.largest_speed_mps > 0.0)) reject("largest_speed_mps", "positive", params.largest_speed_mps);
  if (!(params.place_noise_m >= 0.0)) reject("place_noise_m", ">= 0", params.place_noise_m);
  if (!(params.most_overlap >= 0.0 && params.most_overlap <= 1.0))
    reject("most_overlap", "in 0..1", params.most_overlap);
  if (!(params.bridged_confidence >= 0.0 && params.bridged_confidence <= 1.0))
    reject("bridged_confidence", "in 0..1", params.bridged_confidence);
}

std::vector<MovingFrustum> followObjects(const Frustums* before, const Frustums& image, const Frustums* after,
                                         const FrustumMotionParams& params) {
  const Partners of_before = partners(&image, before, params), of_after = partners(&image, after, params);
  std::vector<MovingFrustum> result;
  for (std::size_t i = 0; i < image.frustums.size(); ++i) {
    const Sighting is{&image.frustums[i], image.stamp};
    const Eigen::Vector3d velocity =
        velocityIn(sighting(before, of_before[i]), is, sighting(after, of_after[i]), params);
    result.push_back({image.frustums[i], static_cast<std::uint32_t>(i), velocity});
  }
  if (before != nullptr && after != nullptr) {
    const auto missed = bridged(*before, of_before, image, *after, of_after, params);
    result.insert(result.end(), missed.begin(), missed.end());
  }
  return result;
}

Frustum moved(const MovingFrustum& object, double seconds) {
  const Eigen::Vector3d way = object.velocity_map_mps * seconds;
  Frustum result = object.frustum;
  result.position += way;
  for (Eigen::Vector3d& corner : result.corners) corner += way;
  return result;
}

}  // namespace atlas
