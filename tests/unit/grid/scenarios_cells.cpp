// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "scenario_parts.hpp"

namespace atlas::grid_scene {
namespace {

double nearest(const Scene& scene, double t_s, const Eigen::Vector2d& place, std::size_t* actor = nullptr) {
  double least = 1e9;
  for (std::size_t a = 0; a < scene.actors.size(); ++a) {
    const double distance = distanceTo(scene.actors[a], t_s, place);
    if (distance >= least) continue;
    least = distance;
    if (actor != nullptr) *actor = a;
  }
  return least;
}

}  // namespace

void countFalseDynamic(const Scene& scene, const Step& step, CellCount& count) {
  const CellEstimates& cells = *step.frame->cells;
  forCells(*step.frame, [&](std::size_t i, const Eigen::Vector2d& place) {
    if (cells.occupied[i] < 0.6F) return;
    std::size_t actor = 0;
    if (nearest(scene, step.t_s, place, &actor) > 0.4 ||
        scene.actors[actor].velocityAt(step.t_s).norm() > 0.1)
      return;
    ++count.all;
    if (cells.static_share[i] < 0.5F && std::hypot(cells.vx_mps[i], cells.vy_mps[i]) > 1.0F) ++count.wrong;
  });
}

/// A street with everything in it: how good are the cells?
std::vector<Figure> street(FilterMode mode, unsigned seed) {
  Scene scene;
  scene.actors.push_back({"crossing", 4.4, 1.8, 0.15, 1.5, drives(9.0, -12.0, M_PI / 2.0, 7.3)});
  scene.actors.push_back({"leaving", 4.4, 1.8, 0.15, 1.5, drives(9.0, -1.5, 0.0, 6.1)});
  scene.actors.push_back({"slow", 4.4, 1.8, 0.15, 1.5, drives(12.0, 5.0, 0.0, 1.5)});
  scene.actors.push_back({"pedestrian", 0.5, 0.5, 0.0, 1.75, drives(11.0, -5.0, M_PI / 2.0, 1.4)});
  scene.actors.push_back({"parked", 4.4, 1.8, 0.15, 1.5, stands(26.0, 5.0)});
  scene.actors.push_back({"wall", 26.0, 0.3, 0.0, 2.5, stands(22.0, 9.5)});
  scene.actors.push_back({"house", 0.3, 20.0, 0.0, 2.5, stands(34.0, 0.0)});
  scene.duration_s = 3.0;
  double brier = 0.0, log_loss = 0.0;
  std::size_t judged = 0;
  CellCount still;
  std::vector<double> error(4, 0.0);
  std::vector<std::size_t> moving(4, 0);
  for (const Step& step : drive(scene, options(mode, seed))) {
    if (step.t_s < 1.2) continue;
    countFalseDynamic(scene, step, still);
    const CellEstimates& cells = *step.frame->cells;
    forCells(*step.frame, [&](std::size_t i, const Eigen::Vector2d& place) {
      std::size_t actor = 0;
      const double distance = nearest(scene, step.t_s, place, &actor);
      const double p = std::clamp<double>(cells.occupied[i], 1e-3, 1.0 - 1e-3);
      if (cells.unknown[i] < 0.1F && (distance > 0.3)) {  // what is seen to be free
        brier += p * p;
        log_loss -= std::log(1.0 - p);
        ++judged;
      } else if (cells.unknown[i] < 0.1F && distance == 0.0) {
        brier += (1.0 - p) * (1.0 - p);
        log_loss -= std::log(p);
        ++judged;
      }
      if (cells.occupied[i] < 0.6F || distance > 0.2 || actor >= 4) return;
      const Eigen::Vector2d v =
          (cells.static_share[i] > 0.5F ? 0.0 : 1.0) * Eigen::Vector2d(cells.vx_mps[i], cells.vy_mps[i]);
      error[actor] += (v - scene.actors[actor].velocityAt(step.t_s)).squaredNorm();
      ++moving[actor];
    });
  }
  std::vector<Figure> figures = {
      atMost("Brier score of observed cells", brier / static_cast<double>(judged), 0.05),
      told("log-loss of observed cells", log_loss / static_cast<double>(judged)),
      atMost("standing cells taken for moving", 100.0 * still.share(), 5.0, "%")};
  for (std::size_t a = 0; a < 4; ++a)
    figures.push_back(told("cell velocity, " + scene.actors[a].name + " " +
                               std::to_string(scene.actors[a].velocityAt(1.0).norm()).substr(0, 3) + " m/s",
                           std::sqrt(error[a] / std::max<double>(1.0, static_cast<double>(moving[a]))),
                           "m/s RMSE"));
  return figures;
}

/// The vehicle turns sharply among things that stand: none of them moves.
std::vector<Figure> sharpTurn(FilterMode mode, unsigned seed) {
  Scene scene;
  scene.ego = [](double t) {
    return Placing{10.0 * std::sin(0.5 * t), 10.0 - 10.0 * std::cos(0.5 * t), 0.5 * t};
  };
  for (int i = 0; i < 6; ++i) {
    const double angle = 0.3 + 0.45 * i;
    scene.actors.push_back({"parked", 4.4, 1.8, 0.15, 1.5,
                            stands(17.0 * std::sin(angle), 10.0 - 17.0 * std::cos(angle), angle)});
  }
  scene.actors.push_back({"wall", 0.4, 40.0, 0.0, 2.5, stands(26.0, 10.0)});
  scene.duration_s = 4.0;
  std::vector<Figure> figures;
  for (const bool compensated : {true, false}) {
    RunOptions run = options(mode, seed);
    run.compensate_ego = compensated;
    CellCount still;
    double moving = 0.0, frames = 0.0, fast = 0.0, occupied = 0.0;
    for (const Step& step : drive(scene, run)) {
      if (step.t_s < 1.0) continue;
      countFalseDynamic(scene, step, still);
      const CellEstimates& cells = *step.frame->cells;
      forCells(*step.frame, [&](std::size_t i, const Eigen::Vector2d&) {
        if (cells.occupied[i] < 0.6F) return;
        occupied += 1.0;
        fast +=
            cells.static_share[i] < 0.5F && std::hypot(cells.vx_mps[i], cells.vy_mps[i]) > 1.0F ? 1.0 : 0.0;
      });
      for (const Object& object : step.frame->objects.objects) moving += object.is_static ? 0.0 : 1.0;
      frames += 1.0;
    }
    if (compensated) {
      figures.push_back(atMost("standing cells taken for moving", 100.0 * still.share(), 5.0, "%"));
      figures.push_back(atMost("moving objects where all stands", moving / frames, 0.05, "a frame"));
    } else {
      figures.push_back(told("moving cells without odometry", 100.0 * fast / std::max(1.0, occupied), "%"));
      figures.push_back(told("moving objects without odometry", moving / frames, "a frame"));
    }
  }
  return figures;
}

/// Where the rear of a car is, by lidar, by stereo and by both.
std::vector<Figure> rangeError(FilterMode mode, unsigned seed) {
  std::vector<Figure> figures;
  for (const double distance : {10.0, 20.0, 30.0}) {
    double lidar_sigma = 0.0;
    for (const int sensors : {0, 1, 2}) {
      Scene scene;
      scene.actors.push_back({"car", 4.4, 1.8, 0.0, 1.5, stands(distance + 2.2, 0.0)});
      scene.duration_s = 1.5;
      RunOptions run = options(mode, seed);
      run.sensors.lidars = sensors != 1;
      run.sensors.stereo = sensors != 0;
      double sum = 0.0, squares = 0.0, count = 0.0;
      for (const Step& step : drive(scene, run)) {
        if (step.t_s < 0.5) continue;
        double x = 0.0, weight = 0.0;
        forCells(*step.frame, [&](std::size_t i, const Eigen::Vector2d& place) {
          const double w = std::max(0.0F, step.frame->cells->occupied[i] - 0.55F);
          if (std::abs(place.y()) > 0.7 || std::abs(place.x() - distance) > 6.0) return;
          x += w * place.x();
          weight += w;
        });
        if (weight <= 0.0) continue;
        sum += x / weight - distance;
        squares += std::pow(x / weight - distance, 2);
        count += 1.0;
      }
      const double bias = count > 0.0 ? sum / count : std::nan("");
      const double sigma =
          count > 0.0 ? std::sqrt(std::max(0.0, squares / count - bias * bias)) : std::nan("");
      if (sensors == 0) lidar_sigma = sigma;
      const std::string who = sensors == 0 ? "lidar" : sensors == 1 ? "stereo" : "both";
      const std::string at = " at " + std::to_string(static_cast<int>(distance)) + " m, " + who;
      // a lidar's bias is half a cell of quantization and the cells that its noise touches
      figures.push_back(sensors == 1 ? told("bias" + at, bias, "m")
                                     : atMost("|bias|" + at, std::abs(bias), 0.3, "m"));
      figures.push_back(sensors == 2 && distance > 15.0
                            ? atMost("sigma" + at, sigma, std::max(1.05 * lidar_sigma, 0.05), "m")
                            : told("sigma" + at, sigma, "m"));
    }
  }
  return figures;
}

/// Braking on an empty road: no ghosts, a kerb is none, a low bollard is found.
std::vector<Figure> emptyRoad(FilterMode mode, unsigned seed) {
  Scene scene;
  scene.actors.push_back({"bollard", 0.25, 0.25, 0.0, 0.5, stands(9.0, 1.0)});
  scene.actors.push_back({"kerb", 30.0, 0.3, 0.0, 0.12, stands(18.0, 4.0)});
  scene.pitch_rad = [](double t) { return t < 1.0 ? 0.0 : 3.0 * M_PI / 180.0; };
  scene.duration_s = 2.5;
  double bollard = 0.0, frames = 0.0, road = 0.0, ghosts = 0.0;
  for (const Step& step : drive(scene, options(mode, seed))) {
    if (step.t_s < 0.5) continue;
    double best = 0.0;
    forCells(*step.frame, [&](std::size_t i, const Eigen::Vector2d& place) {
      const double p = step.frame->cells->occupied[i];
      if (distanceTo(scene.actors[0], step.t_s, place) < 0.15) best = std::max(best, p);
      if (distanceTo(scene.actors[0], step.t_s, place) < 0.6 ||
          distanceTo(scene.actors[1], step.t_s, place) < 0.4)
        return;
      road += 1.0;
      ghosts += p > 0.6 ? 1.0 : 0.0;
    });
    bollard += best;
    frames += 1.0;
  }
  return {atMost("road cells taken for occupied", 100.0 * ghosts / road, 0.1, "%"),
          atLeast("P(occupied) of a bollard of 0.5 m", bollard / frames, 0.7)};
}

}  // namespace atlas::grid_scene
