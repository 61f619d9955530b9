// SPDX-License-Identifier: MIT
// Two GNSS receivers through the whole stage: fallback, return, one jumping, order of arrival.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "atlas/localization/receivers.hpp"
#include "stage_run.hpp"

namespace atlas::test {
namespace {

constexpr double kSigma_m = 2.0, kErrorTime_s = 60.0;  // of the second receiver
constexpr double kFrom_s = 30.0, kTo_s = 60.0;         // the first receiver is away, or jumps

struct TwoReceivers {
  DriveParams drive_params = cityDrive(90.0);
  std::vector<Truth> truth = drive(drive_params);
  Recording recording;
  std::vector<GnssFix> second;
  LocalizationParams params;
  explicit TwoReceivers(unsigned seed = 5) {
    std::mt19937 random(seed);
    recording = record(truth, drive_params, realisticErrors(random), random);
    // A plain receiver at the imu: slow error (Gauss-Markov), 10 Hz, no altitude, no covariance.
    std::normal_distribution<double> n;
    const LocalEnu map(kBrno);
    const Eigen::Vector3d p0 = truth[0].T_map_imu * drive_params.lever_arm_imu;
    Eigen::Vector2d slow = kSigma_m * Eigen::Vector2d(n(random), n(random));
    const double phi = std::exp(-0.1 / kErrorTime_s);
    for (Stamp stamp = truth[0].stamp + kSecond; stamp < truth.back().stamp; stamp += kSecond / 10) {
      slow = phi * slow + std::sqrt(1.0 - phi * phi) * kSigma_m * Eigen::Vector2d(n(random), n(random));
      Eigen::Vector3d p = truthAt(truth, stamp).T_map_imu.translation - p0;
      p.head<2>() += slow;
      GnssFix fix{stamp, map.toGeodetic(p), std::nullopt};
      fix.position.altitude_m = 0.0;
      second.push_back(fix);
    }
    params.filter = "eskf";
    params.receivers.second_receiver = true;
    params.receivers.fallback_after_s = 5.0;
    params.receivers.second_gnss_horizontal_sigma_m = kSigma_m;
    params.receivers.second_gnss_error_time_s = kErrorTime_s;
  }
  [[nodiscard]] bool inside(Stamp stamp) const {
    const double t = toSeconds(stamp - truth.front().stamp);
    return t > kFrom_s && t < kTo_s;
  }
  void loseFirst() {
    auto& fixes = recording.fixes;
    fixes.erase(std::remove_if(fixes.begin(), fixes.end(), [&](const GnssFix& f) { return inside(f.stamp); }),
                fixes.end());
  }
  static void shift(GnssFix& fix, double east_m) {
    fix.position.longitude_deg +=
        east_m / (6.38e6 * std::cos(kBrno.latitude_deg * M_PI / 180.0)) * 180.0 / M_PI;
  }
};

struct ReceiverRun : StageRun {
  std::vector<LocalizationStatus> statuses;
};

/// Pushes the streams in bursts whose order the seed decides; seed 0: one after the other.
ReceiverRun runBoth(const TwoReceivers& s, unsigned seed = 0) {
  ReceiverRun result;
  LocalizationStage stage(s.params);
  listen(stage, result);
  stage.on_status = [&](const LocalizationStatus& status) { result.statuses.push_back(status); };
  const std::size_t inputs = stage.inputs();
  std::array<std::size_t, 5> next{};
  const std::array<std::size_t, 5> size{1, s.recording.fixes.size(), s.recording.headings.size(),
                                        s.recording.imu.size(), s.second.size()};
  std::mt19937 random(seed);
  for (std::size_t i = 0; i < inputs; ++i) {
    if (size[i] == 0) stage.finish(i);
  }
  const auto left = [&](std::size_t i) { return i < inputs && next[i] < size[i]; };
  while (left(0) || left(1) || left(2) || left(3) || left(4)) {
    std::size_t input = 0;
    while (!left(input)) ++input;
    if (seed != 0) input = random() % inputs;
    const std::size_t burst = seed == 0 ? size[input] : 1 + random() % 60;
    for (std::size_t k = 0; k < burst && left(input); ++k) {
      const std::size_t i = next[input]++;
      if (input == 0) stage.push(s.truth.front().stamp, rigWith(s.drive_params.lever_arm_imu));
      if (input == 1) stage.push(s.recording.fixes[i]);
      if (input == 2) stage.push(s.recording.headings[i]);
      if (input == 3) stage.push(s.recording.imu[i]);
      if (input == 4) stage.pushSecond(s.second[i]);
      if (next[input] == size[input]) stage.finish(input);
    }
  }
  EXPECT_TRUE(stage.ended());
  result.counters = stage.counters();
  return result;
}

bool same(const std::vector<Odometry>& a, const std::vector<Odometry>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](const auto& x, const auto& y) {
           return x.stamp == y.stamp && x.T_map_imu.translation == y.T_map_imu.translation &&
                  x.T_map_imu.rotation.coeffs() == y.T_map_imu.rotation.coeffs() &&
                  x.pose_covariance == y.pose_covariance && x.twist_covariance == y.twist_covariance;
         });
}

double worst(const TwoReceivers& s, const ReceiverRun& run, double from_s, double to_s) {
  double largest = 0.0;
  for (const PoseError& e : errors(run.odometry, s.truth, s.recording, s.drive_params)) {
    if (e.time_s >= from_s && e.time_s <= to_s) largest = std::max(largest, e.position_m.head<2>().norm());
  }
  return largest;
}

TEST(TwoReceivers, TheSecondChangesNothingWhileTheFirstIsHealthy) {
  TwoReceivers s;
  const ReceiverRun both = runBoth(s);
  s.params.receivers.second_receiver = false;
  const ReceiverRun one = runBoth(s);
  ASSERT_GT(one.odometry.size(), 8000U);
  EXPECT_TRUE(same(both.odometry, one.odometry));
  EXPECT_EQ(both.counters.get("second fix"), s.second.size());
  EXPECT_EQ(both.counters.get("skipped second fix: the first receiver is in use"), s.second.size());
}

TEST(TwoReceivers, FallsBackAndReturnsAndSaysSo) {
  for (const char* filter : {"eskf", "kalman_1d"}) {
    TwoReceivers s;
    s.loseFirst();
    s.params.filter = filter;
    const ReceiverRun run = runBoth(s);
    EXPECT_EQ(run.counters.get("receiver: fell back to imu/gnss/fix"), 1U) << filter;
    EXPECT_EQ(run.counters.get("receiver: returned to gnss/fix"), 1U) << filter;
    EXPECT_GT(run.counters.get("skipped second fix: sooner than a second after the one before"), 200U);
    std::vector<Receivers::Use> receivers;
    for (const LocalizationStatus& status : run.statuses) {
      if (receivers.empty() || receivers.back() != status.receiver) receivers.push_back(status.receiver);
    }
    using Use = Receivers::Use;
    const std::vector<Use> expected{Use::kPrimary, Use::kSecondary, Use::kPrimary};
    if (receivers.front() == Use::kNone) receivers.erase(receivers.begin());
    EXPECT_EQ(receivers, expected) << filter;
    EXPECT_LT(worst(s, run, kTo_s + 2.0, 90.0), 0.15) << filter;  // centimetres again
  }
}

TEST(TwoReceivers, TheSecondHoldsADriftingFilter) {
  // kalman_1d has no wheels to hold it: 30 s without fixes drift by 0.5 a t^2 with a of some hundredths.
  TwoReceivers s;
  s.loseFirst();
  s.params.filter = "kalman_1d";
  const ReceiverRun with = runBoth(s);
  s.params.receivers.second_receiver = false;
  const ReceiverRun without = runBoth(s);
  EXPECT_LT(worst(s, with, kFrom_s, kTo_s), 0.7 * worst(s, without, kFrom_s, kTo_s));
}

TEST(TwoReceivers, SlowErrorsDoNotMakeTheCovarianceTooSmall) {
  double nees = 0.0;
  constexpr int kRuns = 10;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    TwoReceivers s(seed);
    s.loseFirst();
    const ReceiverRun run = runBoth(s);
    const auto all = errors(run.odometry, s.truth, s.recording, s.drive_params);
    nees += mean(all, kTo_s - 1.0, kTo_s - 0.01, [](const PoseError& e) { return e.position_nees; }) / kRuns;
    EXPECT_EQ(run.counters.get("position re-initialized after outliers"), 0U) << seed;
  }
  EXPECT_LT(nees, 3.416);  // chi-square 20 dof, 97.5 %, over 10 runs
}

TEST(TwoReceivers, AFirstReceiverThatJumpsIsNotFollowed) {
  TwoReceivers s;
  for (GnssFix& fix : s.recording.fixes) {
    if (s.inside(fix.stamp)) TwoReceivers::shift(fix, 60.0);
  }
  const ReceiverRun both = runBoth(s);
  EXPECT_GT(both.counters.get("skipped fix: jumped away from the second receiver and the prediction"), 500U);
  EXPECT_EQ(both.counters.get("receiver: fell back to imu/gnss/fix"), 1U);
  EXPECT_LT(worst(s, both, kFrom_s, kTo_s), 3.0 * kSigma_m);
  s.params.receivers.second_receiver = false;
  const ReceiverRun alone =
      runBoth(s);  // nobody contradicts: after recovery_s the fixes win, and this is said
  EXPECT_GT(worst(s, alone, kFrom_s, kTo_s), 50.0);
  EXPECT_GE(alone.counters.get("position re-initialized after outliers"), 1U);
  EXPECT_GE(alone.counters.get("position jumped by more than 0.5 m"), 1U);
  EXPECT_GT(alone.statuses.back().jumps, 0U);
}

TEST(TwoReceivers, ASecondReceiverThatJumpsIsCountedAndNotUsed) {
  TwoReceivers s;
  const ReceiverRun good = runBoth(s);
  for (GnssFix& fix : s.second) {
    if (s.inside(fix.stamp)) TwoReceivers::shift(fix, 60.0);
  }
  const ReceiverRun run = runBoth(s);
  EXPECT_TRUE(same(run.odometry, good.odometry));
  EXPECT_GE(run.counters.get("second fix: contradicts the position"), 290U);
  EXPECT_EQ(good.counters.get("second fix: contradicts the position"), 0U);
}

TEST(TwoReceivers, ArrivalOrderHasNoInfluence) {
  TwoReceivers s;
  s.loseFirst();
  const ReceiverRun reference = runBoth(s);
  ASSERT_GT(reference.odometry.size(), 8000U);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const ReceiverRun shuffled = runBoth(s, seed);
    EXPECT_TRUE(same(shuffled.odometry, reference.odometry)) << seed;
    EXPECT_EQ(shuffled.counters.all(), reference.counters.all()) << seed;
    ASSERT_EQ(shuffled.statuses.size(), reference.statuses.size());
    for (std::size_t i = 0; i < reference.statuses.size(); ++i)
      ASSERT_EQ(shuffled.statuses[i].stamp, reference.statuses[i].stamp);
  }
}

TEST(TwoReceivers, TheSecondAloneIsEnough) {
  TwoReceivers s;
  s.recording.fixes.clear();
  const ReceiverRun run = runBoth(s);
  EXPECT_EQ(run.counters.get("anchor by the second receiver, altitude unknown"), 1U);
  EXPECT_GT(run.odometry.size(), 3000U);
  ASSERT_TRUE(run.anchor);
  EXPECT_EQ(run.statuses.back().receiver, Receivers::Use::kSecondary);
}

TEST(TwoReceivers, BadFixesOfTheSecondAreCountedUnderTheirReason) {
  TwoReceivers s;
  s.second[10].position.latitude_deg = std::nan("");
  s.second[20].position.latitude_deg = 91.0;
  s.second[30].position = {0.0, 0.0, 0.0};
  s.second[40].position = s.second[39].position;
  s.second[50].stamp = s.second[5].stamp;
  const ReceiverRun run = runBoth(s);
  EXPECT_EQ(run.counters.get("skipped second fix: not finite"), 1U);
  EXPECT_EQ(run.counters.get("skipped second fix: unexpected layout"), 1U);
  EXPECT_EQ(run.counters.get("skipped second fix: latitude and longitude exactly 0"), 1U);
  EXPECT_EQ(run.counters.get("skipped second fix: the same position as before"), 1U);
  EXPECT_EQ(run.counters.get("skipped imu/gnss/fix: late"), 1U);
}

TEST(TwoReceivers, WrongParametersAreNamed) {
  LocalizationParams params;
  params.receivers.fallback_after_s = 0.0;
  try {
    validate(params);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("fallback_after_s"), std::string::npos);
  }
}

}  // namespace
}  // namespace atlas::test
