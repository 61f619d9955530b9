// SPDX-License-Identifier: MIT
// The rigid motion that brings one point set nearest to another with known correspondence.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "atlas/base/geometry.hpp"

namespace atlas::synthetic {

/// A point as it is and where it should be, m.
using PointPair = std::pair<Eigen::Vector3f, Eigen::Vector3f>;

/// T with T * first = second in the least squares (Kabsch 1976; Umeyama 1991, eq. 34-43, with scale 1). Pairs
/// whose residual exceeds three robust standard deviations are left out and the fit repeated, twice. Nothing
/// when there are fewer than three pairs or they do not fix a rotation.
std::optional<Pose> rigidFit(const std::vector<PointPair>& pairs);

}  // namespace atlas::synthetic
