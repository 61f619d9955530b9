// SPDX-License-Identifier: MIT
#include "atlas/monitor/timing_check.hpp"

#include <random>

#include "atlas/monitor/clock_check.hpp"
#include "watched.hpp"

namespace atlas {
namespace {

using test::at;
using test::expectClean;
using test::expectSeen;

struct Timed {
  TimingCheck check;
  Findings findings{AnomalyThresholds()};
  double time_s = 0.0;
  /// `count` messages with a period and uniform jitter.
  void run(int count, double period_s, double jitter_s = 0.0) {
    std::uniform_real_distribution<double> jitter(-jitter_s, jitter_s);
    for (int i = 0; i < count; ++i) {
      check.add(at(time_s + jitter(random)), findings);
      time_s += period_s;
      check.tick(at(time_s - 0.5 * period_s), at(0), findings);
    }
  }
  std::mt19937 random{1};
};

// The jitter of the real thermal camera (16 .. 45 ms at 33 ms) and receiver (24 .. 62 ms at 50 ms).
TEST(TimingCheck, JitterOfRealSensorsIsNoAnomaly) {
  Timed receiver, thermal, imu;
  receiver.run(600, 0.05, 0.006);
  thermal.run(900, 0.0333, 0.006);
  imu.run(12000, 0.0025);
  expectClean(receiver.findings);
  expectClean(thermal.findings);
  expectClean(imu.findings);
}

TEST(TimingCheck, OneLostFrameIsAGap) {
  Timed t;
  t.run(30, 0.1);
  t.time_s += 0.1;
  t.run(1, 0.1);
  expectSeen(t.findings, Anomaly::kGap, 3.0, 0.1);
  EXPECT_FALSE(t.findings.has(Anomaly::kMissing));
}

TEST(TimingCheck, SilenceIsMissingAfterHalfASecond) {
  Timed t;
  t.run(100, 0.01);
  for (double now_s = 1.0; now_s < 2.0; now_s += 0.1) t.check.tick(at(now_s), at(0), t.findings);
  expectSeen(t.findings, Anomaly::kMissing, 1.0, 0.6);
  EXPECT_DOUBLE_EQ(t.findings.score(), 0.0);
  t.time_s = 2.5;
  t.run(150, 0.01);
  EXPECT_FALSE(t.findings.has(Anomaly::kMissing)) << "it came back";
}

TEST(TimingCheck, SlowSensorsMayBeSilentForFivePeriods) {
  Timed t;
  t.run(30, 1.0);
  t.check.tick(at(29.0 + 4.9), at(0), t.findings);
  EXPECT_FALSE(t.findings.has(Anomaly::kMissing));
  t.check.tick(at(29.0 + 5.1), at(0), t.findings);
  EXPECT_TRUE(t.findings.has(Anomaly::kMissing));
}

TEST(TimingCheck, ARequiredSensorThatNeverComesIsMissing) {
  TimingCheck check;
  Findings findings{AnomalyThresholds()};
  check.tick(at(0.4), at(0), findings);
  EXPECT_FALSE(findings.has(Anomaly::kMissing));
  check.tick(at(0.6), at(0), findings);
  EXPECT_TRUE(findings.has(Anomaly::kMissing));
}

TEST(TimingCheck, TheSameStampTwiceIsADuplicate) {
  Timed t;
  t.run(30, 0.1);
  t.check.add(at(2.9), t.findings);
  expectSeen(t.findings, Anomaly::kDuplicate, 2.9, 0.0);
}

TEST(TimingCheck, HalfTheRateIsSeenWithinFiveSeconds) {
  Timed t;
  t.run(200, 0.02);  // 4 s
  t.run(250, 0.03);
  expectSeen(t.findings, Anomaly::kRate, 4.0, 5.0 + 4.0);
}

TimeReference reference(double time_s, double delay_s) { return {at(time_s), at(time_s - delay_s), "clock"}; }

TEST(ClockCheck, DelayThatVariesIsNoDrift) {
  ClockCheck check;
  Findings findings{AnomalyThresholds()};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> delay(0.0007, 0.0107);  // the real receiver's
  for (int i = 0; i < 1200; ++i) check.add(reference(0.05 * i, delay(random)), findings);
  expectClean(findings);
}

TEST(ClockCheck, DriftOfHalfAPromilleIsSeenAfterItsTwentyMilliseconds) {
  ClockCheck check;
  Findings findings{AnomalyThresholds()};
  std::mt19937 random(3);
  std::uniform_real_distribution<double> delay(0.0007, 0.0107);
  for (int i = 0; i < 1600; ++i) {
    const double time_s = 0.05 * i;
    check.add(reference(time_s, delay(random) + std::max(0.0, time_s - 10.0) * 5e-4), findings);
  }
  expectSeen(findings, Anomaly::kClockDrift, 10.0 + 40.0, 3.0);  // 20 ms / 0.5 ms/s, plus windows and jitter
}

TEST(ClockCheck, AStepOfASecondIsAJumpAtOnce) {
  ClockCheck check;
  Findings findings{AnomalyThresholds()};
  for (int i = 0; i < 50; ++i) check.add(reference(0.1 * i, i == 40 ? 1.0005 : 0.0005), findings);
  expectSeen(findings, Anomaly::kClockJump, 4.0, 0.0);
  EXPECT_FALSE(findings.has(Anomaly::kClockDrift)) << "the smallest delay did not change";
}

}  // namespace
}  // namespace atlas
