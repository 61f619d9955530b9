// SPDX-License-Identifier: MIT
#include "synthetic/scene.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "synthetic/ground.hpp"

namespace atlas::synthetic {
namespace {

constexpr double kSeen = 200.0;  // m around the route in which blocks exist

std::set<std::pair<int, int>> blocksAlong(const EgoMotion& ego, double duration_s) {
  std::set<std::pair<int, int>> blocks;
  const double end = ego.arcLength(duration_s + 5.0);
  for (double s = 0.0; s <= end + 20.0; s += 20.0) {
    const auto p = ego.path(s);
    const auto first = [](double u) { return static_cast<int>(std::floor((u - kSeen) / kBlockPitch)); };
    const auto last = [](double u) { return static_cast<int>(std::floor((u + kSeen) / kBlockPitch)); };
    for (int y = first(p.y); y <= last(p.y); ++y) {
      for (int x = first(p.x); x <= last(p.x); ++x) blocks.emplace(y, x);
    }
  }
  return blocks;
}

}  // namespace

Scene::Scene(std::uint64_t seed, const EgoMotion& ego, double duration_s) : ego_(ego) {
  for (const auto& [y, x] : blocksAlong(ego, duration_s)) buildBlock(seed, x, y, statics_, objects_);
  buildTraffic(seed, ego, duration_s, objects_);
  std::sort(objects_.begin(), objects_.end(), [](const Object& a, const Object& b) { return a.id < b.id; });
  for (const Object& object : objects_) {
    if (object.motion != Object::Motion::kStill) continue;
    const ObjectState state = stateAt(object, 0.0);
    for (const Primitive& part : object.parts) statics_.push_back(placed(part, state));
  }
}

ObjectState Scene::stateAt(const Object& object, double t_s) const {
  ObjectState state;
  if (object.motion == Object::Motion::kRoute) {
    const auto point = ego_.path(ego_.arcLength(t_s + object.lead_s) + object.lead_m);
    const double speed = ego_.speed(t_s + object.lead_s);
    state = {
        point.x, point.y, 0.0, point.yaw, {speed * std::cos(point.yaw), speed * std::sin(point.yaw), 0.0}};
  } else {
    const double c = std::cos(object.yaw), s = std::sin(object.yaw);
    const double along = object.motion == Object::Motion::kStill ? 0.0 : object.speed * (t_s - object.time_s);
    state = {object.x + along * c,
             object.y + along * s,
             0.0,
             object.yaw,
             {object.speed * c, object.speed * s, 0.0}};
  }
  const GroundPoint ground = roadSurface(state.x, state.y);
  // Ramp instead of a step at the kerb, so that walkers do not jump.
  const double beyond =
      std::min(std::fabs(acrossStreet(state.x)), std::fabs(acrossStreet(state.y))) - kHalfCarriageway;
  state.z = ground.height + kKerbHeight * std::clamp(beyond / 0.3 + 0.5, 0.0, 1.0);
  state.velocity.z() = ground.slope_x * state.velocity.x() + ground.slope_y * state.velocity.y();
  return state;
}

const Object* Scene::find(int id) const {
  const auto it = std::lower_bound(objects_.begin(), objects_.end(), id,
                                   [](const Object& o, int value) { return o.id < value; });
  return it != objects_.end() && it->id == id ? &*it : nullptr;
}

Scene::Snapshot Scene::snapshot(const Eigen::Vector3d& p_city, double radius_m, double t_s) const {
  Snapshot result;
  const auto near = [&](const Primitive& primitive) {
    const double reach = radius_m + std::hypot(primitive.half.x(), primitive.half.y());
    return (primitive.centre - p_city).head<2>().squaredNorm() < reach * reach;
  };
  for (const Primitive& primitive : statics_) {
    if (!near(primitive)) continue;
    result.primitives.push_back(primitive);
    result.velocity.emplace_back(Eigen::Vector3d::Zero());
  }
  for (const Object& object : objects_) {
    if (object.motion == Object::Motion::kStill || !exists(object, t_s)) continue;
    const ObjectState state = stateAt(object, t_s);
    if ((Eigen::Vector2d(state.x, state.y) - p_city.head<2>()).norm() > radius_m + 0.5 * object.size.x())
      continue;
    for (const Primitive& part : object.parts) {
      result.primitives.push_back(placed(part, state));
      result.velocity.push_back(state.velocity);
    }
  }
  return result;
}

}  // namespace atlas::synthetic
