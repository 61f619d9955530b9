// SPDX-License-Identifier: MIT
// Speed of the sensor monitor: what one message of each kind costs, at the sizes of the Brno Urban Dataset.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "atlas/monitor/monitor_stage.hpp"

namespace {

using namespace atlas;

void picture(benchmark::State& state, int width, int height, int type) {
  std::mt19937 random(1);
  Image image;
  image.pixels = cv::Mat(height, width, type);
  for (int y = 0; y < height; ++y) {
    auto* row = image.pixels.ptr<std::uint8_t>(y);
    for (int x = 0; x < width * image.pixels.channels(); ++x)
      row[x] = static_cast<std::uint8_t>(120 + 80 * std::sin(0.05 * x) + static_cast<double>(random() % 9));
  }
  CameraCheck check;
  Findings findings{AnomalyThresholds()};
  const MotionWitness motion;
  for (auto _ : state) {
    image.stamp += 100 * kMillisecond;
    check.add(image, motion, findings);
    benchmark::DoNotOptimize(findings.score());
  }
}
void BM_PictureRgb(benchmark::State& state) { picture(state, 1920, 1200, CV_8UC3); }
void BM_PictureThermal(benchmark::State& state) { picture(state, 640, 512, CV_8UC1); }

void BM_Sweep(benchmark::State& state) {
  auto sweep = std::make_shared<Sweep>();
  sweep->frame = "lidar_left";
  for (int i = 0; i < 70000; ++i) {
    const double azimuth = 2.0 * M_PI * i / 70000, elevation = (-30.67 + 1.33 * (i % 32)) * M_PI / 180.0;
    LidarPoint p;
    p.ring = static_cast<std::uint16_t>(i % 32);
    p.x = static_cast<float>(20.0 * std::cos(elevation) * std::cos(azimuth));
    p.y = static_cast<float>(20.0 * std::cos(elevation) * std::sin(azimuth));
    p.z = static_cast<float>(20.0 * std::sin(elevation));
    sweep->points.push_back(p);
  }
  LidarCheck check({});
  Findings findings{AnomalyThresholds()};
  for (auto _ : state) {
    RangeProfile profile;
    sweep->stamp += 100 * kMillisecond;
    check.add(sweep->stamp,
              summaryOf(*sweep,
                        [&](const LidarPoint& p) {
                          profile.add({p.x, p.y, p.z});
                        }),
              findings);
    benchmark::DoNotOptimize(profile);
  }
}

/// With the merging of all inputs; the other inputs have ended.
void BM_ImuSample(benchmark::State& state) {
  MonitorStage stage{MonitorParams()};
  for (std::size_t i = 0; i < stage.inputs(); ++i) {
    if (i != MonitorStage::kImu) stage.finish(i);
  }
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0.0, 0.1);
  ImuSample sample;
  for (auto _ : state) {
    sample.stamp += 2'500'000;
    sample.linear_acceleration_mps2 = {noise(random), 0.0, 9.81};
    sample.angular_velocity_radps = {0.01, noise(random), 0.0};
    stage.push(sample);
  }
}

BENCHMARK(BM_PictureRgb)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_PictureThermal)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_Sweep)->Unit(benchmark::kMicrosecond);
BENCHMARK(BM_ImuSample)->Unit(benchmark::kMicrosecond);

}  // namespace
