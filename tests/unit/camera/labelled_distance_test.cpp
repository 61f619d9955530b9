// SPDX-License-Identifier: MIT
// Distances of the camera-lidar stage on real recordings against labels: cars of the KITTI stereo 2015
// benchmark (object map and dense disparity) and the 3D boxes of a nuScenes sample. The figures are printed;
// tests/bench/BENCHMARK.md has them. Neither set has detections of a network: the rectangle around the
// labelled object takes their place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>

#include "atlas/camera/box_overlap.hpp"
#include "atlas/camera/camera_lidar_stage.hpp"
#include "atlas/camera/frustum.hpp"
#include "kitti_scene.hpp"
#include "scene.hpp"

namespace atlas::test {
namespace {

constexpr double kFarthest_m = 40.0;

/// An object in an image.
struct Labelled {
  std::string name;
  Detection2d box;
  double front_m = 0;  ///< z-depth where it begins
};
struct View {
  CameraInfo info;
  Pose T_camera_lidar;
  std::vector<Labelled> objects;
};

/// What the stage says of a standing vehicle whose base_link is the lidar; by object.
std::vector<std::optional<double>> distancesOf(const View& view, const BatchedSweepPtr& sweep,
                                               const std::string& method) {
  CameraLidarParams params;
  params.cameras = {"camera"};
  params.lidars = {"lidar"};
  params.method = method;
  CameraLidarStage stage(params);
  std::vector<std::optional<double>> result(view.objects.size());
  stage.on_frustums = [&](std::size_t, const Frustums& found) {
    for (const Frustum& f : found.frustums) result.at(f.detection_index) = f.distance_m;
  };
  CameraInfo info = view.info;
  info.stamp = kStart;
  info.frame = "camera";
  Detections detections;
  detections.stamp = kStart;
  for (const Labelled& object : view.objects) detections.boxes.push_back(object.box);
  stage.push(0, rig({{"camera", view.T_camera_lidar.inverse()}}));
  for (int i = -1; i <= 1; ++i) stage.push(odometry(kStart + i * 100 * kMillisecond));
  stage.push(0, sweep);
  stage.push(0, info);
  stage.push(0, detections);
  for (std::size_t input = 0; input < stage.inputs(); ++input) stage.finish(input);
  return result;
}

/// Errors of one method.
struct Distances {
  std::vector<double> errors_m;
  std::size_t asked = 0;
  void add(const View& view, const std::vector<std::optional<double>>& found) {
    for (std::size_t i = 0; i < view.objects.size(); ++i) {
      ++asked;
      if (found[i]) errors_m.push_back(std::abs(*found[i] - view.objects[i].front_m));
    }
    std::sort(errors_m.begin(), errors_m.end());
  }
  [[nodiscard]] double quantile(double q) const {
    return errors_m.at(static_cast<std::size_t>(q * static_cast<double>(errors_m.size() - 1)));
  }
  void print(const std::string& what) const {
    std::printf("%s: %zu of %zu objects, median error %.2f m, 90 %% %.2f m\n", what.c_str(), errors_m.size(),
                asked, quantile(0.5), quantile(0.9));
  }
};

void compare(const std::vector<std::pair<View, BatchedSweepPtr>>& scenes, const std::string& what,
             std::size_t at_least) {
  Distances foreground, median;
  for (const auto& [view, sweep] : scenes) {
    const auto by_foreground = distancesOf(view, sweep, "foreground");
    const auto by_median = distancesOf(view, sweep, "median");
    foreground.add(view, by_foreground);
    median.add(view, by_median);
    for (std::size_t i = 0; i < view.objects.size(); ++i) {
      std::printf("  %s at %.2f m: foreground %.2f, median %.2f\n", view.objects[i].name.c_str(),
                  view.objects[i].front_m, by_foreground[i].value_or(std::nan("")),
                  by_median[i].value_or(std::nan("")));
    }
  }
  ASSERT_GE(foreground.errors_m.size(), at_least);
  foreground.print(what + ", foreground");
  median.print(what + ", median");
  EXPECT_LT(foreground.quantile(0.5), median.quantile(0.5));
}

/// The cars of an object map: the rectangle around each, and where it begins by the true disparity (5 %
/// nearest).
std::vector<Labelled> carsOf(const cv::Mat& objects, const cv::Mat& truth) {
  struct Car {
    Detection2d box{1e9, 1e9, -1e9, -1e9, 2, 1.0};
    std::vector<float> depths;
  };
  std::map<int, Car> cars;
  for (int row = 0; row < objects.rows; ++row) {
    for (int column = 0; column < objects.cols; ++column) {
      const int id = objects.at<std::uint8_t>(row, column);
      if (id == 0) continue;
      Car& car = cars[id];
      car.box.x_min = std::min(car.box.x_min, column - 0.5);
      car.box.y_min = std::min(car.box.y_min, row - 0.5);
      car.box.x_max = std::max(car.box.x_max, column + 0.5);
      car.box.y_max = std::max(car.box.y_max, row + 0.5);
      if (truth.at<float>(row, column) > 0.0F) car.depths.push_back(truth.at<float>(row, column));
    }
  }
  std::vector<Labelled> result;
  for (auto& [id, car] : cars) {
    std::sort(car.depths.begin(), car.depths.end());
    if (car.depths.size() < 100) continue;
    const double front_m = static_cast<double>(car.depths[car.depths.size() / 20]);
    if (front_m < kFarthest_m) result.push_back({"car", car.box, front_m});
  }
  return result;
}

TEST(LabelledDistance, carsOfStereo2015) {
  const fs::path data = dataFolder("kitti_stereo2015_sample");
  if (data.empty()) GTEST_SKIP() << "ATLAS_DATA is not set";
  std::vector<std::pair<View, BatchedSweepPtr>> scenes;
  for (const std::string id : {"000010", "000050", "000075"}) {
    const KittiCamera camera =
        kittiCamera(data / "calib_cam_to_cam" / (id + ".txt"), data / "calib_velo_to_cam.txt");
    const cv::Mat objects = cv::imread((data / "gt/obj_map" / (id + ".png")).string(), cv::IMREAD_GRAYSCALE);
    const cv::Mat truth = depthOfDisparity(data / "gt/disp_occ_0" / (id + ".png"), camera.info.K[0]);
    scenes.emplace_back(View{camera.info, camera.T_camera_velodyne, carsOf(objects, truth)},
                        sweepOf(kittiSweep(data / "velodyne_points" / (id + ".bin"))));
  }
  compare(scenes, "stereo 2015", 9);
}

/// A labelled box in the lidar frame.
struct Box3d {
  std::string name;
  Pose T_lidar_box;
  Eigen::Vector3d size;
  int points = 0;  ///< of the lidar inside, as labelled
  [[nodiscard]] bool holds(const Eigen::Vector3d& p_lidar) const {
    const Eigen::Vector3d p = T_lidar_box.inverse() * p_lidar;
    return (p.cwiseAbs() - 0.5 * size).maxCoeff() <= 0.0;
  }
};

/// The box in the image: the rectangle around its corners, clipped; nothing when a corner is behind the
/// camera, less than half of the rectangle is in the image, or the box begins too far away.
std::optional<Labelled> seenBy(const View& view, const Box3d& box) {
  Labelled seen{box.name, {1e9, 1e9, -1e9, -1e9, 2, 1.0}, std::numeric_limits<double>::infinity()};
  const CameraModel model = CameraModel::fromInfo(view.info).value();
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d side(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
    const Eigen::Vector3d p = view.T_camera_lidar * (box.T_lidar_box * side.cwiseProduct(box.size));
    const auto px = model.project(p);
    if (!px) return std::nullopt;
    seen.front_m = std::min(seen.front_m, p.z());
    seen.box.x_min = std::min(seen.box.x_min, px->x());
    seen.box.y_min = std::min(seen.box.y_min, px->y());
    seen.box.x_max = std::max(seen.box.x_max, px->x());
    seen.box.y_max = std::max(seen.box.y_max, px->y());
  }
  const Outcome<Detection2d> clipped = clipToImage(seen.box, model);
  if (!clipped || overlapOf(*clipped, seen.box) < 0.5 || seen.front_m > kFarthest_m) return std::nullopt;
  seen.box = *clipped;
  return seen;
}

/// Cameras and boxes of a sample, as tests/tools/nuscenes_boxes.py prints them.
struct NuscenesSample {
  std::vector<View> views;
  std::vector<Box3d> boxes;
};
NuscenesSample readNuscenes(const fs::path& info) {
  const std::string command =
      "/usr/bin/python3 '" ATLAS_TEST_TOOLS "/nuscenes_boxes.py' '" + info.string() + "'";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  for (char part[4096]; pipe && std::fgets(part, sizeof part, pipe.get()) != nullptr;) text += part;
  NuscenesSample sample;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string kind, name;
    fields >> kind >> name;
    std::vector<double> n;
    for (double value = 0; fields >> value;) n.push_back(value);
    if (kind == "camera") {
      View view;
      view.info = cameraInfo("camera", 1600, 900, n.at(0), n.at(1), n.at(2), n.at(3), {});
      Eigen::Matrix3d rotation;
      rotation << n.at(4), n.at(5), n.at(6), n.at(8), n.at(9), n.at(10), n.at(12), n.at(13), n.at(14);
      view.T_camera_lidar = {Eigen::Quaterniond(rotation).normalized(), {n.at(7), n.at(11), n.at(15)}};
      sample.views.push_back(view);
    } else {
      const Eigen::Quaterniond yaw(Eigen::AngleAxisd(n.at(6), Eigen::Vector3d::UnitZ()));
      sample.boxes.push_back(
          {name, {yaw, {n.at(0), n.at(1), n.at(2)}}, {n.at(3), n.at(4), n.at(5)}, static_cast<int>(n.at(7))});
    }
  }
  return sample;
}

std::vector<LidarPoint> nuscenesSweep(const fs::path& path) {
  std::vector<LidarPoint> points;
  std::ifstream file(path, std::ios::binary);
  for (float row[5]; file.read(reinterpret_cast<char*>(row), sizeof row);)
    points.push_back(point(row[0], row[1], row[2]));
  return points;
}

fs::path onlyFile(const fs::path& folder, const std::string& end) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.size() > end.size() && name.compare(name.size() - end.size(), end.size(), end) == 0)
      return entry.path();
  }
  return {};
}

// 32 beams, six cameras around. What stands in front of what is not labelled, so boxes with ten points are
// taken.
TEST(LabelledDistance, boxesOfNuscenes) {
  const fs::path data = dataFolder("nuscenes_sample");
  if (data.empty()) GTEST_SKIP() << "ATLAS_DATA is not set";
  NuscenesSample sample = readNuscenes(onlyFile(data, ".pkl"));
  ASSERT_EQ(sample.views.size(), 6U);
  const std::vector<LidarPoint> points = nuscenesSweep(onlyFile(data, ".pcd.bin"));
  std::vector<std::pair<View, BatchedSweepPtr>> scenes;
  for (const Box3d& box : sample.boxes) {
    const auto inside = std::count_if(points.begin(), points.end(), [&](const LidarPoint& p) {
      return box.holds({p.x, p.y, p.z});
    });
    EXPECT_NEAR(static_cast<double>(inside), box.points, 2.0 + 0.1 * box.points) << box.name;
    if (box.points < 10) continue;
    for (View& view : sample.views) {
      if (const auto seen = seenBy(view, box)) view.objects.push_back(*seen);
    }
  }
  for (const View& view : sample.views) {
    if (!view.objects.empty()) scenes.emplace_back(view, sweepOf(points));
  }
  compare(scenes, "nuScenes", 10);
}

}  // namespace
}  // namespace atlas::test
