// SPDX-License-Identifier: MIT
// The error-state filter on simulated drives with known truth: accuracy, honesty (NEES over 20 seeds),
// outages, outliers, gaps, order of arrival, and its smoother.
#include <gtest/gtest.h>

#include <string_view>

#include "atlas/localization/eskf_history.hpp"
#include "stage_run.hpp"

namespace atlas::test {
namespace {

constexpr double kDeg = M_PI / 180.0;
constexpr int kSeeds = 20;

/// The sensors of realisticErrors(), as a data sheet would name them.
LocalizationParams eskfParams() {
  LocalizationParams params;
  params.filter = "eskf";
  params.positioning.eskf.accelerometer_noise_mps2_sqrt_hz = 0.01;
  params.positioning.eskf.gyroscope_noise_radps_sqrt_hz = 2e-4;
  return params;
}

struct Simulation {
  DriveParams drive;
  std::vector<Truth> truth;
  Recording recording;
};
Simulation simulate(unsigned seed, double duration_s) {
  std::mt19937 random(seed);
  Simulation s;
  s.drive = cityDrive(duration_s);
  s.drive.sway_rad = 0.003;  // of a car; the wheels' constraint knows the axle's height only roughly
  s.truth = drive(s.drive);
  Errors e = realisticErrors(random);
  e.earth_rotates = true;
  s.recording = record(s.truth, s.drive, e, random);
  return s;
}

template <class List>
void dropBetween(List& list, Stamp begin, double from_s, double to_s) {
  list.erase(std::remove_if(list.begin(), list.end(),
                            [&](const auto& x) {
                              const double t = toSeconds(x.stamp - begin);
                              return t > from_s && t < to_s;
                            }),
             list.end());
}

StageRun runRecorded(const Simulation& s, eskf::History& history) {
  StageRun result;
  LocalizationStage stage(eskfParams());
  stage.record(&history);
  listen(stage, result);
  stage.push(s.recording.imu.front().stamp, rigWith(s.drive.lever_arm_imu));
  stage.finish(LocalizationStage::kTfStatic);
  for (const GnssFix& fix : s.recording.fixes) stage.push(fix);
  for (const GnssHeading& heading : s.recording.headings) stage.push(heading);
  stage.finish(LocalizationStage::kGnssFix);
  stage.finish(LocalizationStage::kGnssHeading);
  for (const ImuSample& sample : s.recording.imu) stage.push(sample);
  stage.finish(LocalizationStage::kImu);
  return result;
}

std::vector<Odometry> smoothedOf(eskf::History& history) {
  history.smooth();
  std::vector<Odometry> odometry;
  for (std::size_t i = 0; i < history.size(); ++i) odometry.push_back(history.odometry(i));
  return odometry;
}

double horizontal(const PoseError& e) { return e.position_m.head<2>().norm(); }
double heading(const PoseError& e) { return e.rotation_rad.z(); }

TEST(EskfFilter, AccurateAndHonestOverTwentySeeds) {
  double position_sq = 0.0, heading_sq = 0.0, position_nees = 0.0, velocity_nees = 0.0, yaw_nees = 0.0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Simulation s = simulate(seed, 45.0);
    const auto all =
        errors(runStage(s.recording, s.drive, eskfParams()).odometry, s.truth, s.recording, s.drive);
    position_sq += std::pow(rms(all, 12.0, 45.0, horizontal), 2) / kSeeds;
    heading_sq += std::pow(rms(all, 12.0, 45.0, heading), 2) / kSeeds;
    position_nees += mean(all, 12.0, 45.0, [](const PoseError& e) { return e.position_nees; }) / kSeeds;
    velocity_nees += mean(all, 12.0, 45.0, [](const PoseError& e) { return e.velocity_nees; }) / kSeeds;
    yaw_nees += mean(all, 12.0, 45.0, [](const PoseError& e) { return e.yaw_nees; }) / kSeeds;
  }
  // The anchor of map is the first fix, here without noise.
  EXPECT_LT(std::sqrt(position_sq), 0.015);
  EXPECT_LT(std::sqrt(heading_sq), 0.3 * kDeg);
  // 95 % of the mean of 20 chi-square variables of 2 (1) degrees of freedom: Bar-Shalom 2001, 5.4.2
  EXPECT_GT(position_nees, 1.22);
  EXPECT_LT(position_nees, 2.97);
  EXPECT_GT(velocity_nees, 0.5);  // the wheels are assumed to slip, the simulated ones do not
  EXPECT_LT(velocity_nees, 2.97);
  EXPECT_GT(yaw_nees, 0.3);
  EXPECT_LT(yaw_nees, 1.71);
}

TEST(EskfFilter, OutageOfFifteenSeconds) {
  double end_sq = 0.0, smoothed_sq = 0.0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Simulation s = simulate(seed, 60.0);
    const auto first = s.recording;
    dropBetween(s.recording.fixes, s.truth.front().stamp, 25.0, 40.0);
    dropBetween(s.recording.headings, s.truth.front().stamp, 25.0, 40.0);
    eskf::History history;
    const auto all = errors(runRecorded(s, history).odometry, s.truth, s.recording, s.drive);
    end_sq += std::pow(rms(all, 39.9, 40.0, horizontal), 2) / 5.0;
    smoothed_sq +=
        std::pow(rms(errors(smoothedOf(history), s.truth, s.recording, s.drive), 25.0, 40.0, horizontal), 2) /
        5.0;
  }
  // White noise of 0.01 m/s^2/sqrt(Hz) alone makes 0.01 sqrt(15^3 / 3) = 0.34 m.
  EXPECT_LT(std::sqrt(end_sq), 0.8);
  EXPECT_LT(std::sqrt(smoothed_sq), 0.15);
}

TEST(EskfFilter, SmoothedIsBetterAndHasEverySample) {
  const Simulation s = simulate(3, 45.0);
  eskf::History history;
  const StageRun run = runRecorded(s, history);
  const auto smoothed = smoothedOf(history);
  ASSERT_EQ(smoothed.size(), run.odometry.size());
  for (std::size_t i = 0; i < smoothed.size(); ++i) ASSERT_EQ(smoothed[i].stamp, run.odometry[i].stamp);
  const auto filtered_errors = errors(run.odometry, s.truth, s.recording, s.drive);
  const auto smoothed_errors = errors(smoothed, s.truth, s.recording, s.drive);
  EXPECT_LT(rms(smoothed_errors, 1.0, 45.0, horizontal), 0.7 * rms(filtered_errors, 1.0, 45.0, horizontal));
  EXPECT_LT(rms(smoothed_errors, 1.0, 45.0, heading), 0.7 * rms(filtered_errors, 1.0, 45.0, heading));
}

TEST(EskfFilter, JumpsAreRejectedAndCounted) {
  Simulation s = simulate(4, 45.0);
  const LocalEnu map(kBrno);
  int jumps = 0;
  for (std::size_t i = 400; i < s.recording.fixes.size(); i += 50, ++jumps) {
    Geodetic& g = s.recording.fixes[i].position;
    g = map.toGeodetic(map.toMap(g) + Eigen::Vector3d(5.0, -3.0, 1.0));
  }
  const StageRun run = runStage(s.recording, s.drive, eskfParams());
  EXPECT_EQ(run.counters.get("skipped fix: outlier"), static_cast<std::uint64_t>(jumps));
  EXPECT_LT(rms(errors(run.odometry, s.truth, s.recording, s.drive), 12.0, 45.0, horizontal), 0.02);
}

TEST(EskfFilter, FixesThatStayElsewhereWinAfterAWhile) {
  Simulation s = simulate(5, 45.0);
  const LocalEnu map(kBrno);
  for (std::size_t i = 400; i < s.recording.fixes.size(); ++i) {  // from 20 s on
    Geodetic& g = s.recording.fixes[i].position;
    g = map.toGeodetic(map.toMap(g) + Eigen::Vector3d(20.0, 0.0, 0.0));
  }
  const StageRun run = runStage(s.recording, s.drive, eskfParams());
  const auto all = errors(run.odometry, s.truth, s.recording, s.drive);
  EXPECT_LT(rms(all, 20.0, 24.0, horizontal), 0.3);  // multipath of seconds does not carry it away
  EXPECT_NEAR(rms(all, 40.0, 45.0, horizontal), 20.0, 0.5);
  EXPECT_GE(run.counters.get("skipped fix: outlier"), 50u);
}

TEST(EskfFilter, GapOfTheImuIsBridgedWithGrownUncertainty) {
  Simulation s = simulate(6, 45.0);
  dropBetween(s.recording.imu, s.truth.front().stamp, 20.0, 22.0);
  dropBetween(s.recording.fixes, s.truth.front().stamp, 19.9, 22.5);
  dropBetween(s.recording.headings, s.truth.front().stamp, 19.9, 22.5);
  const StageRun run = runStage(s.recording, s.drive, eskfParams());
  EXPECT_EQ(run.counters.get("bridged: imu gap"), 1u);
  const auto all = errors(run.odometry, s.truth, s.recording, s.drive);
  EXPECT_LT(mean(all, 22.0, 22.4, [](const PoseError& e) { return e.position_nees; }), 9.2);  // 99 %, 2 dof
  EXPECT_LT(rms(all, 30.0, 45.0, horizontal), 0.02);
}

TEST(EskfFilter, HeadingHoldsAtStandstillWithoutReceiver) {
  std::mt19937 random(7);
  Simulation s;
  s.drive.duration_s = 75.0;
  s.drive.sway_rad = 0.0;
  s.truth = drive(s.drive);
  Errors e = realisticErrors(random);
  e.earth_rotates = true;
  s.recording = record(s.truth, s.drive, e, random);
  dropBetween(s.recording.headings, s.truth.front().stamp, 10.0, 100.0);
  const auto all =
      errors(runStage(s.recording, s.drive, eskfParams()).odometry, s.truth, s.recording, s.drive);
  const double at_loss = mean(all, 9.5, 10.0, heading), at_end = mean(all, 69.5, 70.0, heading);
  EXPECT_LT(std::abs(at_end - at_loss), 0.5 * kDeg);
}

TEST(EskfFilter, SameBitsInAnyOrderOfArrival) {
  const Simulation s = simulate(8, 20.0);
  const StageRun first = runStage(s.recording, s.drive, eskfParams());
  StageRun second;
  LocalizationStage stage(eskfParams());
  listen(stage, second);
  stage.push(s.recording.imu.front().stamp, rigWith(s.drive.lever_arm_imu));
  stage.finish(LocalizationStage::kTfStatic);
  for (const ImuSample& sample : s.recording.imu) stage.push(sample);
  stage.finish(LocalizationStage::kImu);
  for (const GnssHeading& heading : s.recording.headings) stage.push(heading);
  stage.finish(LocalizationStage::kGnssHeading);
  for (const GnssFix& fix : s.recording.fixes) stage.push(fix);
  stage.finish(LocalizationStage::kGnssFix);
  ASSERT_EQ(first.odometry.size(), second.odometry.size());
  for (std::size_t i = 0; i < first.odometry.size(); ++i) {
    ASSERT_EQ(first.odometry[i].T_map_imu.translation, second.odometry[i].T_map_imu.translation) << i;
    ASSERT_EQ(first.odometry[i].T_map_imu.rotation.coeffs(), second.odometry[i].T_map_imu.rotation.coeffs());
    ASSERT_EQ(first.odometry[i].pose_covariance, second.odometry[i].pose_covariance);
  }
}

TEST(EskfFilter, RepeatedFixIsCountedNotUsedTwice) {
  Simulation s = simulate(9, 15.0);
  s.recording.fixes.insert(s.recording.fixes.begin() + 101, s.recording.fixes[100]);
  EXPECT_EQ(runStage(s.recording, s.drive, eskfParams()).counters.get("skipped fix: same stamp"), 1u);
}

TEST(EskfFilter, SmoothedRunIsPlayedBackInTheSecondPass) {
  const Simulation s = simulate(10, 15.0);
  const auto history = std::make_shared<eskf::History>();
  runRecorded(s, *history);
  history->smooth();
  LocalizationParams params = eskfParams();
  params.smoothed = history;
  const StageRun second = runStage(s.recording, s.drive, params);
  ASSERT_EQ(second.odometry.size(), history->size());
  EXPECT_EQ(second.odometry.back().T_map_imu.translation,
            history->odometry(history->size() - 1).T_map_imu.translation);
  ASSERT_TRUE(second.anchor);
}

TEST(EskfFilter, OnlyAFilterWithSmootherRecords) {
  LocalizationStage stage{LocalizationParams{}};
  eskf::History history;
  EXPECT_THROW(stage.record(&history), std::invalid_argument);
}

TEST(EskfFilter, FixesThatErrSlowlyCountMoreButTheirErrorIsReported) {
  Simulation s = simulate(3, 45.0);
  constexpr double kStated_sq = 1.5 * 1.5;  // said of fixes whose noise is 2 cm
  for (GnssFix& fix : s.recording.fixes)
    fix.covariance_enu_m2 = {kStated_sq, 0.0, 0.0, 0.0, kStated_sq, 0.0, 0.0, 0.0, kStated_sq};
  LocalizationStage stage(eskfParams());
  StageRun run;
  listen(stage, run);
  double sigma_m = 0.0;
  stage.on_innovation = [&](const InnovationRecord& record) {
    if (std::string_view(record.source) == "fix") sigma_m = record.sigma.x();
  };
  stage.push(s.recording.imu.front().stamp, rigWith(s.drive.lever_arm_imu));
  stage.finish(LocalizationStage::kTfStatic);
  for (const GnssFix& fix : s.recording.fixes) stage.push(fix);
  stage.finish(LocalizationStage::kGnssFix);
  stage.finish(LocalizationStage::kGnssHeading);
  for (const ImuSample& sample : s.recording.imu) stage.push(sample);
  stage.finish(LocalizationStage::kImu);
  ASSERT_FALSE(run.odometry.empty());
  EXPECT_LT(sigma_m, 0.5);
  EXPECT_GT(std::sqrt(run.odometry.back().pose_covariance[0]), 1.3);
}

}  // namespace
}  // namespace atlas::test
