// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <set>

#include "scenario_parts.hpp"

namespace atlas::grid_scene {
namespace {

/// Mean of what is added.
struct Mean {
  double sum = 0;
  std::size_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  [[nodiscard]] double value() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
  [[nodiscard]] double root() const { return std::sqrt(value()); }
};

/// The track of an actor; of several the oldest.
const Object* trackOf(const Step& step, std::size_t actor) {
  return step.of_actor[actor].empty() ? nullptr : step.of_actor[actor].front();
}

}  // namespace

/// A bicycle passes a slow car on the side that is seen: two objects, with their speeds.
std::vector<Figure> bicycleBesideCar(FilterMode mode, unsigned seed) {
  std::vector<Figure> figures;
  for (const double gap : {0.4, 0.8, 1.2}) {
    Scene scene;
    scene.actors.push_back({"car", 4.4, 1.8, 0.15, 1.5, drives(11.0, 3.5, 0.0, 1.5)});
    scene.actors.push_back({"bicycle", 1.8, 0.6, 0.0, 1.7, drives(6.0, 3.5 - 0.9 - gap - 0.3, 0.0, 5.0)});
    scene.duration_s = 3.5;
    Mean both, bicycle_error, car_error;
    for (const Step& step : drive(scene, options(mode, seed))) {
      if (step.t_s < 0.8) continue;
      const Object *car = trackOf(step, 0), *bicycle = trackOf(step, 1);
      both.add(car && bicycle ? 1.0 : 0.0);
      if (bicycle)
        bicycle_error.add((bicycle->velocity_mps.head<2>() - Eigen::Vector2d(5.0, 0.0)).squaredNorm());
      if (car) car_error.add((car->velocity_mps.head<2>() - Eigen::Vector2d(1.5, 0.0)).squaredNorm());
    }
    const std::string at = ", gap " + std::to_string(gap).substr(0, 3) + " m";
    figures.push_back(atLeast("bicycle and car apart" + at, 100.0 * both.value(), 95.0, "% of frames"));
    figures.push_back(atMost("velocity of the bicycle" + at, bicycle_error.root(), 0.7, "m/s RMSE"));
    figures.push_back(atMost("velocity of the car" + at, car_error.root(), 0.7, "m/s RMSE"));
  }
  return figures;
}

/// Two people walk side by side: from which gap on are they two, and do they stay so?
std::vector<Figure> twoPedestrians(FilterMode mode, unsigned seed) {
  std::vector<Figure> figures;
  for (const double gap : {0.2, 0.4, 0.6, 0.8, 1.0, 1.2}) {
    Scene scene;
    scene.actors.push_back({"left", 0.5, 0.5, 0.0, 1.75, drives(8.0, 0.25 + 0.5 * gap, 0.0, 1.4)});
    scene.actors.push_back({"right", 0.5, 0.5, 0.0, 1.7, drives(8.0, -0.25 - 0.5 * gap, 0.0, 1.4)});
    scene.duration_s = 4.0;
    Mean two;
    std::set<std::uint32_t> ids;
    for (const Step& step : drive(scene, options(mode, seed))) {
      if (step.t_s < 0.8) continue;
      two.add(!step.of_actor[0].empty() && !step.of_actor[1].empty() ? 1.0 : 0.0);
      for (const Object& object : step.frame->objects.objects) ids.insert(object.id);
    }
    const std::string at = ", gap " + std::to_string(gap).substr(0, 3) + " m";
    const double share = 100.0 * two.value();
    figures.push_back(gap > 0.6 ? atLeast("two people told apart" + at, share, 50.0, "% of frames")
                                : told("two people told apart" + at, share, "% of frames"));
    figures.push_back(
        atMost("identities beyond two" + at, std::max(0.0, static_cast<double>(ids.size()) - 2.0), 1.0));
  }
  return figures;
}

/// A car passes behind a bus and is hidden for about a second.
std::vector<Figure> behindTheBus(FilterMode mode, unsigned seed) {
  Scene scene;
  scene.actors.push_back({"car", 4.4, 1.8, 0.15, 1.5, drives(20.0, -15.0, M_PI / 2.0, 7.0)});
  scene.actors.push_back({"bus", 7.0, 2.5, 0.2, 3.0, stands(14.0, 0.0, M_PI / 2.0)});
  scene.duration_s = 4.5;
  std::uint32_t before = 0;
  Mean kept, hidden, left_behind;
  double ghosts = 0.0;
  for (const Step& step : drive(scene, options(mode, seed))) {
    const double y = scene.actors[0].at(step.t_s).y;
    const GridGeometry& g = step.frame->geometry;
    const auto at = [&](double place) {
      return step.frame->cells->occupied[g.indexOf(g.columnOf(20.0), g.rowOf(place))];
    };
    if (y < -7.5 && trackOf(step, 0)) before = trackOf(step, 0)->id;
    if (std::abs(y) < 3.0) hidden.add(at(y));
    if (y > 5.0 && y < 7.0) left_behind.add(at(y - 7.0));
    if (y < 9.0 || y > 14.0) continue;
    kept.add(trackOf(step, 0) && trackOf(step, 0)->id == before ? 1.0 : 0.0);
    for (const Object& object : step.frame->objects.objects) {
      const Eigen::Vector2d place = object.position.head<2>();
      if (distanceTo(scene.actors[0], step.t_s, place) > 2.0 &&
          distanceTo(scene.actors[1], step.t_s, place) > 1.0)
        ghosts += 1.0;
    }
  }
  const double frames = std::max<double>(1.0, static_cast<double>(kept.count));
  return {atLeast("same identity after 1 s behind a bus", 100.0 * kept.value(), 90.0, "% of frames"),
          atLeast("P(occupied) where the hidden car is", hidden.value(), 0.2),
          atMost("|P(occupied) - 0.5| where it was a second ago", std::abs(left_behind.value() - 0.5), 0.2),
          atMost("ghosts after it has come out", ghosts / frames, 0.05, "a frame")};
}

/// A car turns by 90 degrees: one object, whose heading follows.
std::vector<Figure> turningCar(FilterMode mode, unsigned seed) {
  constexpr double kSpeed = 5.0, kRadius = 6.0, kBegin_s = 1.0, kTurn_s = 0.5 * M_PI * kRadius / kSpeed;
  Scene scene;
  scene.actors.push_back({"car", 4.4, 1.8, 0.15, 1.5, [=](double t) {
                            if (t < kBegin_s) return Placing{18.0, -9.0 + kSpeed * t, M_PI / 2.0};
                            const double angle = std::min(t - kBegin_s, kTurn_s) * kSpeed / kRadius;
                            const double on = kSpeed * std::max(0.0, t - kBegin_s - kTurn_s);
                            return Placing{12.0 + kRadius * std::cos(angle) - on,
                                           -4.0 + kRadius * std::sin(angle), M_PI / 2.0 + angle};
                          }});
  scene.duration_s = 3.2;
  Mean split, seen, lag;
  for (const Step& step : drive(scene, options(mode, seed))) {
    if (step.t_s < 0.8) continue;
    split.add(step.of_actor[0].size() > 1 ? 1.0 : 0.0);
    seen.add(step.of_actor[0].empty() ? 0.0 : 1.0);
    if (step.t_s < kBegin_s || step.of_actor[0].empty()) continue;
    const double yaw = scene.actors[0].at(step.t_s).yaw;
    const Eigen::Vector3d& v = step.of_actor[0].front()->velocity_mps;
    lag.add(std::abs(wrapAngle(std::atan2(v.y(), v.x()) - yaw)) * 180.0 / M_PI);
  }
  return {atMost("turning car in pieces", 100.0 * split.value(), 5.0, "% of frames"),
          atLeast("turning car found", 100.0 * seen.value(), 95.0, "% of frames"),
          atMost("heading of the turning car", lag.value(), 15.0, "deg mean error")};
}

/// A bus of which the lidars see the wheels only, before and behind a piece that they look through
/// underneath.
std::vector<Figure> busInTwo(FilterMode mode, unsigned seed) {
  Scene scene;
  const auto along = [](double ahead) { return drives(16.0, -14.0 + ahead, M_PI / 2.0, 6.0); };
  scene.actors.push_back({"bus", 11.0, 2.5, 0.9, 3.0, along(0.0)});
  scene.actors.push_back({"front", 2.0, 2.4, 0.0, 0.9, along(4.0)});
  scene.actors.push_back({"rear", 1.6, 2.4, 0.0, 0.9, along(-4.0)});
  scene.duration_s = 4.0;
  Mean one;
  double first_whole = scene.duration_s;
  for (const Step& step : drive(scene, options(mode, seed))) {
    if (step.t_s < 1.5 || step.t_s > 3.5) continue;
    std::size_t tracks = 0;
    for (const auto& of_part : step.of_actor) tracks += of_part.size();
    one.add(tracks == 1 ? 1.0 : 0.0);
    if (tracks == 1) first_whole = std::min(first_whole, step.t_s);
  }
  return {atMost("bus one object after it is seen whole", first_whole - 1.5, 1.0, "s"),
          atLeast("bus one object", 100.0 * one.value(), 50.0, "% of frames")};
}

/// Faster than the lattice reaches: said so, and no velocity the other way round.
std::vector<Figure> saturation(FilterMode mode, unsigned seed) {
  Scene scene;
  scene.actors.push_back({"oncoming", 4.4, 1.8, 0.15, 1.5, drives(44.0, 4.0, M_PI, 14.0)});
  scene.actors.push_back({"truck", 8.0, 2.5, 0.2, 3.0, drives(2.0, -4.0, 0.0, 20.0)});
  scene.duration_s = 2.4;
  Mean edge, backwards, oncoming_speed, oncoming_backwards, truck_speed;
  for (const Step& step : drive(scene, options(mode, seed))) {
    const GridGeometry& g = step.frame->geometry;
    for (int row = 0; row < g.rows; ++row) {
      for (int column = 0; column < g.columns; ++column) {
        const std::size_t i = g.indexOf(column, row);
        const CellEstimates& cells = *step.frame->cells;
        if (cells.occupied[i] < 0.6F || cells.static_share[i] > 0.5F || step.t_s < 0.8) continue;
        const Eigen::Vector2d place = g.middleOf(column, row);
        if (distanceTo(scene.actors[1], step.t_s, place) < 0.2) {
          edge.add(cells.saturation[i]);
          backwards.add(cells.vx_mps[i] < -1.0F ? 1.0 : 0.0);
        } else if (distanceTo(scene.actors[0], step.t_s, place) < 0.2) {
          oncoming_backwards.add(cells.vx_mps[i] > 1.0F ? 1.0 : 0.0);
        }
      }
    }
    if (step.t_s < 1.2) continue;
    if (const Object* track = trackOf(step, 0))
      oncoming_speed.add(std::pow(track->velocity_mps.x() + 14.0, 2));
    if (const Object* track = trackOf(step, 1)) truck_speed.add(std::pow(track->velocity_mps.x() - 20.0, 2));
  }
  return {atLeast("belief on the outermost velocities, 20 m/s", edge.value(), 0.5),
          atMost("cells that move the other way, 20 m/s", 100.0 * backwards.value(), 2.0, "%"),
          atMost("cells that move the other way, 14 m/s", 100.0 * oncoming_backwards.value(), 2.0, "%"),
          told("velocity of the car at 14 m/s", oncoming_speed.root(), "m/s RMSE"),
          told("velocity of the truck at 20 m/s", truck_speed.root(), "m/s RMSE")};
}

}  // namespace atlas::grid_scene
