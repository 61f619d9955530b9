// SPDX-License-Identifier: MIT
// Moving objects along the ego's route. Each is proposed at random near the place where the ego will be at
// some time, and kept only if its whole path stays clear of the ego, of the others and of parked cars:
// nothing ever drives through anything.
#include <algorithm>
#include <cmath>

#include "synthetic/ground.hpp"
#include "synthetic/random.hpp"
#include "synthetic/scene.hpp"

namespace atlas::synthetic {
namespace {

constexpr double kLife = 25.0;  // s before and after the meeting: far away at both ends

Eigen::Vector2d at(const Object& object, double t_s) {
  const double along = object.speed * (t_s - object.time_s);
  return {object.x + along * std::cos(object.yaw), object.y + along * std::sin(object.yaw)};
}

/// Distance of b's centre to a's body as a capsule of a's length: cheap and safe for both sides.
bool tooNear(const Eigen::Vector2d& a, double yaw_a, const Eigen::Vector3d& size_a, const Eigen::Vector2d& b,
             double yaw_b, const Eigen::Vector3d& size_b) {
  if ((a - b).norm() > 0.5 * (size_a.x() + size_b.x()) + 2.0) return false;
  const auto discs = [](const Eigen::Vector2d& p, double yaw, const Eigen::Vector3d& size) {
    std::vector<Eigen::Vector2d> centres;
    const double reach = std::max(0.0, 0.5 * (size.x() - size.y()));
    const int n = std::max(1, static_cast<int>(std::ceil(2.0 * reach / 0.8)) + 1);
    for (int i = 0; i < n; ++i) {
      const double along = n == 1 ? 0.0 : -reach + 2.0 * reach * i / (n - 1);
      centres.emplace_back(p + along * Eigen::Vector2d(std::cos(yaw), std::sin(yaw)));
    }
    return centres;
  };
  for (const auto& p : discs(a, yaw_a, size_a)) {
    for (const auto& q : discs(b, yaw_b, size_b)) {
      if ((p - q).norm() < 0.5 * (size_a.y() + size_b.y()) + 0.45) return true;
    }
  }
  return false;
}

bool clear(const Object& candidate, const EgoMotion& ego, const std::vector<Object>& others) {
  const Eigen::Vector3d ego_size(4.6, 1.85, 1.5);
  const Eigen::Vector2d start(candidate.x, candidate.y),
      across(-std::sin(candidate.yaw), std::cos(candidate.yaw));
  std::vector<const Object*> near;  // parked cars far from the line of the candidate can be forgotten
  for (const Object& other : others) {
    const bool still = other.motion == Object::Motion::kStill;
    if (!still || std::fabs(across.dot(Eigen::Vector2d(other.x, other.y) - start)) < 10.0)
      near.push_back(&other);
  }
  for (double t = candidate.from_s; t <= candidate.to_s; t += 0.1) {
    const Eigen::Vector2d p = at(candidate, t);
    const auto path = ego.path(ego.arcLength(t));
    if (tooNear({path.x, path.y}, path.yaw, ego_size, p, candidate.yaw, candidate.size)) return false;
    const auto lead = ego.path(ego.arcLength(t + 1.2) + 10.0);
    if (tooNear({lead.x, lead.y}, lead.yaw, ego_size, p, candidate.yaw, candidate.size)) return false;
    for (const Object* other : near) {
      if (!Scene::exists(*other, t)) continue;
      const bool still = other->motion == Object::Motion::kStill;
      if (still && (std::fabs(other->x - p.x()) > 20.0 || std::fabs(other->y - p.y()) > 20.0)) continue;
      if (tooNear(p, candidate.yaw, candidate.size, at(*other, t), other->yaw, other->size)) return false;
    }
  }
  return true;
}

/// A proposal: body, and where it is relative to the ego's path point at time t (offset to the left of the
/// street axis).
void place(Object& object, const EgoMotion& ego, double t_s, double ahead_m, double left_of_axis_m,
           bool oncoming, double speed) {
  const auto point = ego.path(ego.arcLength(t_s) + ahead_m);
  const double yaw = std::round(point.yaw / (M_PI / 2.0)) * (M_PI / 2.0);
  const bool along_x = std::fabs(std::cos(yaw)) > 0.5;
  const double axis_x = along_x ? point.x : kBlockPitch * std::round(point.x / kBlockPitch);
  const double axis_y = along_x ? kBlockPitch * std::round(point.y / kBlockPitch) : point.y;
  object.motion = Object::Motion::kLine;
  object.x = axis_x - left_of_axis_m * std::sin(yaw);
  object.y = axis_y + left_of_axis_m * std::cos(yaw);
  object.yaw = wrapAngle(yaw + (oncoming ? M_PI : 0.0));
  object.speed = speed;
  object.time_s = t_s;
  object.from_s = t_s - kLife;
  object.to_s = t_s + kLife;
}

/// Cars on the streets that the route crosses or turns into, at a crossing near the path point.
void placeCrossing(Object& object, const EgoMotion& ego, double t_s, Random& random) {
  const auto point = ego.path(ego.arcLength(t_s) + 30.0);
  const double yaw = wrapAngle((random.chance(0.5) ? 0.0 : M_PI / 2.0) + (random.chance(0.5) ? M_PI : 0.0));
  const double side = -2.0;
  object.motion = Object::Motion::kLine;
  object.x = kBlockPitch * std::round(point.x / kBlockPitch) - side * std::sin(yaw);
  object.y = kBlockPitch * std::round(point.y / kBlockPitch) + side * std::cos(yaw);
  object.yaw = yaw;
  object.speed = random.uniform(7.0, 12.0);
  object.time_s = t_s + random.uniform(-6.0, 6.0);
  object.from_s = object.time_s - kLife;
  object.to_s = object.time_s + kLife;
}

Object propose(int id, const EgoMotion& ego, double t_s, Random& random) {
  const double kind = random.uniform();
  const auto variant = static_cast<std::uint32_t>(random.integer(1 << 12));
  Object object;
  if (kind < 0.26) {
    object = makeCar(id, variant);
    place(object, ego, t_s, random.uniform(0.0, 25.0), 2.2, true, random.uniform(6.0, 12.0));
  } else if (kind < 0.46) {
    object = makeCar(id, variant);
    placeCrossing(object, ego, t_s, random);
  } else if (kind < 0.52) {
    object = makeBus(id);
    place(object, ego, t_s, random.uniform(0.0, 30.0), 2.2, true, random.uniform(6.0, 9.0));
  } else if (kind < 0.60) {
    object = makeCyclist(id);
    place(object, ego, t_s, random.uniform(8.0, 30.0), -4.2, false, random.uniform(3.5, 5.5));
  } else if (kind < 0.90) {
    object = makePerson(id, variant);
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    place(object, ego, t_s, random.uniform(4.0, 45.0), side * (kHalfCarriageway + random.uniform(1.6, 3.0)),
          random.chance(0.5), random.chance(0.2) ? 0.0 : random.uniform(0.9, 1.7));
  } else {  // crosses the street on foot
    object = makePerson(id, variant);
    place(object, ego, t_s, random.uniform(12.0, 40.0), 0.0, false, random.uniform(1.0, 1.6));
    object.yaw = wrapAngle(object.yaw + (random.chance(0.5) ? 0.5 : -0.5) * M_PI);
    object.from_s = object.time_s - 8.5 / object.speed;
    object.to_s = object.time_s + 8.5 / object.speed;
  }
  return object;
}

}  // namespace

void buildTraffic(std::uint64_t seed, const EgoMotion& ego, double duration_s, std::vector<Object>& objects) {
  Random random(seed, "traffic");
  std::vector<Object> all;
  for (const Object& parked : objects) all.push_back(parked);
  std::vector<Object> moving;
  int id = 1;
  Object lead = makeCar(id++, 2);
  lead.motion = Object::Motion::kRoute;
  lead.lead_s = 1.2;
  lead.lead_m = 10.0;
  moving.push_back(lead);
  const int proposals = static_cast<int>(std::ceil((duration_s + 10.0) * 2.2));
  for (int i = 0; i < proposals; ++i) {
    Object object = propose(id, ego, random.uniform(0.0, duration_s + 10.0), random);
    if (!clear(object, ego, all)) continue;
    all.push_back(object);
    moving.push_back(object);
    ++id;
  }
  objects.insert(objects.begin(), moving.begin(), moving.end());
}

}  // namespace atlas::synthetic
