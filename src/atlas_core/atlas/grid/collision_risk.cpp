// SPDX-License-Identifier: MIT
#include "atlas/grid/collision_risk.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace atlas {
namespace {

constexpr double kMinTotal = 0.01;  ///< below it there is no time to tell
/// Three-point Gauss-Hermite rule: exact to fifth order.
constexpr std::array<double, 3> kNodes = {-1.7320508075688772, 0.0, 1.7320508075688772};
constexpr std::array<double, 3> kWeights = {1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0};

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("collision risk: " + what + ", got " + std::to_string(value));
}

struct Rectangle {
  Eigen::Vector2d center;
  Eigen::Vector2d along;  ///< unit
  double half_length, half_width;
};

bool separatedAlong(const Eigen::Vector2d& axis, const Rectangle& a, const Rectangle& b) {
  const auto reach = [&](const Rectangle& r) {
    const double along = axis.dot(r.along), across = axis.x() * -r.along.y() + axis.y() * r.along.x();
    return std::abs(along) * r.half_length + std::abs(across) * r.half_width;
  };
  return std::abs(axis.dot(a.center - b.center)) > reach(a) + reach(b);
}

/// Separating axes.
bool overlap(const Rectangle& a, const Rectangle& b) {
  for (const Rectangle& r : {a, b}) {
    if (separatedAlong(r.along, a, b) || separatedAlong({-r.along.y(), r.along.x()}, a, b)) return false;
  }
  return true;
}

/// Where the vehicle is after t seconds of constant speed and rate of turn.
Rectangle egoAfter(const EgoMotion& ego, double t, const RiskParams& p) {
  const double turn = ego.yaw_rate_radps * t, yaw = ego.yaw_rad + turn;
  // chord of the arc: its direction is half of the turn, its length speed * t * sin(turn / 2) / (turn / 2)
  const double half = 0.5 * turn, chord = std::abs(half) > 1e-6 ? std::sin(half) / half : 1.0;
  const Eigen::Vector2d forward(std::cos(yaw), std::sin(yaw)),
      way(std::cos(ego.yaw_rad + half), std::sin(ego.yaw_rad + half));
  return {ego.position_map + ego.speed_mps * t * chord * way + 0.5 * (p.front_m - p.rear_m) * forward,
          forward, 0.5 * (p.front_m + p.rear_m), p.half_width_m};
}

/// P(first contact in each bin) with one object that moves: its state's uncertainty is one of the object, not
/// of each moment, so each of its possible courses has its own first contact.
std::vector<double> contactsWith(const Object& object, const std::vector<Rectangle>& ego,
                                 const RiskParams& p) {
  std::vector<double> contact(ego.size(), 0.0);
  const auto var = [&](std::size_t i) { return object.covariance[6 * i]; };
  const std::array<double, 4> sigma = {std::sqrt(var(0)), std::sqrt(var(1)), std::sqrt(var(2)),
                                       std::sqrt(var(3))};
  const Eigen::Vector2d along(std::cos(object.yaw_rad), std::sin(object.yaw_rad));
  for (int course = 0; course < 81; ++course) {
    std::array<double, 4> node{};
    double weight = 1.0;
    for (int i = 0, rest = course; i < 4; ++i, rest /= 3) {
      node[i] = kNodes[rest % 3];
      weight *= kWeights[rest % 3];
    }
    const Eigen::Vector2d at =
        object.position.head<2>() + Eigen::Vector2d(node[0] * sigma[0], node[1] * sigma[1]);
    for (std::size_t bin = 0; bin < ego.size(); ++bin) {
      const double t = static_cast<double>(bin) * p.bin_s;
      const auto drift = [&](int axis) {  // of its speed, and of what it may do against it
        return node[2 + axis] * std::hypot(sigma[2 + axis] * t, 0.5 * p.acceleration_mps2 * t * t);
      };
      const Eigen::Vector2d moved = object.velocity_mps.head<2>() * t + Eigen::Vector2d(drift(0), drift(1));
      const Rectangle there{at + moved, along, 0.5 * object.size.x(), 0.5 * object.size.y()};
      if (!overlap(there, ego[bin])) continue;
      contact[bin] += weight * object.existence;
      break;
    }
  }
  return contact;
}

/// What the grid itself says of the way.
struct CellsOnTheWay {
  std::vector<double> survival;  ///< P(no contact up to the end of each bin)
  std::map<std::int32_t, double>
      things;  ///< P(it is there) of what lies on the way, by number of its cluster
  double unknown_share = 0;
};

/// Calls visit(column, row) for the cells under a rectangle, those beyond the grid too.
template <class Visit>
void forCellsUnder(const Rectangle& r, const GridGeometry& g, Visit&& visit) {
  const double reach = std::hypot(r.half_length, r.half_width);
  for (int row = g.rowOf(r.center.y() - reach); row <= g.rowOf(r.center.y() + reach); ++row) {
    for (int column = g.columnOf(r.center.x() - reach); column <= g.columnOf(r.center.x() + reach);
         ++column) {
      const Eigen::Vector2d d = g.middleOf(column, row) - r.center;
      const double across = r.along.x() * d.y() - r.along.y() * d.x();
      if (std::abs(d.dot(r.along)) <= r.half_length && std::abs(across) <= r.half_width) visit(column, row);
    }
  }
}

CellsOnTheWay cellsOnTheWay(const std::vector<Rectangle>& ego, const Objects& objects,
                            const GridGeometry& geometry, const CellEstimates& cells,
                            const std::vector<std::int32_t>& cluster_of_cell, const RiskParams& p) {
  const auto moves = [&](std::size_t i) {
    return cluster_of_cell[i] < 0 &&
           std::any_of(objects.objects.begin(), objects.objects.end(), [&](const Object& o) {
             return !o.is_static && static_cast<std::int32_t>(o.id) == -cluster_of_cell[i];
           });
  };
  std::set<std::pair<int, int>> passed;
  forCellsUnder(ego.front(), geometry, [&](int column, int row) { passed.emplace(row, column); });
  const std::size_t own = passed.size();  // where the vehicle is now there is nothing else
  CellsOnTheWay result;
  std::map<std::int32_t, double>& most = result.things;  // its cells are hit together: the surest one counts
  std::size_t unknown = 0;
  for (const Rectangle& place : ego) {
    forCellsUnder(place, geometry, [&](int column, int row) {
      if (!passed.emplace(row, column).second) return;
      const bool inside = geometry.contains(column, row);
      const std::size_t i = inside ? geometry.indexOf(column, row) : 0;
      unknown += !inside || cells.unknown[i] > 0.5F ? 1 : 0;
      const double probability = inside ? cells.occupied[i] - 0.5 * cells.unknown[i] : 0.0;
      if (probability < p.min_cell_probability || moves(i)) return;
      double& thing = most[cluster_of_cell[i]];
      thing = std::max(thing, probability);
    });
    double survival = 1.0;
    for (const auto& [number, probability] : most) survival *= 1.0 - probability;
    result.survival.push_back(survival);
  }
  if (passed.size() > own)
    result.unknown_share = static_cast<double>(unknown) / static_cast<double>(passed.size() - own);
  return result;
}

}  // namespace

void validate(const RiskParams& p) {
  need(p.horizon_s > 0.0 && p.horizon_s <= 60.0, "horizon_s must lie in (0, 60]", p.horizon_s);
  need(p.bin_s > 0.0 && p.bin_s <= p.horizon_s, "bin_s must lie in (0, horizon_s]", p.bin_s);
  need(p.front_m > 0.0, "front_m must be positive", p.front_m);
  need(p.rear_m > 0.0, "rear_m must be positive", p.rear_m);
  need(p.half_width_m > 0.0, "half_width_m must be positive", p.half_width_m);
  need(p.acceleration_mps2 >= 0.0, "acceleration_mps2 must not be negative", p.acceleration_mps2);
  need(p.min_cell_probability > 0.0 && p.min_cell_probability < 1.0,
       "min_cell_probability must lie in (0, 1)", p.min_cell_probability);
}

CollisionRisk collisionRisk(const EgoMotion& ego, const Objects& objects, const GridGeometry& geometry,
                            const CellEstimates& cells, const std::vector<std::int32_t>& cluster_of_cell,
                            const RiskParams& params) {
  CollisionRisk risk;
  risk.stamp = objects.stamp;
  risk.bin_s = params.bin_s;
  const auto bins = static_cast<std::size_t>(std::lround(params.horizon_s / params.bin_s));
  std::vector<Rectangle> places;
  for (std::size_t bin = 0; bin < bins; ++bin)
    places.push_back(egoAfter(ego, static_cast<double>(bin) * params.bin_s, params));
  CellsOnTheWay way = cellsOnTheWay(places, objects, geometry, cells, cluster_of_cell, params);
  risk.unknown_share = way.unknown_share;
  double likeliest = 0.0;
  for (const auto& [number, probability] : way.things) {
    if (number >= 0 || probability <= likeliest) continue;
    likeliest = probability;
    risk.object = static_cast<std::uint32_t>(-number);
  }
  for (const Object& object : objects.objects) {
    if (object.is_static)
      continue;  // its cells were counted: the box of a wall round a corner covers the road
    const std::vector<double> contact = contactsWith(object, places, params);
    double hit = 0.0;
    for (std::size_t bin = 0; bin < bins; ++bin) {
      hit += contact[bin];
      way.survival[bin] *= 1.0 - std::min(1.0, hit);
    }
    if (hit <= likeliest) continue;
    likeliest = hit;
    risk.object = object.id;
  }
  double before = 1.0, time = 0.0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    risk.first_contact.push_back(before - way.survival[bin]);
    time += risk.first_contact.back() * (static_cast<double>(bin) + 0.5) * params.bin_s;
    before = way.survival[bin];
  }
  risk.total = 1.0 - before;
  if (risk.total >= kMinTotal) risk.expected_time_s = time / risk.total;
  return risk;
}

}  // namespace atlas
