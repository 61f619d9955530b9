// SPDX-License-Identifier: MIT
#include "atlas/lidar/obstacle_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "moving_lidar.hpp"

namespace atlas {
namespace {

using test::at;

/// Points in map seen by a lidar at the origin that stands still.
struct Scene {
  std::vector<LidarPoint> points;
  double slope = 0.0;

  void add(double x, double y, double above_ground) {
    LidarPoint p;
    p.x = static_cast<float>(x);
    p.y = static_cast<float>(y);
    p.z = static_cast<float>(slope * x + above_ground - 1.7);
    points.push_back(p);
  }
  void road() {
    for (double x = -30; x <= 30; x += 0.35) {
      for (double y = -15; y <= 15; y += 0.35) {
        if (std::hypot(x, y) > 3.0) add(x, y, y > 5.0 ? 0.12 : 0.0);  // a kerb at y = 5 m
      }
    }
  }
  /// Two visible sides of a car, rear left corner at (x, y).
  void car(double x, double y) {
    for (double z = 0.3; z <= 1.5; z += 0.16) {
      for (double s = 0; s <= 4.2; s += 0.16) add(x + s, y, z);
      for (double s = 0; s <= 1.8; s += 0.16) add(x, y + s, z);
    }
  }
  [[nodiscard]] BatchedSweepPtr seen(double stamp_s) const {
    auto sweep = std::make_shared<Sweep>();
    sweep->stamp = at(stamp_s);
    sweep->points = points;
    auto batched = std::make_shared<BatchedSweep>();
    batched->stamp = sweep->stamp;
    batched->sweep = sweep;
    batched->batches = {{0, static_cast<std::uint32_t>(points.size()), sweep->stamp, {}}};
    return batched;
  }
};

Odometry standing(double stamp_s) {
  Odometry o;
  o.stamp = at(stamp_s);
  return o;
}

Obstacles found(const Scene& scene, Counters& counters) {
  return findObstacles({scene.seen(1.0)}, Eigen::Vector3d::Zero(), at(1.0), {}, counters);
}

TEST(FindObstacles, W20_TwoCarsNearEachOtherOnASlopeWithAKerb) {
  for (const double slope : {0.0, 0.12}) {
    Scene scene;
    scene.slope = slope;
    scene.road();
    scene.car(8.0, 1.0);
    scene.car(8.0 + 4.2 + 0.9, 1.0);
    Counters counters;
    const Obstacles result = found(scene, counters);
    ASSERT_EQ(result.obstacles.size(), 2U)
        << "slope " << slope;  // W20: neither slope nor kerb is an obstacle
    EXPECT_NEAR(result.obstacles[0].center.x(), 10.1, 0.2);
    EXPECT_NEAR(result.obstacles[0].size.x(), 4.2, 0.3);
    EXPECT_NEAR(result.obstacles[0].size.y(), 1.8, 0.3);
    EXPECT_NEAR(result.obstacles[1].center.x(), 15.2, 0.2);
    EXPECT_GT(result.ground->points.size(), 5000U);
  }
}

TEST(FindObstacles, W20_LowThingsAreSeen) {
  // W20: below 1 m above the road the published program saw nothing
  Scene scene;
  scene.road();
  for (double z = 0.1; z <= 0.9; z += 0.16) {
    for (double a = 0; a < 6.2; a += 0.4)
      scene.add(10 + 0.3 * std::cos(a), -3 + 0.3 * std::sin(a), z);  // a child
  }
  Counters counters;
  const Obstacles result = found(scene, counters);
  ASSERT_EQ(result.obstacles.size(), 1U);
  EXPECT_NEAR(result.obstacles[0].center.x(), 10.0, 0.2);
  EXPECT_GT(result.obstacles[0].size.z(), 0.4);
}

TEST(FindObstacles, TwoLidarsThatSeeTheSameCarGiveOneBox) {
  // the left lidar sees its rear and its left side, the right one its rear and its right side
  Scene left, right;
  left.road();
  right.road();
  for (double z = 0.3; z <= 1.5; z += 0.16) {
    for (double s = 0; s <= 4.2; s += 0.16) {
      left.add(8.0 + s, 1.8, z);
      right.add(8.0 + s, 0.0, z);
    }
    for (double s = 0; s <= 1.8; s += 0.16) {
      left.add(8.0, s, z);
      right.add(8.0, s + 0.05, z);
    }
  }
  Counters counters;
  const Obstacles both =
      findObstacles({left.seen(1.0), right.seen(0.97)}, Eigen::Vector3d::Zero(), at(1.0), {}, counters);
  ASSERT_EQ(both.obstacles.size(), 1U);
  EXPECT_NEAR(both.obstacles[0].size.x(), 4.2, 0.2);
  EXPECT_NEAR(both.obstacles[0].size.y(), 1.8, 0.2);
  EXPECT_NEAR(both.obstacles[0].center.y(), 0.9, 0.1);
}

TEST(FindObstacles, AFarCarOfFewReturnsIsOneBox) {
  // rings are 0.65 m apart at 28 m: two on the grille, one on the screen 0.9 m behind it
  Scene scene;
  scene.road();
  for (double y = -0.85; y <= 0.86; y += 0.1) {
    scene.add(28.0, y, 0.35);
    scene.add(28.0, y, 0.8);
    scene.add(28.8, y, 1.25);
  }
  Counters counters;
  const Obstacles result = found(scene, counters);
  ASSERT_EQ(result.obstacles.size(), 1U);
  EXPECT_EQ(result.obstacles[0].points, 54U);
}

/// A front of two rings, the top one 0.7 m up, and a cabin of 2.6 m from `bonnet_m` behind it.
Scene frontAndCabin(double bonnet_m, double aside_m = 0.0, double cabin_from_m = 0.8) {
  Scene scene;
  scene.road();
  for (double y = -0.85; y <= 0.86; y += 0.1) {
    for (const double z : {0.35, 0.7}) scene.add(24.0, y, z);
    for (double x = 24.0 + bonnet_m; x <= 24.0 + bonnet_m + 2.6; x += 0.3)
      scene.add(x, y + aside_m, cabin_from_m + 0.15 * (x - 24.0 - bonnet_m));
  }
  return scene;
}

TEST(FindObstacles, FrontAndCabinAreOneCarWhereTheBonnetIsNotSeen) {
  Counters counters;
  const Obstacles car = found(frontAndCabin(1.3), counters);  // clusters bridge 0.78 m at 24 m
  ASSERT_EQ(car.obstacles.size(), 1U);
  EXPECT_NEAR(std::max(car.obstacles[0].size.x(), car.obstacles[0].size.y()), 3.9, 0.2);
  EXPECT_EQ(found(frontAndCabin(2.0), counters).obstacles.size(), 2U) << "no bonnet is so long";
  EXPECT_EQ(found(frontAndCabin(1.3, 0.9), counters).obstacles.size(), 2U) << "not in line";
  EXPECT_EQ(found(frontAndCabin(1.3, 0.0, 0.3), counters).obstacles.size(), 2U) << "no cabin begins so low";
}

TEST(FindObstacles, ARearBehindACarIsNotItsFront) {
  Scene scene;
  scene.road();
  for (double y = -0.85; y <= 0.86; y += 0.1) {
    for (double x = 20.0; x <= 22.6; x += 0.3) scene.add(x, y, 0.9 + 0.1 * (x - 20.0));  // a cabin
    for (const double z : {0.35, 0.7}) scene.add(24.0, y, z);  // of the next car, farther away
  }
  Counters counters;
  EXPECT_EQ(found(scene, counters).obstacles.size(), 2U);
}

TEST(FindObstacles, AStripOfRoofBelongsToItsCarACrownDoesNot) {
  Scene scene;
  scene.road();
  scene.car(8.0, 1.0);
  for (double y = 1.7; y <= 2.3; y += 0.05) scene.add(10.5, y, 1.55);  // a ring on the middle of the roof
  Counters counters;
  ASSERT_EQ(found(scene, counters).obstacles.size(), 1U);
  EXPECT_NEAR(found(scene, counters).obstacles[0].size.z(), 1.25, 0.05);
  for (double y = 1.2; y <= 2.6; y += 0.1) scene.add(10.5, y, 3.2);
  EXPECT_EQ(found(scene, counters).obstacles.size(), 2U);
}

TEST(FindObstacles, SmallClustersAreCountedHighPointsIgnored) {
  Scene scene;
  scene.road();
  for (int i = 0; i < 5; ++i) scene.add(12.0 + 0.2 * i, 0.0, 1.0);
  for (double x = 5; x < 9; x += 0.1) scene.add(x, 0.0, 4.6);  // a sign gantry
  Counters counters;
  EXPECT_TRUE(found(scene, counters).obstacles.empty());
  EXPECT_EQ(counters.get("clusters below min_points"), 1U);
}

TEST(ObstacleStage, OneAnswerForEachSweepOfTheFirstLidarOnceItsPoseIsKnown) {
  Scene scene;
  scene.road();
  scene.car(8, 1);
  ObstacleStage stage({});
  std::vector<Obstacles> answers;
  stage.on_obstacles = [&](const Obstacles& o) { answers.push_back(o); };
  stage.push(0, scene.seen(1.0));
  stage.push(1, scene.seen(1.05));
  stage.push(standing(0.98));
  stage.advance(ObstacleStage::kFirstLidar, at(1.2));
  stage.advance(ObstacleStage::kFirstLidar + 1, at(1.2));
  EXPECT_TRUE(answers.empty()) << "the pose at 1.0 s is not known yet";
  EXPECT_LT(stage.progress(), at(1.0));
  stage.push(standing(1.02));
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].stamp, at(1.0));
  EXPECT_EQ(answers[0].obstacles.size(), 1U);
  auto no_pose = std::make_shared<BatchedSweep>(*scene.seen(1.3));
  no_pose->batches.clear();
  stage.push(0, no_pose);
  stage.push(0, scene.seen(1.4));
  for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_TRUE(answers[1].obstacles.empty());
  EXPECT_TRUE(answers[2].obstacles.empty()) << "the odometry ended before";
  EXPECT_EQ(stage.counters().get("skipped sweep: no pose yet"), 1U);
  EXPECT_EQ(stage.counters().get("skipped sweep: after the newest pose"), 1U);
}

TEST(ObstacleStage, OfEachLidarTheNewestSweep) {
  // a car passes by: two sweeps of the same lidar would make it longer by what it drives in between
  const auto passing = [](double x) {
    Scene scene;
    scene.road();
    scene.car(x, 1.0);
    return scene;
  };
  for (const int sweeps : {1, 2}) {
    ObstacleParams params;
    params.sweeps_per_lidar = sweeps;
    ObstacleStage stage(params);
    std::vector<Obstacles> answers;
    stage.on_obstacles = [&](const Obstacles& o) { answers.push_back(o); };
    for (const double t : {0.9, 1.0, 1.1}) stage.push(standing(t));
    stage.push(0, passing(8.0).seen(0.95));
    stage.push(0, passing(9.0).seen(1.05));
    for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
    ASSERT_EQ(answers.size(), 2U);
    ASSERT_EQ(answers[1].obstacles.size(), 1U);
    EXPECT_NEAR(answers[1].obstacles[0].size.x(), sweeps == 1 ? 4.2 : 5.2, 0.2);
  }
}

TEST(ObstacleStage, ArrivalOrderHasNoInfluence) {
  Scene scene;
  scene.road();
  scene.car(8, 1);
  std::vector<Odometry> odometry;
  std::array<std::vector<BatchedSweepPtr>, 2> sweeps;
  for (int i = 0; i < 14; ++i) {
    if (i < 5 || i > 9) odometry.push_back(standing(0.9 + 0.07 * i));  // a gap that is bridged
  }
  odometry.push_back(standing(3.0));  // and one that is not
  for (int i = 0; i < 8; ++i) {
    sweeps[0].push_back(scene.seen(0.8 + 0.1 * i));
    sweeps[1].push_back(scene.seen(0.8 + 0.1 * i + (i % 2 == 0 ? 0.0 : 0.05)));
  }
  std::string expected;
  for (unsigned seed = 0; seed < 12; ++seed) {
    ObstacleStage stage({});
    std::string all;
    stage.on_obstacles = [&](const Obstacles& o) {
      all += std::to_string(o.stamp) + ":";
      for (const Obstacle& box : o.obstacles)
        all += " " + std::to_string(box.center.x()) + "/" + std::to_string(box.points);
    };
    std::vector<std::size_t> turns(odometry.size(), 0);
    for (const std::size_t input : {1U, 2U}) turns.insert(turns.end(), sweeps[input - 1].size(), input);
    std::mt19937 random(seed);
    if (seed > 0) std::shuffle(turns.begin(), turns.end(), random);
    std::array<std::size_t, 3> next{};
    for (const std::size_t input : turns) {
      const std::size_t i = next[input]++;
      if (input == 0) stage.push(odometry[i]);
      if (input > 0) stage.push(input - 1, sweeps[input - 1][i]);
      if (seed % 2 == 1 && input > 0) stage.advance(input, sweeps[input - 1][i]->stamp);
    }
    for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
    for (const auto& [key, count] : stage.counters().all()) all += key + "=" + std::to_string(count) + "\n";
    if (seed == 0) expected = all;
    EXPECT_EQ(all, expected) << "seed " << seed;
  }
  EXPECT_NE(expected.find("skipped sweep: no pose yet=1"), std::string::npos) << expected;
}

TEST(ObstacleStage, RefusesParametersByName) {
  ObstacleParams params;
  params.sweeps_per_lidar = 0;
  EXPECT_THROW(ObstacleStage{params}, std::invalid_argument);
  params = {};
  params.max_points = 3;
  EXPECT_THROW(ObstacleStage{params}, std::invalid_argument);
}

}  // namespace
}  // namespace atlas
