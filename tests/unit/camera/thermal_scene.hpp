// SPDX-License-Identifier: MIT
// What the tests of the thermal stage share: a plate seen by RGB cameras, a standing car, a way to feed the
// stage.
#pragma once

#include <gtest/gtest.h>

#include "atlas/camera/thermal_stage.hpp"
#include "scene.hpp"

namespace atlas::test {

constexpr Stamp ms(int milliseconds) { return kStart + milliseconds * kMillisecond; }

inline ThermalParams params(std::vector<std::string> cameras = {"rgb"}) {
  ThermalParams p;
  p.thermal_camera = "camera";
  p.cameras = std::move(cameras);
  p.lidars = {};
  return p;
}

// A plate of 2 m x 2 m at (10, y, 0) in map, facing the car.
inline Frustums plateAt(Stamp stamp, double y = 0.0, double x = 10.0) {
  Frustums result;
  result.stamp = stamp;
  Frustum f;
  f.corners = {Eigen::Vector3d(x, y + 1, 1),      Eigen::Vector3d(x, y - 1, 1),
               Eigen::Vector3d(x, y - 1, -1),     Eigen::Vector3d(x, y + 1, -1),
               Eigen::Vector3d(x + 1, y + 1, 1),  Eigen::Vector3d(x + 1, y - 1, 1),
               Eigen::Vector3d(x + 1, y - 1, -1), Eigen::Vector3d(x + 1, y + 1, -1)};
  f.position = {x, y, 0};
  result.frustums = {f};
  return result;
}

struct Inputs {
  std::vector<Odometry> odometry;
  std::vector<Stamp> frames;
  std::vector<std::vector<Frustums>> frustums;
  std::vector<BatchedSweepPtr> sweeps = {};  ///< of one lidar
};

inline std::vector<Odometry> standing() {
  std::vector<Odometry> result;
  for (int i = -10; i <= 100; ++i) result.push_back(odometry(ms(i * 10)));
  return result;
}

inline std::vector<ProjectedDetections> answers(ThermalStage& stage, const Inputs& inputs,
                                                unsigned seed = 0) {
  std::vector<ProjectedDetections> result;
  stage.on_projected = [&](const ProjectedDetections& p) { result.push_back(p); };
  std::vector<Feed> feeds(3 + inputs.frustums.size());
  feeds[0] = {ThermalStage::kTfStatic, {[&] { stage.push(0, rig({{"camera", forwardCamera()}})); }}};
  feeds[1].input = ThermalStage::kOdometry;
  for (const Odometry& o : inputs.odometry) feeds[1].pushes.push_back([&] { stage.push(o); });
  feeds[2].input = ThermalStage::kThermalInfo;
  for (const Stamp stamp : inputs.frames) {
    feeds[2].pushes.push_back([&stage, stamp] { stage.pushThermal(simpleInfo("camera", stamp)); });
  }
  for (std::size_t c = 0; c < inputs.frustums.size(); ++c) {
    feeds[3 + c].input = ThermalStage::kFirstCamera + c;
    for (const Frustums& f : inputs.frustums[c])
      feeds[3 + c].pushes.push_back([&stage, c, &f] { stage.push(c, f); });
  }
  if (stage.inputs() > feeds.size()) {
    feeds.push_back({stage.lidarInput(0), {}});
    for (const BatchedSweepPtr& sweep : inputs.sweeps)
      feeds.back().pushes.push_back([&stage, &sweep] { stage.push(0, sweep); });
  }
  run(stage, feeds, seed);
  EXPECT_TRUE(stage.ended());
  return result;
}

}  // namespace atlas::test
