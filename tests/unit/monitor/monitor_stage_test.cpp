// SPDX-License-Identifier: MIT
#include "atlas/monitor/monitor_stage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <random>

#include "watched.hpp"

namespace atlas {
namespace {

using test::at;

MonitorParams params() {
  MonitorParams p;
  p.cameras = {"camera_ir"};
  p.thermal_cameras = {"camera_ir"};
  p.radars = {"radar_ti"};
  p.required = {"imu"};
  return p;
}

struct Watching {
  explicit Watching(const MonitorParams& p = params()) : stage(p) {
    stage.on_status = [this](const SensorStatus& s) { said.push_back(s); };
  }
  /// Imu at 100 Hz and, in the order of `fix_first`, fixes at 10 Hz.
  void drive(double from_s, double to_s, bool with_fixes = true, bool fix_first = true) {
    std::normal_distribution<double> noise(0.0, 0.1);
    for (int i = 0; from_s + 0.01 * i < to_s - 1e-9; ++i) {
      const double t = from_s + 0.01 * i;
      ImuSample sample;
      sample.stamp = at(t);
      sample.linear_acceleration_mps2 = {noise(random), noise(random), 9.81 + noise(random)};
      sample.angular_velocity_radps = {0.1 * noise(random), 0.1 * noise(random), 0.1 * noise(random)};
      GnssFix fix;
      fix.stamp = at(t);
      fix.position = {49.0, 16.0 + 1e-6 * t, 200.0};
      const bool fixed = with_fixes && i % 10 == 0;
      if (fixed && fix_first) stage.push(fix);
      stage.push(sample);
      if (fixed && !fix_first) stage.push(fix);
    }
  }
  void end() {
    for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
  }
  [[nodiscard]] std::vector<SensorStatus> of(const std::string& sensor) const {
    std::vector<SensorStatus> result;
    std::copy_if(said.begin(), said.end(), std::back_inserter(result),
                 [&](const SensorStatus& s) { return s.sensor == sensor; });
    return result;
  }
  std::mt19937 random{1};
  MonitorStage stage;
  std::vector<SensorStatus> said;
};

TEST(MonitorStage, SaysOnceASecondHowEachSensorIs) {
  Watching run;
  run.drive(0, 5.05);
  run.end();
  const auto imu = run.of("imu");
  ASSERT_EQ(imu.size(), 5U);
  for (std::size_t i = 0; i < imu.size(); ++i) {
    EXPECT_EQ(imu[i].stamp, at(1.0 + static_cast<double>(i)));
    EXPECT_DOUBLE_EQ(imu[i].score, 1.0);
  }
  EXPECT_EQ(run.of("gnss").size(), 5U);
  EXPECT_TRUE(run.of("lidar_left").empty()) << "not required and never there";
  EXPECT_TRUE(std::is_sorted(run.said.begin(), run.said.end(),
                             [](const auto& a, const auto& b) { return a.stamp < b.stamp; }));
}

TEST(MonitorStage, SilenceIsSaidWhenItBeginsToCount) {
  Watching run;
  run.drive(0, 5);
  run.drive(5, 8, false);
  run.end();
  const auto gnss = run.of("gnss");
  const auto missing = std::find_if(gnss.begin(), gnss.end(), [](const auto& s) { return s.score == 0.0; });
  ASSERT_NE(missing, gnss.end());
  EXPECT_EQ(missing->anomalies.at(0).name, "missing");
  EXPECT_LE(toSeconds(missing->stamp - at(4.9)), 0.7) << "0.5 s and a tick of the monitor";
  EXPECT_EQ(run.stage.counters().get("anomaly gnss: missing"), 1U);
}

TEST(MonitorStage, ARequiredSensorThatNeverComesIsMissing) {
  MonitorParams p = params();
  p.required = {"imu", "lidar_left"};
  Watching run(p);
  run.drive(0, 3);
  run.end();
  const auto lidar = run.of("lidar_left");
  ASSERT_FALSE(lidar.empty());
  EXPECT_DOUBLE_EQ(lidar.back().score, 0.0);
}

TEST(MonitorStage, AStampThatGoesBackIsMisorderedAtTheNextMessage) {
  Watching run;
  run.drive(0, 2);
  GnssFix old;
  old.stamp = at(1.5);
  run.stage.push(old);
  run.drive(2, 5);
  run.end();
  EXPECT_TRUE(run.of("gnss").back().anomalies.empty()) << "it was one message only";
  const auto gnss = run.of("gnss");
  const auto seen =
      std::find_if(gnss.begin(), gnss.end(), [](const auto& s) { return !s.anomalies.empty(); });
  ASSERT_NE(seen, gnss.end());
  EXPECT_EQ(seen->anomalies.at(0).name, "misordered");
  EXPECT_EQ(seen->stamp, at(2.0));
}

TEST(MonitorStage, OrderOfArrivalHasNoInfluence) {
  Watching a, b;
  a.drive(0, 4, true, true);
  a.drive(4, 6, false);
  b.drive(0, 4, true, false);
  b.drive(4, 6, false);
  a.end();
  b.end();
  ASSERT_EQ(a.said.size(), b.said.size());
  for (std::size_t i = 0; i < a.said.size(); ++i) {
    EXPECT_EQ(a.said[i].stamp, b.said[i].stamp);
    EXPECT_EQ(a.said[i].sensor, b.said[i].sensor);
    EXPECT_EQ(a.said[i].score, b.said[i].score);
  }
}

TEST(MonitorStage, ProgressNeverPassesAStatusThatIsOwed) {
  Watching run;
  run.stage.on_status = [&](const SensorStatus& s) {
    EXPECT_LE(run.stage.progress(), s.stamp) << "a status at or before what was promised";
    run.said.push_back(s);
  };
  for (std::size_t i = 0; i < run.stage.inputs(); ++i) {
    if (i != MonitorStage::kImu && i != MonitorStage::kFix) run.stage.finish(i);
  }
  run.drive(0, 4);
  EXPECT_GT(run.stage.progress(), at(3.8));
  EXPECT_LT(run.stage.progress(), at(4.0));
  run.end();
  EXPECT_EQ(run.stage.progress(), kEndOfTime);
}

TEST(MonitorStage, ALongGapOfAllDataDoesNotHoldTheSourceBack) {
  Watching run;
  run.drive(0, 4);
  for (std::size_t i = 0; i < run.stage.inputs(); ++i) run.stage.advance(i, at(14.0));
  EXPECT_GT(run.stage.progress(), at(13.0));
}

TEST(MonitorStage, PicturesAreJudgedByTheMotionThatTheReceiverSees) {
  Watching run;
  auto picture = std::make_shared<Image>();
  picture->pixels = cv::Mat(512, 640, CV_8UC1);
  cv::randu(picture->pixels, 0, 255);
  for (int i = 0; i < 40; ++i) {  // the vehicle drives at 10 m/s
    const double t = 0.1 * i;
    auto image = std::make_shared<Image>(*picture);
    image->stamp = at(t);
    GnssFix fix;
    fix.stamp = at(t);
    fix.position = {49.0 + 9e-6 * t * 10.0, 16.0, 200.0};
    run.stage.push(fix);
    run.stage.push(std::size_t{0}, ImagePtr(image));
  }
  run.end();
  EXPECT_EQ(run.stage.counters().get("anomaly camera_ir: frozen"), 1U);
  EXPECT_EQ(run.stage.counters().get("pictures"), 40U);
}

TEST(MonitorParams, RefusesWhatCannotBe) {
  const auto refused = [](const MonitorParams& p) {
    try {
      validate(p);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused(params()), "");
  MonitorParams p = params();
  p.required = {"lidar_top"};
  EXPECT_EQ(refused(p), "sensor_monitor: required names an unknown sensor, got 'lidar_top'");
  p = params();
  p.thermal_cameras = {"camera_uv"};
  EXPECT_EQ(refused(p), "sensor_monitor: thermal_cameras must be among cameras, got 'camera_uv'");
  p = params();
  p.thresholds[Anomaly::kGap] = -1.0;
  EXPECT_EQ(refused(p), "sensor_monitor: gap_periods must be >= 0, got -1.000000");
  p = params();
  p.status_period_s = 0.0;
  EXPECT_EQ(refused(p), "sensor_monitor: status_period_s must be at least 0.1, got 0.000000");
}

}  // namespace
}  // namespace atlas
