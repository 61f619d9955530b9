// SPDX-License-Identifier: MIT
// Obstacles of real HDL-64E sweeps against the cars of the KITTI 2015 object maps: a return belongs to a car
// when its pixel does and its depth is that of the car's true disparity. Only cars are labelled and they have
// no boxes, so this tells which cars are found and into how many boxes they fall, not how well boxes fit.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <stdexcept>

#include "atlas/lidar/obstacle_stage.hpp"

namespace atlas {
namespace {

namespace fs = std::filesystem;

constexpr double kFarthest_m = 30.0;
constexpr int kFewestPoints = 20;
constexpr double kLidarHeight_m = 1.73;  // KITTI's own figure

/// Numbers after "NAME:" of a calibration file.
std::vector<double> numbersOf(const fs::path& file, const std::string& name) {
  std::ifstream lines(file);
  std::vector<double> numbers;
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind(name + ":", 0) != 0) continue;
    std::istringstream fields(line.substr(name.size() + 1));
    numbers.assign(std::istream_iterator<double>(fields), {});
  }
  return numbers;
}

template <int kRows, int kColumns>
Eigen::Matrix<double, kRows, kColumns> matrixOf(const fs::path& file, const std::string& name) {
  const std::vector<double> numbers = numbersOf(file, name);
  if (numbers.size() != kRows * kColumns) throw std::runtime_error(file.string() + ": no matrix " + name);
  return Eigen::Map<
      const Eigen::Matrix<double, kRows, kColumns, kColumns == 1 ? Eigen::ColMajor : Eigen::RowMajor>>(
      numbers.data());
}

std::vector<LidarPoint> readSweep(const fs::path& file) {
  std::ifstream bytes(file, std::ios::binary);
  std::vector<LidarPoint> points;
  for (std::array<float, 4> p{}; bytes.read(reinterpret_cast<char*>(p.data()), sizeof p);) {
    LidarPoint point;
    point.x = p[0];
    point.y = p[1];
    point.z = p[2];
    point.intensity = p[3];
    points.push_back(point);
  }
  return points;
}

/// Owner of each return: car number, 0 = something else in the picture, -1 = not in the picture.
std::vector<int> ownersOf(const std::vector<LidarPoint>& points, const fs::path& data,
                          const std::string& id) {
  const fs::path camera = data / "calib_cam_to_cam" / (id + ".txt"), lidar = data / "calib_velo_to_cam.txt";
  Eigen::Matrix4d T_rect_velo = Eigen::Matrix4d::Identity();
  T_rect_velo.topLeftCorner<3, 3>() = matrixOf<3, 3>(lidar, "R");
  T_rect_velo.topRightCorner<3, 1>() = matrixOf<3, 1>(lidar, "T");
  Eigen::Matrix4d rectify = Eigen::Matrix4d::Identity();
  rectify.topLeftCorner<3, 3>() = matrixOf<3, 3>(camera, "R_rect_00");
  const Eigen::Matrix<double, 3, 4> P2 = matrixOf<3, 4>(camera, "P_rect_02"),
                                    P3 = matrixOf<3, 4>(camera, "P_rect_03");
  const Eigen::Matrix<double, 3, 4> project = P2 * rectify * T_rect_velo;
  const double focal_times_base = P2(0, 3) - P3(0, 3);  // px m
  const cv::Mat cars = cv::imread((data / "gt/obj_map" / (id + ".png")).string(), cv::IMREAD_UNCHANGED);
  const cv::Mat disparity =
      cv::imread((data / "gt/disp_occ_0" / (id + ".png")).string(), cv::IMREAD_UNCHANGED);
  if (cars.type() != CV_8UC1 || disparity.type() != CV_16UC1)
    throw std::runtime_error(id + ": unexpected pictures");
  std::vector<int> owners;
  for (const LidarPoint& p : points) {
    const Eigen::Vector3d q = project * Eigen::Vector4d(p.x, p.y, p.z, 1.0);
    const auto u = static_cast<int>(std::lround(q.x() / q.z())),
               v = static_cast<int>(std::lround(q.y() / q.z()));
    owners.push_back(-1);
    if (p.x < 1.0F || u < 0 || v < 0 || u >= cars.cols || v >= cars.rows) continue;
    owners.back() = 0;
    const double pixels = disparity.at<std::uint16_t>(v, u) / 256.0;
    const bool same_depth = pixels > 0.0 && std::abs(focal_times_base / pixels - q.z()) < 0.4 + 0.04 * q.z();
    if (same_depth) owners.back() = cars.at<std::uint8_t>(v, u);
  }
  return owners;
}

bool holds(const Obstacle& box, const LidarPoint& p) {
  const Eigen::Vector3d d = Eigen::Vector3d(p.x, p.y, p.z) - box.center;
  const double c = std::cos(box.yaw_rad), s = std::sin(box.yaw_rad);
  return std::abs(c * d.x() + s * d.y()) <= 0.5 * box.size.x() + 0.01 &&
         std::abs(-s * d.x() + c * d.y()) <= 0.5 * box.size.y() + 0.01 &&
         std::abs(d.z()) <= 0.5 * box.size.z() + 0.01;
}

struct Tally {
  int cars = 0, found = 0, boxes = 0, fragments = 0;
};

void judge(const std::vector<LidarPoint>& points, const std::vector<int>& owners,
           const std::vector<Obstacle>& obstacles, Tally& tally) {
  std::map<int, int> returns, held;
  std::map<int, Eigen::Vector2d> sum;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (owners[i] <= 0) continue;
    ++returns[owners[i]];
    sum.try_emplace(owners[i], Eigen::Vector2d::Zero()).first->second +=
        Eigen::Vector2d(points[i].x, points[i].y);
  }
  const auto isJudged = [&](int car) {
    return returns[car] >= kFewestPoints && (sum[car] / returns[car]).norm() <= kFarthest_m;
  };
  std::map<int, int> boxes_of;
  for (const Obstacle& box : obstacles) {
    std::map<int, int> census;
    int in_picture = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (owners[i] < 0 || !holds(box, points[i])) continue;
      ++in_picture;
      ++census[owners[i]];
    }
    for (const auto& [car, count] : census) {
      if (car == 0 || 2 * count < in_picture || !isJudged(car)) continue;
      ++boxes_of[car];
      held[car] = std::max(held[car], count);
    }
  }
  for (const auto& [car, count] : returns) {
    if (!isJudged(car)) continue;
    ++tally.cars;
    tally.boxes += boxes_of[car];
    tally.fragments += std::max(0, boxes_of[car] - 1);
    const bool found = 2 * held[car] >= count;
    tally.found += found ? 1 : 0;
    std::printf("  car %2d: %5d returns at %4.1f m, %5d in its box, %d box(es)\n", car, count,
                (sum[car] / count).norm(), held[car], boxes_of[car]);
  }
}

TEST(KittiObstacles, CarsOfTheObjectMapsAreFound) {
  const char* root = std::getenv("ATLAS_DATA");
  if (root == nullptr) GTEST_SKIP() << "ATLAS_DATA is not set";
  const fs::path data = fs::path(root) / "kitti_stereo2015_sample";
  if (!fs::is_directory(data)) GTEST_SKIP() << data << " is absent";
  ObstacleParams params;
  params.lidars = {"velodyne"};
  Tally tally;
  for (const std::string id : {"000010", "000050", "000075"}) {
    auto sweep = std::make_shared<Sweep>();
    sweep->points = readSweep(data / "velodyne_points" / (id + ".bin"));
    ASSERT_GT(sweep->points.size(), 100000U) << id;
    auto batched = std::make_shared<BatchedSweep>();
    batched->sweep = sweep;
    batched->batches = {{0, static_cast<std::uint32_t>(sweep->points.size()), 0, {}}};
    Counters counters;
    const Obstacles found =
        findObstacles({batched}, Eigen::Vector3d(0.0, 0.0, -kLidarHeight_m), 0, params, counters);
    std::printf("KITTI 2015 %s: %zu obstacles, %zu ground points of %zu\n", id.c_str(),
                found.obstacles.size(), found.ground->points.size(), sweep->points.size());
    judge(sweep->points, ownersOf(sweep->points, data, id), found.obstacles, tally);
  }
  std::printf("cars within %.0f m with %d returns: %d, found %d; boxes on them %d, fragments %d\n",
              kFarthest_m, kFewestPoints, tally.cars, tally.found, tally.boxes, tally.fragments);
  EXPECT_GE(tally.cars, 5);
  EXPECT_GE(tally.found, 0.8 * tally.cars);
}

}  // namespace
}  // namespace atlas
