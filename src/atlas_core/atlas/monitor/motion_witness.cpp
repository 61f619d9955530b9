// SPDX-License-Identifier: MIT
#include "atlas/monitor/motion_witness.hpp"

namespace atlas {
namespace {
constexpr Duration kSpan = kSecond, kLeastSpan = kSecond / 2, kFresh = kSecond;
constexpr double kStanding_mps = 0.15, kMoving_mps = 0.5;
}  // namespace

void MotionWitness::add(Stamp stamp, const Eigen::Vector3d& p_map) {
  places_.push_back({stamp, p_map.head<2>()});
  while (places_.size() > 2 && places_[1].stamp <= stamp - kSpan) places_.pop_front();
}

std::optional<double> MotionWitness::speed(Stamp stamp) const {
  if (places_.size() < 2) return std::nullopt;
  const Place &first = places_.front(), &last = places_.back();
  if (stamp - last.stamp > kFresh || last.stamp - first.stamp < kLeastSpan) return std::nullopt;
  return (last.p_map - first.p_map).norm() / toSeconds(last.stamp - first.stamp);
}

bool MotionWitness::standing(Stamp stamp) const {
  const auto known = speed(stamp);
  return known && *known < kStanding_mps;
}

bool MotionWitness::moving(Stamp stamp) const {
  const auto known = speed(stamp);
  return known && *known > kMoving_mps;
}

}  // namespace atlas
