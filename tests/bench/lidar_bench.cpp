// SPDX-License-Identifier: MIT
// Speed of the de-skew and of the thinning, beside what others use for it, in one run. All clouds have 100
// 000 points. `rms_m` is the error against the exact pose at each point's time.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "atlas/lidar/batched_points.hpp"
#include "atlas/lidar/batching.hpp"
#include "atlas/lidar/per_point.hpp"
#include "atlas/lidar/voxel.hpp"

#ifdef ATLAS_BENCH_PCL
#include <pcl/filters/voxel_grid.h>
#include <pcl/point_types.h>
#endif

namespace {

using namespace atlas;

constexpr int kPoints = 100'000;
constexpr Stamp kStart = 1'500'000'000'000'000'000;
constexpr Stamp kSweepEnd = kStart + 200 * kMillisecond;

enum Layout : int {
  kStampPerColumn,  ///< 32 points share a time, as of an HDL-32E
  kStampPerPoint,   ///< each point has its own
  kLaserByLaser     ///< 64 lasers one after the other, as KITTI stores them
};

/// A street of 10 to 40 m seen by beams from -30 to 10 degrees, 0.1 s.
SweepPtr sweep(int layout) {
  auto result = std::make_shared<Sweep>();
  result->stamp = kSweepEnd;
  result->points.resize(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    LidarPoint& point = result->points[static_cast<std::size_t>(i)];
    const int lasers = kPoints / 64, ring = layout == kLaserByLaser ? i / lasers % 64 : i % 32;
    const double place = layout == kStampPerColumn  ? i / 32 * 32.0
                         : layout == kStampPerPoint ? i
                                                    : i % lasers * 64.0;
    const double azimuth = -2.0 * M_PI * place / kPoints;
    const double elevation = (-30.0 + 40.0 * ring / (layout == kLaserByLaser ? 64 : 32)) * M_PI / 180.0;
    const double ground_m = elevation < -0.01 ? 1.8 / std::sin(-elevation) : 1e9;
    const double range_m = std::min(ground_m, (25.0 + 15.0 * std::sin(7.0 * azimuth)) / std::cos(elevation));
    point.x = static_cast<float>(range_m * std::cos(elevation) * std::cos(azimuth));
    point.y = static_cast<float>(range_m * std::cos(elevation) * std::sin(azimuth));
    point.z = static_cast<float>(range_m * std::sin(elevation));
    point.ring = static_cast<std::uint16_t>(ring);
    point.time = static_cast<float>(0.1 * place / kPoints - 0.1);
  }
  return result;
}

/// A car at 10 m/s in a turn of 0.5 rad/s, T_map_imu.
Pose arc(double t_s) {
  const double yaw = 0.5 * t_s;
  return {fromRollPitchYaw({0.01, 0.02, yaw}),
          Eigen::Vector3d(20.0 * std::sin(yaw), 20.0 * (1.0 - std::cos(yaw)), 0.0)};
}
Trajectory trajectory() {  // at 400 Hz
  Trajectory result;
  for (int i = 0; i < 200; ++i) result.push({kStart + fromSeconds(i / 400.0), arc(i / 400.0)});
  return result;
}
const Pose kT_imu_lidar{fromRollPitchYaw({0.1, 0.0, 3.1}), Eigen::Vector3d(0.17, 0.48, 0.15)};

double rmsError(const Sweep& in, const std::vector<LidarPoint>& out) {
  const Pose T_stamp_map = (arc(toSeconds(in.stamp - kStart)) * kT_imu_lidar).inverse();
  double sum = 0.0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double t_s = toSeconds(in.stamp - kStart) + static_cast<double>(in.points[i].time);
    const Eigen::Vector3d truth = T_stamp_map * (arc(t_s) * kT_imu_lidar) *
                                  Eigen::Vector3d(in.points[i].x, in.points[i].y, in.points[i].z);
    sum += (truth - Eigen::Vector3d(out[i].x, out[i].y, out[i].z)).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(out.size()));
}

void countPoints(benchmark::State& state) {
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * kPoints);
}

/// Argument: layout. What the de-skew stage does with batches_per_sweep 0.
void deskewEachPoint(benchmark::State& state) {
  const SweepPtr points = sweep(static_cast<int>(state.range(0)));
  const Trajectory poses = trajectory();
  for (auto _ : state) {
    const auto result = deskewPerPoint(points, *spanOf(*points), poses, kT_imu_lidar);
    benchmark::DoNotOptimize(result->sweep->points.data());
  }
  state.counters["rms_m"] =
      rmsError(*points, deskewPerPoint(points, *spanOf(*points), poses, kT_imu_lidar)->sweep->points);
  countPoints(state);
}
BENCHMARK(deskewEachPoint)
    ->Arg(kStampPerColumn)
    ->Arg(kStampPerPoint)
    ->Arg(kLaserByLaser)
    ->Unit(benchmark::kMicrosecond);

/// Arguments: batches, layout. Cut into batches and transformed, once.
void deskewInBatches(benchmark::State& state) {
  const SweepPtr points = sweep(static_cast<int>(state.range(1)));
  const Trajectory poses = trajectory();
  const int batches = static_cast<int>(state.range(0));
  for (auto _ : state) {
    const auto batched = cutIntoBatches(points, *spanOf(*points), batches, poses, kT_imu_lidar);
    benchmark::DoNotOptimize(deskewed(*batched).points.data());
  }
  state.counters["rms_m"] = rmsError(
      *points, deskewed(*cutIntoBatches(points, *spanOf(*points), batches, poses, kT_imu_lidar)).points);
  countPoints(state);
}
BENCHMARK(deskewInBatches)
    ->Args({100, kStampPerColumn})
    ->Args({1000, kStampPerColumn})
    ->Args({1000, kStampPerPoint})
    ->Unit(benchmark::kMicrosecond);

/// KISS-ICP (Vizzo et al. 2023, section III-A): constant velocity from the last two poses, and for each point
/// the exponential of its share of it: rotation and translation by the point's place in the sweep.
void deskewAsKissIcp(benchmark::State& state) {
  const SweepPtr points = sweep(kStampPerPoint);
  const double end_s = toSeconds(kSweepEnd - kStart);
  const Pose step = (arc(end_s - 0.2) * kT_imu_lidar).inverse() * (arc(end_s - 0.1) * kT_imu_lidar);
  const Eigen::Vector3d omega = logSo3(step.rotation), velocity = step.translation;
  std::vector<LidarPoint> moved;
  for (auto _ : state) {
    moved = points->points;
    for (LidarPoint& p : moved) {
      const double part = static_cast<double>(p.time) / 0.1;  // of the sweep, relative to the stamp
      const Eigen::Vector3d q = expSo3(part * omega) * Eigen::Vector3d(p.x, p.y, p.z) + part * velocity;
      p.x = static_cast<float>(q.x());
      p.y = static_cast<float>(q.y());
      p.z = static_cast<float>(q.z());
    }
    benchmark::DoNotOptimize(moved.data());
  }
  state.counters["rms_m"] = rmsError(*points, moved);
  countPoints(state);
}
BENCHMARK(deskewAsKissIcp)->Unit(benchmark::kMicrosecond);

/// Argument: leaf in cm.
void thinning(benchmark::State& state) {
  const SweepPtr points = sweep(kStampPerColumn);
  const double leaf_m = static_cast<double>(state.range(0)) / 100.0;
  std::size_t left = 0;
  for (auto _ : state) left = voxelFiltered(points->points, leaf_m).size();
  state.counters["left"] = static_cast<double>(left);
  countPoints(state);
}
BENCHMARK(thinning)->Arg(20)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);

/// The same with the centroid of each voxel, which is what PCL computes.
void thinningToCentroids(benchmark::State& state) {
  const SweepPtr points = sweep(kStampPerColumn);
  const double leaf_m = static_cast<double>(state.range(0)) / 100.0;
  std::size_t left = 0;
  for (auto _ : state) left = voxelFiltered(points->points, leaf_m, VoxelPoint::kCentroid).size();
  state.counters["left"] = static_cast<double>(left);
  countPoints(state);
}
BENCHMARK(thinningToCentroids)->Arg(20)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);

#ifdef ATLAS_BENCH_PCL
void thinningByPcl(benchmark::State& state) {
  const auto cloud = pcl::PointCloud<pcl::PointXYZI>::Ptr(new pcl::PointCloud<pcl::PointXYZI>);
  const SweepPtr points = sweep(kStampPerColumn);
  for (const LidarPoint& p : points->points) {
    pcl::PointXYZI point;
    point.x = p.x;
    point.y = p.y;
    point.z = p.z;
    point.intensity = p.intensity;
    cloud->push_back(point);
  }
  const float leaf_m = static_cast<float>(state.range(0)) / 100.0F;
  pcl::PointCloud<pcl::PointXYZI> thinned;
  for (auto _ : state) {
    pcl::VoxelGrid<pcl::PointXYZI> grid;
    grid.setInputCloud(cloud);
    grid.setLeafSize(leaf_m, leaf_m, leaf_m);
    grid.filter(thinned);
  }
  state.counters["left"] = static_cast<double>(thinned.size());
  countPoints(state);
}
BENCHMARK(thinningByPcl)->Arg(20)->Arg(50)->Arg(100)->Unit(benchmark::kMicrosecond);
#endif

}  // namespace
