// SPDX-License-Identifier: MIT
// Stages that leave out the data of a sensor whose score is below its limit.
#include "atlas/sensor/sensor_gate.hpp"

#include "atlas/pipeline.hpp"
#include "watched.hpp"

namespace atlas {
namespace {

using test::at;

TEST(SensorGate, ClosesBelowTheLimitOfTheSensorOnly) {
  SensorGate gate({{"gnss", 0.3}});
  EXPECT_TRUE(gate.open("gnss")) << "nobody has said anything yet";
  gate.add({0, "gnss", 0.3, {}});
  EXPECT_TRUE(gate.open("gnss"));
  gate.add({1, "gnss", 0.29, {}});
  gate.add({1, "imu", 0.0, {}});
  EXPECT_FALSE(gate.open("gnss"));
  EXPECT_TRUE(gate.open("imu")) << "not named";
  gate.add({2, "gnss", 1.0, {}});
  EXPECT_TRUE(gate.open("gnss"));
}

TEST(SensorGate, LimitsLieBetweenZeroAndOne) {
  EXPECT_NO_THROW(validate(SensorLimits{{"gnss", 0.0}, {"imu", 1.0}}, "localization"));
  try {
    validate(SensorLimits{{"gnss", 1.5}}, "localization");
    FAIL() << "1.5 was taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "localization: gate_on_sensors: gnss must be in 0..1, got 1.500000");
  }
}

/// A receiver at 10 Hz that jumps by 20 m for one fix, watched by the monitor, as in the whole graph.
std::map<std::string, std::uint64_t> localizationCounts(const SensorLimits& limits) {
  MonitorParams monitor;
  monitor.required = {};
  LocalizationParams localization;
  localization.filter = "eskf";
  localization.gnss_antenna_frame = "";
  localization.gate_on_sensors = limits;
  LocalGraph graph;
  graph.add([&](LocalGraph::Bus& bus) { return bindMonitor(bus, monitor); });
  graph.add([&](LocalGraph::Bus& bus) { return bindLocalization(bus, localization); });
  for (int i = 0; i < 500; ++i) {
    const double t = 0.01 * i;
    ImuSample imu;
    imu.stamp = at(t);
    imu.linear_acceleration_mps2 = {0.01 * (i % 3), 0.01 * (i % 5), 9.81};
    graph.publish("imu/data", imu);
    if (i % 10 == 0) {
      GnssFix fix;
      fix.stamp = at(t);
      fix.position = {49.0 + 1e-8 * (i % 7) + (i == 300 ? 2e-4 : 0.0), 16.0, 200.0};
      graph.publish("gnss/fix", fix);
    }
    graph.advance(at(t) - 1);
  }
  graph.finish();
  return graph.stages().at(1)->counters().all();
}

TEST(SensorGate, ThePositioningLeavesOutTheVeryFixThatJumps) {
  const auto gated = localizationCounts({{"gnss", 0.5}});
  EXPECT_EQ(gated.at("fix"), 50U);
  // The jump itself, and until a second without another has passed.
  EXPECT_GE(gated.at("skipped fix: score of gnss below its limit"), 1U);
  EXPECT_LE(gated.at("skipped fix: score of gnss below its limit"), 13U);
  EXPECT_EQ(localizationCounts({}).count("skipped fix: score of gnss below its limit"), 0U);
  EXPECT_EQ(localizationCounts({{"imu_gnss", 0.5}}).count("skipped fix: score of gnss below its limit"), 0U);
}

TEST(SensorGate, AnImageOfACameraBelowItsLimitIsAnsweredWithoutFrustums) {
  CameraLidarParams params;
  params.cameras = {"camera_left_front"};
  params.gate_on_sensors = {{"camera_left_front", 0.5}};
  CameraLidarStage stage(params);
  std::vector<Frustums> answers;
  stage.on_frustums = [&](std::size_t, const Frustums& frustums) { answers.push_back(frustums); };
  stage.push(SensorStatus{at(1), "camera_left_front", 0.1, {}});
  stage.push(SensorStatus{at(2), "camera_left_front", 1.0, {}});
  for (const double t : {0.5, 1.0, 2.0}) {  // the status of the same stamp counts
    Detections detections;
    detections.stamp = at(t);
    detections.boxes.resize(2);
    stage.push(0, detections);
  }
  for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
  EXPECT_EQ(answers.size(), 3U);
  EXPECT_EQ(stage.counters().get("skipped detection: score of its camera below its limit"), 2U);
}

}  // namespace
}  // namespace atlas
