// SPDX-License-Identifier: MIT
#include "atlas/grid/occupancy_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene.hpp"

namespace atlas {
namespace {

using namespace grid_scene;
constexpr Stamp kStart = 1'500'000'000 * kSecond;

/// A scan as it comes from the de-skew, in one batch.
BatchedSweepPtr sweepOf(const Scene& scene, int lidar, double t_s) {
  const Stamp stamp = kStart + fromSeconds(t_s);
  const LidarLayers layers = scanOf(scene, SensorSet{}, lidar, t_s, stamp);
  auto sweep = std::make_shared<Sweep>();
  const Pose T_lidar_map = layers.T_map_lidar.inverse();
  for (std::size_t ring = 0; ring < layers.layers.size(); ++ring) {
    for (const LayerBeam& beam : layers.layers[ring].beams) {
      LidarPoint p;
      p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN();
      p.ring = static_cast<std::uint16_t>(ring);
      if (std::isfinite(beam.range_m)) {
        const Eigen::Vector3d at =
            T_lidar_map *
            Eigen::Vector3d(layers.T_map_lidar.translation.x() + beam.range_m * std::cos(beam.azimuth_rad),
                            layers.T_map_lidar.translation.y() + beam.range_m * std::sin(beam.azimuth_rad),
                            beam.height_m);
        p.x = static_cast<float>(at.x());
        p.y = static_cast<float>(at.y());
        p.z = static_cast<float>(at.z());
      }
      sweep->points.push_back(p);
    }
  }
  auto batched = std::make_shared<BatchedSweep>();
  batched->stamp = stamp;
  batched->sweep = sweep;
  batched->T_map_lidar = layers.T_map_lidar;
  Batch all;
  all.count = static_cast<std::uint32_t>(sweep->points.size());
  all.stamp = stamp;
  all.T_map_lidar = layers.T_map_lidar;
  batched->batches = {all};
  return batched;
}

SensorGridPtr gridAt(double t_s) {
  auto grid = std::make_shared<SensorGrid>();
  grid->stamp = kStart + fromSeconds(t_s);
  grid->frame = "camera";
  grid->columns = grid->rows = 10;
  grid->occupied.assign(100, 0.3F);
  return grid;
}

class OccupancyStageTest : public ::testing::Test {
 protected:
  OccupancyStageTest() {
    params_ = paramsFor(FilterMode::kLattice);
    params_.stereo = {"stereo_front"};
    params_.layers.elevations_rad = {-0.028, -0.014, 0.0, 0.014};
  }
  void begin() {
    stage_ = std::make_unique<OccupancyStage>(params_);
    stage_->on_frame = [this](const OccupancyFramePtr& frame) { frames_.push_back(frame); };
    StaticTransforms rig;
    rig.transforms.push_back({"base_link", "camera", Pose{Eigen::Quaterniond::Identity(), {1.8, 0.0, 0.7}}});
    stage_->push(0, rig);
    stage_->finish(OccupancyStage::kTfStatic);
  }
  void odometryAt(double t_s) { stage_->push(egoOdometry(carAhead(), t_s, kStart + fromSeconds(t_s))); }
  void finish() {
    for (std::size_t input = 1; input < stage_->inputs(); ++input) stage_->finish(input);
  }
  OccupancyParams params_;
  std::unique_ptr<OccupancyStage> stage_;
  std::vector<OccupancyFramePtr> frames_;
};

TEST_F(OccupancyStageTest, NamesItsInputs) {
  begin();
  ASSERT_EQ(stage_->inputs(), 5U);
  EXPECT_EQ(stage_->inputName(OccupancyStage::kFirstLidar + 1), "lidar_right/batches");
  EXPECT_EQ(stage_->inputName(stage_->stereoInput(0)), "stereo_front/ground");
}

TEST_F(OccupancyStageTest, MeasurementsThatAreCloseInTimeAreOneUpdate) {
  begin();
  for (double t = 0.0; t < 0.5; t += 0.01) odometryAt(t);
  for (double t = 0.1; t < 0.39; t += 0.1) {
    stage_->push(0, sweepOf(carAhead(), 0, t));
    stage_->push(1, sweepOf(carAhead(), 1, t + 0.01));
    stage_->push(0, gridAt(t + 0.05));  // too far from both
  }
  finish();
  ASSERT_EQ(frames_.size(), 6U);
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    EXPECT_EQ(frames_[i]->lidars_used, i % 2 == 0 ? 2U : 0U);
    EXPECT_EQ(frames_[i]->grids_used, i % 2 == 0 ? 0U : 1U);
    ASSERT_TRUE(frames_[i]->cells);
    ASSERT_TRUE(frames_[i]->risk);
  }
  EXPECT_EQ(frames_[0]->stamp, kStart + fromSeconds(0.11));
  EXPECT_TRUE(stage_->ended());
}

TEST_F(OccupancyStageTest, EverySweepIsInOneGroupAlsoWhenOneLidarIsFaster) {
  begin();
  for (double t = 0.0; t < 0.5; t += 0.01) odometryAt(t);
  for (const double t : {0.1, 0.11, 0.12}) stage_->push(0, sweepOf(carAhead(), 0, t));
  finish();
  EXPECT_EQ(frames_.size(), 3U);
  EXPECT_EQ(stage_->counters().get("sweeps"), 3U);
}

TEST_F(OccupancyStageTest, AnswersDoNotDependOnTheOrderOfArrival) {
  std::vector<std::vector<float>> answers;
  for (const bool odometry_first : {true, false}) {
    frames_.clear();
    begin();
    if (odometry_first) {
      for (double t = 0.0; t < 0.4; t += 0.01) odometryAt(t);
    }
    for (double t = 0.1; t < 0.29; t += 0.05) stage_->push(1, sweepOf(carAhead(), 1, t + 0.005));
    for (double t = 0.1; t < 0.29; t += 0.05) stage_->push(0, sweepOf(carAhead(), 0, t));
    if (!odometry_first) {
      for (double t = 0.0; t < 0.4; t += 0.01) odometryAt(t);
    }
    finish();
    ASSERT_EQ(frames_.size(), 4U);
    answers.push_back(frames_.back()->cells->occupied);
  }
  EXPECT_EQ(answers[0], answers[1]);
}

TEST_F(OccupancyStageTest, WithoutPoseTheAnswerHasNoCells) {
  begin();
  stage_->push(0, sweepOf(carAhead(), 0, 0.1));
  finish();
  ASSERT_EQ(frames_.size(), 1U);
  EXPECT_FALSE(frames_[0]->cells);
  EXPECT_FALSE(frames_[0]->risk);
  EXPECT_EQ(stage_->counters().get("skipped grid update: " + std::string(toString(Reason::kNoPoseYet))), 1U);
}

TEST_F(OccupancyStageTest, ALidarThatIsSilentForASecondDoesNotHoldTheOthersBack) {
  begin();
  for (double t = 0.0; t < 2.0; t += 0.01) odometryAt(t);
  for (double t = 0.1; t < 1.9; t += 0.05) {
    if (t < 0.5 || t > 1.5) stage_->push(0, sweepOf(carAhead(), 0, t));
    stage_->push(0, gridAt(t));
  }
  finish();
  EXPECT_EQ(frames_.size(), 36U);
  for (const OccupancyFramePtr& frame : frames_) EXPECT_TRUE(frame->cells);
}

TEST_F(OccupancyStageTest, AGridOfAnUnknownCameraIsCounted) {
  begin();
  for (double t = 0.0; t < 0.5; t += 0.01) odometryAt(t);
  auto grid = std::make_shared<SensorGrid>(*gridAt(0.2));
  grid->frame = "nowhere";
  stage_->push(0, SensorGridPtr(grid));
  finish();
  ASSERT_EQ(frames_.size(), 1U);
  EXPECT_EQ(frames_[0]->grids_used, 0U);
  EXPECT_EQ(stage_->counters().get("skipped grid of stereo: " + std::string(toString(Reason::kMissingFrame))),
            1U);
}

}  // namespace
}  // namespace atlas
