// SPDX-License-Identifier: MIT
// Input that is not as it should be, through the whole stage: counted, bridged or refused, and the position
// never jumps without a word.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "atlas/localization/localization_status.hpp"
#include "stage_run.hpp"

namespace atlas::test {
namespace {

struct Drive {
  DriveParams params = cityDrive(40.0);
  std::vector<Truth> truth;
  Recording recording;
  LocalizationParams localization;
  explicit Drive(double sway_rad = 0.02) {
    params.sway_rad = sway_rad;
    truth = drive(params);
    std::mt19937 random(11);
    recording = record(truth, params, realisticErrors(random), random);
    localization.filter = "eskf";
  }
  [[nodiscard]] std::size_t sampleAt(double time_s) const {
    return static_cast<std::size_t>(time_s * params.imu_rate_hz);
  }
  StageRun run() const { return runStage(recording, params, localization); }
  [[nodiscard]] double worst(const StageRun& run, double from_s, double to_s) const {
    double largest = 0.0;
    for (const PoseError& e : errors(run.odometry, truth, recording, params)) {
      if (e.time_s >= from_s && e.time_s <= to_s) largest = std::max(largest, e.position_m.norm());
    }
    return largest;
  }
};

double uncertainty(const StageRun& run, Stamp stamp) {
  const Odometry* found = nullptr;
  for (const Odometry& o : run.odometry) {
    if (o.stamp <= stamp) found = &o;
  }
  return std::sqrt(found->twist_covariance[0] + found->twist_covariance[7] + found->twist_covariance[14]);
}

TEST(BadInput, ABlowBeyondTheRangeIsBridgedAndTheFixesGoOn) {
  Drive d;
  const std::size_t at = d.sampleAt(20.0);
  // Up with 90 m/s^2 for 0.04 s and back again: the IMU ends at 4 g. What is clipped is 2 m/s.
  for (std::size_t i = 0; i < 8; ++i) {
    double& z = d.recording.imu[at + i].linear_acceleration_mps2.z();
    z = std::clamp(9.81 + (i < 4 ? 90.0 : -90.0), -39.2, 39.2);
  }
  const StageRun run = d.run();
  EXPECT_EQ(run.counters.get("skipped imu: accelerometer saturated"), 6U);  // the range is learned from two
  EXPECT_EQ(run.counters.get("skipped fix: outlier"), 0U);
  EXPECT_GT(uncertainty(run, d.truth[at + 9].stamp), 10.0 * uncertainty(run, d.truth[at - 9].stamp));
  EXPECT_LT(d.worst(run, 22.0, 37.0), 0.15);
}

TEST(BadInput, AFrozenImuIsAGapWithGrowingUncertainty) {
  Drive d;
  const std::size_t at = d.sampleAt(20.0);
  for (std::size_t i = at + 1; i <= at + 100; ++i) {
    d.recording.imu[i].angular_velocity_radps = d.recording.imu[at].angular_velocity_radps;
    d.recording.imu[i].linear_acceleration_mps2 = d.recording.imu[at].linear_acceleration_mps2;
  }
  const StageRun run = d.run();
  EXPECT_EQ(run.counters.get("skipped imu: frozen, the same values again and again"), 81U);
  EXPECT_GT(uncertainty(run, d.truth[at + 19].stamp + kSecond), 2.0 * uncertainty(run, d.truth[at].stamp));
  EXPECT_LT(d.worst(run, 23.0, 37.0), 0.15);
}

TEST(BadInput, AGapOfTheImuIsCountedAndTheUncertaintyGrows) {
  Drive d;
  const std::size_t at = d.sampleAt(20.0);
  const double before = uncertainty(d.run(), d.truth[at + 30].stamp);
  const auto first = d.recording.imu.begin() + static_cast<std::ptrdiff_t>(at);
  d.recording.imu.erase(first, first + 30);
  const StageRun run = d.run();
  EXPECT_EQ(run.counters.get("imu gaps"), 1U);
  EXPECT_EQ(run.counters.get("imu gaps, ms altogether"), 310U);
  EXPECT_GT(uncertainty(run, d.truth[at + 30].stamp), 2.0 * before);
  EXPECT_LT(d.worst(run, 22.0, 37.0), 0.15);
}

TEST(BadInput, WrongUnitsEndTheRunInWords) {
  Drive g, degrees;
  for (ImuSample& s : g.recording.imu) s.linear_acceleration_mps2 /= 9.81;
  for (ImuSample& s : degrees.recording.imu) s.angular_velocity_radps *= 180.0 / M_PI;
  const auto refusal = [](const Drive& d) -> std::string {
    try {
      d.run();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(refusal(g).find("in g; m/s^2 is needed"), std::string::npos) << refusal(g);
  EXPECT_NE(refusal(degrees).find("in degrees?"), std::string::npos) << refusal(degrees);
}

TEST(BadInput, MultipathOfSecondsIsGatedAndNotFollowed) {
  Drive d;
  for (GnssFix& fix : d.recording.fixes) {
    const double t = toSeconds(fix.stamp - d.truth.front().stamp);
    if (t > 20.0 && t < 21.5) fix.position.latitude_deg += 4.0 / 111e3;
  }
  const StageRun run = d.run();
  EXPECT_GT(run.counters.get("skipped fix: outlier"), 20U);
  EXPECT_EQ(run.counters.get("position jumped by more than 0.5 m"), 0U);
  EXPECT_LT(d.worst(run, 20.0, 37.0), 0.3);
}

TEST(BadInput, NoFixAtAllGivesNoPoseAndSaysSo) {
  Drive d;
  d.recording.fixes.clear();
  std::vector<LocalizationStatus> statuses;
  LocalizationStage stage(d.localization);
  stage.on_status = [&](const LocalizationStatus& status) { statuses.push_back(status); };
  for (const auto input :
       {LocalizationStage::kTfStatic, LocalizationStage::kGnssFix, LocalizationStage::kGnssHeading})
    stage.finish(input);
  for (const ImuSample& sample : d.recording.imu) stage.push(sample);
  stage.finish(LocalizationStage::kImu);
  EXPECT_EQ(stage.counters().get("skipped odometry: no pose yet"), d.recording.imu.size());
  ASSERT_GE(statuses.size(), 40U);
  for (const LocalizationStatus& status : statuses) {
    EXPECT_EQ(status.state, LocalizationStatus::State::kAligning);
    EXPECT_FALSE(status.fix_age_s);
  }
}

TEST(BadInput, AReceiverWithoutPositionIsNoAnchor) {
  Drive d;
  d.recording.fixes[0].position = {0.0, 0.0, 0.0};
  const StageRun run = d.run();
  ASSERT_TRUE(run.anchor);
  EXPECT_EQ(run.anchor->position.latitude_deg, d.recording.fixes[1].position.latitude_deg);
  EXPECT_EQ(run.counters.get("skipped fix: latitude and longitude exactly 0"), 1U);
}

TEST(LocalizationStatus, TellsStateStandingBiasAndInnovations) {
  Drive d(0.0);  // a vehicle that sways does not stand
  auto& fixes = d.recording.fixes;
  fixes.erase(std::remove_if(fixes.begin(), fixes.end(),
                             [&](const GnssFix& f) {
                               const double t = toSeconds(f.stamp - d.truth.front().stamp);
                               return t > 15.0 && t < 25.0;
                             }),
              fixes.end());
  std::vector<LocalizationStatus> statuses;
  LocalizationStage stage(d.localization);
  stage.on_status = [&](const LocalizationStatus& status) { statuses.push_back(status); };
  stage.push(d.truth.front().stamp, rigWith(d.params.lever_arm_imu));
  for (const GnssFix& fix : fixes) stage.push(fix);
  for (const GnssHeading& heading : d.recording.headings) stage.push(heading);
  for (const ImuSample& sample : d.recording.imu) stage.push(sample);
  for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
  using State = LocalizationStatus::State;
  for (const LocalizationStatus& status : statuses) {
    const double t = toSeconds(status.stamp - d.truth.front().stamp);
    if (t > 5.0) {
      EXPECT_EQ(status.state, t > 16.95 && t < 25.001 ? State::kCoasting : State::kRunning) << t;
    }
    if (t > 18.0 && t < 25.0) {
      EXPECT_NEAR(*status.fix_age_s, t - 15.0, 0.06);
    }
    if (t > 6.0 && t < 34.0) {
      EXPECT_FALSE(status.standing) << t;
    }
    if (t > 38.5) {
      EXPECT_TRUE(status.standing) << t;
    }
    EXPECT_EQ(status.jumps, 0U);
  }
  const LocalizationStatus& last = statuses.back();
  ASSERT_TRUE(last.bias);
  EXPECT_GT(last.bias->gyro_sigma_radps.minCoeff(), 0.0);
  const auto of = [&](const std::string& source) {
    for (const InnovationStatistics& s : last.innovations) {
      if (s.source == source) return s;
    }
    return InnovationStatistics{};
  };
  EXPECT_EQ(of("fix").rows, 3);
  // The mean of n values of chi-square with 3 degrees of freedom: 3 within 4 sqrt(6 / n).
  EXPECT_NEAR(of("fix").mean_nis, 3.0, 4.0 * std::sqrt(6.0 / static_cast<double>(of("fix").used)));
  EXPECT_LE(of("fix").used + of("fix").rejected,
            stage.counters().get("fix"));  // those of the start are not compared
  EXPECT_GT(of("fix").used, fixes.size() - 20);
  EXPECT_GT(of("standing").used, 5U);
  EXPECT_GT(of("wheels").used, 50U);
}

}  // namespace
}  // namespace atlas::test
