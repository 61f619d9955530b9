// SPDX-License-Identifier: MIT
// Stereo on one core: matching by each method and the u-disparity grid, at the size of the Lexus' camera
// (512x320, 64 disparities) and at that of KITTI's (1242x375, 128), on a random road with things. With
// ATLAS_DATA the first pair of KITTI stereo 2015 instead of the larger road. least_ms is the CPU time of the
// quickest pass: on a machine that others use too, it says more than the mean.
#include <benchmark/benchmark.h>

#include <ctime>
#include <opencv2/core/utility.hpp>

#include "../unit/stereo/recorded_pairs.hpp"
#include "../unit/stereo/scene.hpp"
#include "atlas/stereo/opencv_matcher.hpp"
#include "atlas/stereo/stereo_ground.hpp"
#include "atlas/stereo/stereo_matcher.hpp"

namespace {

using namespace atlas;

double cpuMs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// Runs `pass` as often as the benchmark wants.
template <class Pass>
void measure(benchmark::State& state, const Pass& pass) {
  double least_ms = 1e9;
  for (auto _ : state) {
    const double begin_ms = cpuMs();
    pass();
    least_ms = std::min(least_ms, cpuMs() - begin_ms);
  }
  state.counters["least_ms"] = least_ms;
}

struct Input {
  StereoRig rig;
  int range_px = 64;
  cv::Mat left, right;
};

Input lexus() {
  const test::StereoScene scene = test::roadScene();
  return {test::lexusRig(), 64, scene.left, scene.right};
}

/// The first pair of KITTI 2015, else a road of that size.
Input kitti() {
  const auto pairs = test::kitti2015Pairs();
  if (!pairs.empty()) return {pairs.front().rig, 128, pairs.front().left, pairs.front().right};
  const test::StereoScene scene = test::render(
      {1242, 375}, [](int v) { return std::max(1.0, 0.323 * (v - 172.9)); }, {{{500, 150, 200, 120}, 30.0}});
  return {test::recorded::kittiRig({1242, 375}), 128, scene.left, scene.right};
}

void match(benchmark::State& state, const Input& input, const char* aggregation) {
  cv::setNumThreads(1);
  StereoParams params;
  params.aggregation = aggregation;
  params.range_px = input.range_px;
  StereoMatcher matcher(input.rig, params);
  matcher.match(input.left, input.right);  // the road is known then, as in a drive
  measure(state, [&] { benchmark::DoNotOptimize(matcher.match(input.left, input.right)); });
}

void matchOpencv(benchmark::State& state, const Input& input, const cv::Ptr<cv::StereoMatcher>& matcher) {
  cv::setNumThreads(1);
  cv::Mat disparity;
  measure(state, [&] { matcher->compute(input.left, input.right, disparity); });
}

void uDisparity(benchmark::State& state, const Input& input) {
  StereoParams params;
  params.range_px = input.range_px;
  const DisparityImage image = StereoMatcher(input.rig, params).match(input.left, input.right);
  UDisparity u_disparity(input.rig, input.range_px, {});
  measure(state, [&] { benchmark::DoNotOptimize(&u_disparity.compute(image)); });
}

void ground(benchmark::State& state, const Input& input) {
  StereoParams params;
  params.range_px = input.range_px;
  const DisparityImage image = StereoMatcher(input.rig, params).match(input.left, input.right);
  UDisparity u_disparity(input.rig, input.range_px, {});
  const UDisparityGrid& grid = u_disparity.compute(image);
  StereoGround cells(input.rig, input.range_px, {}, {0.0, -20.0, 0.2, 200, 200});
  measure(state, [&] { benchmark::DoNotOptimize(&cells.fill(grid)); });
}

BENCHMARK_CAPTURE(match, lexus_double_correlation_paths, lexus(), "paths")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(match, lexus_double_correlation_window, lexus(), "window")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(matchOpencv, lexus_sgbm, lexus(), opencvSgbm(64))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(matchOpencv, lexus_bm, lexus(), opencvBm(64))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(uDisparity, lexus, lexus())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ground, lexus, lexus())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(match, kitti_double_correlation_paths, kitti(), "paths")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(match, kitti_double_correlation_window, kitti(), "window")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(matchOpencv, kitti_sgbm, kitti(), opencvSgbm(128))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(matchOpencv, kitti_bm, kitti(), opencvBm(128))->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(uDisparity, kitti, kitti())->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ground, kitti, kitti())->Unit(benchmark::kMillisecond);

}  // namespace
