// SPDX-License-Identifier: MIT
// Depth images of real recordings against ground truth that was not made from the same points
// alone: the KITTI stereo 2015 and depth benchmarks. The figures are printed; tests/bench/BENCHMARK.md has
// them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/core.hpp>

#include "atlas/camera/depth_buffer.hpp"
#include "kitti_scene.hpp"
#include "scene.hpp"

namespace atlas::test {
namespace {

constexpr double kLineGapDeg = 0.6;  // HDL-64E: 0.4 deg, and a little

struct Errors {
  double sum = 0, sum_sq = 0;
  std::uint64_t count = 0, outliers = 0, known = 0;
  void add(const cv::Mat& depth, const cv::Mat& truth, double farthest_m) {
    for (int row = 0; row < truth.rows; ++row) {
      for (int column = 0; column < truth.cols; ++column) {
        const double t = static_cast<double>(truth.at<float>(row, column));
        if (!(t > 0.0) || t > farthest_m) continue;
        ++known;
        const double error = static_cast<double>(depth.at<float>(row, column)) - t;
        if (std::isnan(error)) continue;
        ++count;
        sum += std::abs(error);
        sum_sq += error * error;
        outliers += std::abs(error) > 0.1 * t ? 1 : 0;
      }
    }
  }
  [[nodiscard]] double mae() const { return sum / static_cast<double>(count); }
  [[nodiscard]] double outliersPercent() const {
    return 100.0 * static_cast<double>(outliers) / static_cast<double>(count);
  }
  [[nodiscard]] double filledPercent() const {
    return 100.0 * static_cast<double>(count) / static_cast<double>(known);
  }
  void print(const std::string& name) const {
    std::printf("%s: MAE %.3f m, RMSE %.3f m, outliers %.2f %%, filled %.1f %% of the truth\n", name.c_str(),
                mae(), std::sqrt(sum_sq / static_cast<double>(count)), outliersPercent(), filledPercent());
  }
};

enum class Kind { kPoints, kVisible, kFilled };

/// The kinds are made one from the other, so in their order.
cv::Mat finished(DepthBuffer& buffer, double focal_px, Kind kind) {
  const double line_gap_px = focal_px * kLineGapDeg * M_PI / 180.0;
  if (kind != Kind::kPoints) buffer.removeInvisible({line_gap_px, 0.03, 0.15});
  if (kind != Kind::kFilled) return buffer.image();
  return buffer.takeFilled({focal_px, 0.3, line_gap_px, 0.12}).depth;
}

TEST(KittiDepth, stereo2015) {
  const fs::path data = dataFolder("kitti_stereo2015_sample");
  if (data.empty()) GTEST_SKIP() << "ATLAS_DATA is not set";
  std::map<Kind, Errors> errors;
  for (const std::string id : {"000010", "000050", "000075"}) {
    const KittiCamera camera =
        kittiCamera(data / "calib_cam_to_cam" / (id + ".txt"), data / "calib_velo_to_cam.txt");
    const CameraModel model = CameraModel::fromInfo(camera.info).value();
    const cv::Mat truth = depthOfDisparity(data / "gt/disp_occ_0" / (id + ".png"), model.fx());
    DepthBuffer buffer(model.width(), model.height());
    Projector(model, 0.5, 100.0)
        .projectSweep(*compacted(*sweepOf(kittiSweep(data / "velodyne_points" / (id + ".bin")))),
                      camera.T_camera_velodyne, [&](const ProjectedPoint& p) { buffer.add(p); });
    for (const Kind kind : {Kind::kPoints, Kind::kVisible, Kind::kFilled})
      errors[kind].add(finished(buffer, model.fx(), kind), truth, 80.0);
  }
  errors[Kind::kPoints].print("stereo 2015, points as they are");
  errors[Kind::kVisible].print("stereo 2015, hidden ones removed");
  errors[Kind::kFilled].print("stereo 2015, filled");
  EXPECT_LT(errors[Kind::kVisible].outliersPercent(), errors[Kind::kPoints].outliersPercent());
  EXPECT_GT(errors[Kind::kFilled].filledPercent(), 2.0 * errors[Kind::kVisible].filledPercent());
}

// Sparse depth of frames 5..16 as points; each frame filled alone, and from its neighbours by their poses.
TEST(KittiDepth, depthBenchmarkAfterAggregation) {
  const fs::path data = dataFolder("kitti_depth_0001");
  if (data.empty()) GTEST_SKIP() << "ATLAS_DATA is not set";
  const fs::path raw = data / "raw/2011_09_26";
  const KittiCamera camera = kittiCamera(raw / "calib_cam_to_cam.txt", raw / "calib_velo_to_cam.txt");
  const Pose T_camera_imu = camera.T_camera_velodyne * poseOf(calibration(raw / "calib_imu_to_velo.txt"));
  const fs::path depths = data / "data_depth_annotated/2011_09_26_drive_0001_sync/proj_depth";
  const CameraModel model = CameraModel::fromInfo(camera.info).value();
  const Projector projector(model, 0.5, 100.0);
  const auto name = [](int frame, const char* extension) {
    char text[32];
    std::snprintf(text, sizeof text, "%010d%s", frame, extension);
    return std::string(text);
  };
  std::vector<CompactSweepPtr> sweeps;
  std::vector<Pose> T_map_camera;
  for (int frame = 5; frame <= 16; ++frame) {
    const cv::Mat sparse = kittiDepth(depths / "velodyne_raw/image_02" / name(frame, ".png"));
    ASSERT_EQ(sparse.cols, model.width());
    std::vector<LidarPoint> points;
    for (int row = 0; row < sparse.rows; ++row) {
      for (int column = 0; column < sparse.cols; ++column) {
        const double z = static_cast<double>(sparse.at<float>(row, column));
        if (z > 0.0)
          points.push_back(
              point(z * (column - model.cx()) / model.fx(), z * (row - model.cy()) / model.fy(), z));
      }
    }
    T_map_camera.push_back(oxtsPose(data / "oxts/data" / name(frame, ".txt"), 49.0) * T_camera_imu.inverse());
    sweeps.push_back(compacted(*sweepOf(points, kStart, T_map_camera.back())));
  }
  const Eigen::Vector3d moved = T_map_camera[1].translation - T_map_camera[0].translation;
  ASSERT_LT(moved.norm(), 3.0) << "poses of neighbours";
  Errors alone, alone_all, together, together_all;
  for (int i = 0; i < 12; ++i) {
    const cv::Mat truth = kittiDepth(depths / "groundtruth/image_02" / name(i + 5, ".png"));
    DepthBuffer one(model.width(), model.height()), many(model.width(), model.height());
    for (int k = std::max(0, i - 2); k <= std::min(11, i + 2); ++k) {
      projector.projectSweep(*sweeps[static_cast<std::size_t>(k)],
                             T_map_camera[static_cast<std::size_t>(i)].inverse(),
                             [&](const ProjectedPoint& p) {
                               many.add(p, k == i);
                               if (k == i) one.add(p);
                             });
    }
    alone_all.add(finished(one, model.fx(), Kind::kPoints), truth, 80.0);
    alone.add(finished(one, model.fx(), Kind::kFilled), truth, 80.0);
    together_all.add(finished(many, model.fx(), Kind::kPoints), truth, 80.0);
    together.add(finished(many, model.fx(), Kind::kFilled), truth, 80.0);
  }
  alone_all.print("depth benchmark, one sweep, points as they are");
  alone.print("depth benchmark, one sweep, filled");
  together_all.print("depth benchmark, five sweeps, points as they are");
  together.print("depth benchmark, five sweeps, filled");
  EXPECT_GT(together.filledPercent(), 80.0);
  EXPECT_LT(together.outliersPercent(), together_all.outliersPercent());
}

}  // namespace
}  // namespace atlas::test
