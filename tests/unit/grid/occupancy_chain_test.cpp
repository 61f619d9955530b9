// SPDX-License-Identifier: MIT
#include "atlas/grid/occupancy_chain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "scene.hpp"

namespace atlas {
namespace {

using namespace grid_scene;
constexpr Stamp kStart = 1'500'000'000 * kSecond;

OccupancyInput inputAt(const Scene& scene, double t_s) {
  OccupancyInput input;
  input.stamp = kStart + fromSeconds(t_s);
  input.T_map_imu = egoPose(scene, t_s);
  input.motion = egoOdometry(scene, t_s, input.stamp);
  input.lidars = {scanOf(scene, SensorSet{}, 0, t_s, input.stamp),
                  scanOf(scene, SensorSet{}, 1, t_s, input.stamp)};
  return input;
}

class ChainTest : public ::testing::Test {
 protected:
  OccupancyChain chain_{paramsFor(FilterMode::kLattice)};
  Counters counters_;
};

TEST_F(ChainTest, ACarAheadIsFoundAndIsARisk) {
  Scene scene = carAhead();
  scene.ego = drives(0.0, 0.0, 0.0, 4.0);
  OccupancyFramePtr frame;
  for (int k = 0; k < 20; ++k) frame = chain_.update(inputAt(scene, 0.05 * k), counters_);
  ASSERT_TRUE(frame->cells);
  ASSERT_EQ(frame->objects.objects.size(), 1U);
  const Object& car = frame->objects.objects.front();
  const double half =
      0.5 * (std::abs(std::cos(car.yaw_rad)) * car.size.x() + std::abs(std::sin(car.yaw_rad)) * car.size.y());
  EXPECT_NEAR(car.position.x() - half, 11.8, 0.4);  // its rear is what is seen
  EXPECT_TRUE(car.is_static);
  ASSERT_TRUE(frame->risk);
  EXPECT_GT(frame->risk->total, 0.5);
  ASSERT_TRUE(frame->risk->expected_time_s);
  EXPECT_NEAR(*frame->risk->expected_time_s, (11.8 - 3.0 - 4.0 * 0.95) / 4.0, 0.3);
}

TEST_F(ChainTest, WithoutMotionThereIsNoRisk) {
  OccupancyInput input = inputAt(carAhead(), 0.0);
  input.motion.reset();
  const OccupancyFramePtr frame = chain_.update(input, counters_);
  EXPECT_TRUE(frame->cells);
  EXPECT_FALSE(frame->risk);
}

TEST_F(ChainTest, AStampThatGoesBackIsCountedAndTheSameOneIsAnotherMeasurement) {
  (void)chain_.update(inputAt(carAhead(), 1.0), counters_);
  EXPECT_FALSE(chain_.update(inputAt(carAhead(), 0.9), counters_)->cells);
  EXPECT_EQ(counters_.get("skipped grid update: " + std::string(toString(Reason::kOutOfOrder))), 1U);
  EXPECT_TRUE(chain_.update(inputAt(carAhead(), 1.0), counters_)->cells);
}

TEST_F(ChainTest, BeginsAnewAfterAGap) {
  for (int k = 0; k < 5; ++k) (void)chain_.update(inputAt(carAhead(), 0.05 * k), counters_);
  OccupancyInput nothing = inputAt(carAhead(), 5.0);
  nothing.lidars.clear();
  const OccupancyFramePtr frame = chain_.update(nothing, counters_);
  EXPECT_EQ(counters_.get("grid begun anew after a gap"), 1U);
  for (const float p : frame->cells->occupied) EXPECT_FLOAT_EQ(p, 0.5F);
}

TEST_F(ChainTest, BadDataIsCountedAndDoesNoHarm) {
  OccupancyInput input = inputAt(carAhead(), 0.0);
  input.lidars[1].layers.clear();
  for (LidarLayer& layer : input.lidars[0].layers) {
    for (LayerBeam& beam : layer.beams) beam.range_m = std::numeric_limits<float>::quiet_NaN();
  }
  auto broken = std::make_shared<SensorGrid>();
  broken->columns = broken->rows = 10;  // and no values
  input.grids = {{broken, Pose{}}, {nullptr, Pose{}}};
  const OccupancyFramePtr frame = chain_.update(input, counters_);
  EXPECT_EQ(frame->lidars_used, 1U);
  EXPECT_EQ(frame->grids_used, 0U);
  EXPECT_EQ(counters_.get("skipped grid lidar: " + std::string(toString(Reason::kEmpty))), 1U);
  EXPECT_EQ(counters_.get("skipped grid of stereo: " + std::string(toString(Reason::kBadLayout))), 2U);
  for (const float p : frame->cells->occupied) EXPECT_LE(p, 0.5F);
  input.stamp += kSecond / 20;
  input.T_map_imu.translation.x() = std::nan("");
  EXPECT_FALSE(chain_.update(input, counters_)->cells);
}

TEST_F(ChainTest, TheOrderOfTheLidarsDoesNotMatter) {
  OccupancyChain other(paramsFor(FilterMode::kLattice));
  for (int k = 0; k < 5; ++k) {
    OccupancyInput input = inputAt(carAhead(), 0.05 * k);
    const OccupancyFramePtr a = chain_.update(input, counters_);
    std::swap(input.lidars[0], input.lidars[1]);
    const OccupancyFramePtr b = other.update(input, counters_);
    for (std::size_t i = 0; i < a->cells->occupied.size(); ++i)
      ASSERT_NEAR(a->cells->occupied[i], b->cells->occupied[i], 2e-3) << i;
  }
}

TEST_F(ChainTest, AStereoGridIsLaidIntoTheMapTurned) {
  OccupancyInput input = inputAt(carAhead(), 0.0);
  input.lidars.clear();
  auto grid = std::make_shared<SensorGrid>();
  grid->columns = grid->rows = 50;
  grid->origin_y_m = -5.0;
  grid->occupied.assign(2500, 0.5F);
  for (int row = 24; row < 26; ++row) {
    for (int column = 29; column < 31; ++column)
      grid->occupied[static_cast<std::size_t>(50 * row + column)] = 0.9F;
  }
  input.grids = {{grid, Pose{fromRollPitchYaw({0.0, 0.0, M_PI / 2.0}), {10.0, 2.0, 0.0}}}};  // (6, 0) of it
  const OccupancyFramePtr frame = chain_.update(input, counters_);
  const GridGeometry& g = frame->geometry;
  EXPECT_GT(frame->cells->occupied[g.indexOf(g.columnOf(9.9), g.rowOf(8.0))], 0.6F);
  EXPECT_NEAR(frame->cells->occupied[g.indexOf(g.columnOf(12.0), g.rowOf(2.0))], 0.5F, 1e-3);
}

TEST(OccupancyParams, AreChecked) {
  OccupancyParams params;
  params.lidars.clear();
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.threads = 0;
  EXPECT_THROW(OccupancyChain{params}, std::invalid_argument);
  params = {};
  params.max_gap_s = 0.0;
  EXPECT_THROW(validate(params), std::invalid_argument);
  EXPECT_NO_THROW(validate(OccupancyParams{}));
}

}  // namespace
}  // namespace atlas
