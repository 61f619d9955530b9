// SPDX-License-Identifier: MIT
#include "atlas/grid/beam_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace atlas {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A layer of beams half a degree apart over +-50 degrees whose ranges a function of the azimuth tells.
template <class RangeAt>
LidarLayer layerOf(double elevation_rad, double lidar_height_m, RangeAt&& range_at) {
  LidarLayer layer{elevation_rad, {}};
  for (int i = -100; i <= 100; ++i) {
    const double azimuth = 0.5 * i * kDegree;
    const auto range = static_cast<float>(range_at(azimuth));
    layer.beams.push_back({static_cast<float>(azimuth), range,
                           static_cast<float>(lidar_height_m + std::tan(elevation_rad) * range)});
  }
  return layer;
}

class BeamModelTest : public ::testing::Test {
 protected:
  BeamModelTest() {
    grid_.ahead_m = 20.0;
    lidar_.T_map_lidar.translation = {0.0, 0.0, 0.5};
  }
  float at(double x, double y) {
    const GridGeometry g = placeGrid(grid_, {0.0, 0.0}, 0.0);
    BeamModel model(params_);
    return model.evaluate(lidar_, RoadPlane{}, g, one_).occupied[g.indexOf(g.columnOf(x), g.rowOf(y))];
  }
  GridParams grid_;
  BeamParams params_;
  LidarLayers lidar_;
  RowWorkers one_{1};
};

TEST_F(BeamModelTest, FreeBeforeTheHitOccupiedAtItUnknownBehind) {
  lidar_.layers = {layerOf(0.0, 0.5, [](double) { return 15.1; })};
  EXPECT_NEAR(at(15.1, 0.1), params_.hit, 0.08);
  // the equation at 5 m: 0.5 - 0.25 (1 - 5 / 60)
  EXPECT_NEAR(at(5.1, 0.1), 0.5 - 0.25 * (1.0 - 5.1 / 60.0), 0.01);
  EXPECT_FLOAT_EQ(at(18.1, 0.1), 0.5F);
  EXPECT_FLOAT_EQ(at(5.1, 15.0), 0.5F);  // beside the field of view
}

TEST_F(BeamModelTest, ThereIsNoHoleBetweenTheBeamsOfAFarSurface) {
  // at 35 m neighbouring beams are 0.31 m apart: more than a cell
  lidar_.layers = {layerOf(0.0, 0.5, [](double azimuth) { return 35.1 / std::cos(azimuth); })};
  for (double y = -12.0; y < 12.0; y += 0.2) EXPECT_GT(at(35.1, y), 0.6F) << y;
}

TEST_F(BeamModelTest, ASurfaceThatIsMetAtAGrazingAngleHasNoHolesAndTwoThingsAreNotJoined) {
  // a wall along x at y = 2: neighbouring returns are up to a metre apart
  lidar_.layers = {layerOf(
      0.0, 0.5, [](double azimuth) { return azimuth > 5.0 * kDegree ? 2.0 / std::sin(azimuth) : 39.0; })};
  for (double x = 3.1; x < 16.0; x += 0.2) EXPECT_GT(std::max({at(x, 1.9), at(x, 2.1)}), 0.55F) << x;
  // a post 1 m before a wall: between them nothing is said to be there
  lidar_.layers = {
      layerOf(0.0, 0.5, [](double azimuth) { return std::abs(azimuth) < 1.2 * kDegree ? 9.1 : 10.1; })};
  for (double y = -1.0; y < 1.0; y += 0.2) EXPECT_LT(at(9.6, y), 0.55F) << y;
}

TEST_F(BeamModelTest, ReturnsOfTheRoadAreNoObstacleAndDoNotNeedTheOtherLayers) {
  lidar_.layers = {layerOf(-2.0 * kDegree, 0.5, [](double) { return 0.5 / std::tan(2.0 * kDegree); })};
  const double range = 0.5 / std::tan(2.0 * kDegree);
  EXPECT_LE(at(range, 0.1), 0.5F);
  EXPECT_LT(at(range - 2.0, 0.1), 0.45F);
}

TEST_F(BeamModelTest, OneLowReturnIsOutvotedByThreeBeamsThatPass) {
  // the paper: impacts with the road are filtered out by the layers
  params_.min_height_m = 0.01;
  params_.slope_sigma = 0.0;
  const auto far = [](double) { return 39.0; };
  lidar_.layers = {layerOf(-1.0 * kDegree, 0.5, [](double) { return 12.1; })};
  EXPECT_GT(at(12.1, 0.1), 0.7F);
  for (int i = 0; i < 3; ++i) lidar_.layers.push_back(layerOf((0.2 * i - 0.1) * kDegree, 0.5, far));
  EXPECT_LT(at(12.1, 0.1), 0.4F);
}

TEST_F(BeamModelTest, ABeamHighAboveSaysNothingOfTheGround) {
  lidar_.T_map_lidar.translation.z() = 1.9;
  lidar_.layers = {layerOf(0.0, 1.9, [](double) { return 30.0; })};
  EXPECT_GT(at(10.1, 0.1), 0.45F);
  EXPECT_LT(at(10.1, 0.1), 0.5F);
  lidar_.T_map_lidar.translation.z() = 3.0;
  lidar_.layers = {layerOf(0.0, 3.0, [](double) { return 30.1; })};
  EXPECT_FLOAT_EQ(at(10.1, 0.1), 0.5F);
  EXPECT_FLOAT_EQ(at(30.1, 0.1), 0.5F);  // nor is a bridge an obstacle
}

TEST_F(BeamModelTest, NoReturnIsFreeAsFarAsItIsTrusted) {
  lidar_.layers = {layerOf(0.0, 0.5, [](double) { return kNan; })};
  EXPECT_LT(at(10.1, 0.1), 0.4F);
  EXPECT_FLOAT_EQ(at(params_.trusted_m + 1.0, 0.1), 0.5F);
}

TEST_F(BeamModelTest, BadRangesAreAsNoReturnAndAnEmptyLayerSaysNothing) {
  lidar_.layers = {
      layerOf(0.0, 0.5, [](double) { return -1.0; }),
      layerOf(0.1 * kDegree, 0.5, [](double) { return std::numeric_limits<double>::infinity(); }),
      LidarLayer{}};
  EXPECT_LT(at(10.1, 0.1), 0.4F);
  lidar_.layers.clear();
  EXPECT_FLOAT_EQ(at(10.1, 0.1), 0.5F);
}

TEST_F(BeamModelTest, KnowsTheTopOfWhatItSaw) {
  lidar_.layers = {layerOf(0.0, 0.5, [](double) { return 10.1; }),
                   layerOf(4.0 * kDegree, 0.5, [](double) { return 10.1; })};
  const GridGeometry g = placeGrid(grid_, {0.0, 0.0}, 0.0);
  BeamModel model(params_);
  const LidarEvidence& evidence = model.evaluate(lidar_, RoadPlane{}, g, one_);
  EXPECT_NEAR(evidence.top_m[g.indexOf(g.columnOf(10.1), g.rowOf(0.0))], 0.5 + 10.1 * std::tan(4.0 * kDegree),
              0.01);
  EXPECT_TRUE(std::isnan(evidence.top_m[g.indexOf(g.columnOf(5.1), g.rowOf(0.1))]));
}

TEST(BeamParams, AreChecked) {
  BeamParams params;
  params.hit = 0.4;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.trusted_m = 1000.0;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.range_sigma_m = 0.0;
  EXPECT_THROW(BeamModel{params}, std::invalid_argument);
}

}  // namespace
}  // namespace atlas
