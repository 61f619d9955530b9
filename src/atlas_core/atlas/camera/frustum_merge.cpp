// SPDX-License-Identifier: MIT
#include "atlas/camera/frustum_merge.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {
namespace {

struct Seen {
  std::size_t image;
  const Frustum* frustum;
};

/// Two cameras look at two sides of an object, so it is the volumes that touch, not the centres of its boxes.
double between(const Frustum& a, const Frustum& b) {
  const auto middle = [](const Frustum& f) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& corner : f.corners) sum += corner;
    return Eigen::Vector3d(sum / 8.0);
  };
  return std::min((a.position - b.position).norm(), (middle(a) - middle(b)).norm());
}

}  // namespace

Frustums mergeDuplicates(const std::vector<Frustums>& images, const FrustumMergeParams& params) {
  Frustums result;
  if (images.empty()) return result;
  result.stamp = images.front().stamp;
  result.image_index = images.front().image_index;
  std::vector<Seen> all;
  for (std::size_t i = 0; i < images.size(); ++i) {
    for (const Frustum& frustum : images[i].frustums) all.push_back({i, &frustum});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Seen& a, const Seen& b) { return a.frustum->points > b.frustum->points; });
  std::vector<Seen> kept;
  for (const Seen& seen : all) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Seen& other) {
      const double sigma = std::hypot(seen.frustum->depth_sigma_m, other.frustum->depth_sigma_m);
      return seen.image != other.image &&
             seen.frustum->detection.class_id == other.frustum->detection.class_id &&
             between(*seen.frustum, *other.frustum) <= params.largest_distance_m + params.sigmas * sigma;
    });
    if (!known) kept.push_back(seen);
  }
  for (const Seen& seen : kept) result.frustums.push_back(*seen.frustum);
  return result;
}

}  // namespace atlas
