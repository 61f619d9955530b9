// SPDX-License-Identifier: MIT
// Cost of the positioning filters per IMU sample, updates included: 100 Hz IMU, 20 Hz fixes and headings.
#include <benchmark/benchmark.h>

#include <cmath>

#include "atlas/localization/positioning_filter.hpp"

namespace {

using namespace atlas;

/// Circles of 20 m at 8 m/s: every measurement passes the gates.
void runFilter(benchmark::State& state, const char* name) {
  constexpr double kSpeed_mps = 8.0, kRate_radps = 0.4, kRadius_m = kSpeed_mps / kRate_radps;
  const Geodetic anchor{49.2, 16.6, 280.0};
  const double gravity = normalGravity(anchor.latitude_deg, anchor.altitude_m);
  Counters counters;
  PositioningParams params;
  params.imu_to_rear_axle_m = 0.0;
  const auto filter = makePositioningFilter(name, params, Eigen::Vector3d::Zero(), anchor, counters);
  ImuSample sample;
  sample.angular_velocity_radps = {0.0, 0.0, kRate_radps};
  sample.linear_acceleration_mps2 = {0.0, kSpeed_mps * kRate_radps, gravity};
  Stamp stamp = kSecond;
  int k = 0;
  for (auto _ : state) {
    const double angle = kRate_radps * toSeconds(stamp - kSecond);
    if (k++ % 5 == 0) {
      filter->update(stamp, {kRadius_m * std::sin(angle), kRadius_m * (1.0 - std::cos(angle)), 0.0},
                     4e-4 * Eigen::Matrix3d::Identity());
      filter->updateHeading(stamp, std::remainder(angle, 2.0 * M_PI), 2.7e-3);
    }
    sample.stamp = stamp;
    benchmark::DoNotOptimize(filter->propagate(sample));
    stamp += 10 * kMillisecond;
  }
  state.counters["skipped"] = static_cast<double>(counters.get("skipped fix: outlier"));
}

void BM_Eskf(benchmark::State& state) { runFilter(state, "eskf"); }
void BM_Kalman1d(benchmark::State& state) { runFilter(state, "kalman_1d"); }
BENCHMARK(BM_Eskf);
BENCHMARK(BM_Kalman1d);

}  // namespace
