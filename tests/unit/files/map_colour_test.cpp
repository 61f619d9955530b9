// SPDX-License-Identifier: MIT
// Colours of the map: from the camera that sees a place, none where something nearer hides it, the same bytes
// whatever the order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "files/writer_stages.hpp"
#include "temporary_folder.hpp"

namespace atlas {
namespace {

constexpr Stamp kImage = 1'568'186'745'000'000'000;
constexpr std::uint32_t kRed = 0xFFD02010U, kBlue = 0xFF1030C0U, kGreen = 0xFF20B040U;
// x in map, in the middle of a voxel; the camera is at the origin
constexpr double kWall_m = 20.1, kBoard_m = 8.1, kBoardHalf_m = 1.0;
constexpr double kShadowHalf_m = kBoardHalf_m * kWall_m / kBoard_m;
constexpr double kFocal_px = 400.0;

// ---- one wall, red to the left and blue to the right, and a green board before its middle ----

CameraInfo info() {
  CameraInfo result;
  result.stamp = kImage;
  result.frame = "camera";
  result.width = 640;
  result.height = 480;
  result.distortion_model = "plumb_bob";
  result.distortion = {-0.1, 0.02, 0, 0, 0};
  result.K = {kFocal_px, 0, 320, 0, kFocal_px, 240, 0, 0, 1};
  return result;
}

std::uint32_t colourSeenAlong(const Eigen::Vector3d& bearing) {
  const double left = -bearing.x(), up = -bearing.y();
  const double board = kBoardHalf_m / kBoard_m;
  if (std::abs(left) <= board && std::abs(up) <= board) return kGreen;
  return left > 0.0 ? kRed : kBlue;
}

ImagePtr picture() {
  auto image = std::make_shared<Image>();
  image->stamp = kImage;
  image->frame = "camera";
  image->format = "bgr8";
  image->pixels = cv::Mat(480, 640, CV_8UC3);
  const auto model = CameraModel::fromInfo(info());
  for (int row = 0; row < 480; ++row) {
    for (int column = 0; column < 640; ++column) {
      const auto bearing = model->bearing({static_cast<double>(column), static_cast<double>(row)});
      const std::uint32_t c = colourSeenAlong(*bearing);
      image->pixels.at<cv::Vec3b>(row, column) = {static_cast<std::uint8_t>(c & 255U),
                                                  static_cast<std::uint8_t>(c >> 8U & 255U),
                                                  static_cast<std::uint8_t>(c >> 16U & 255U)};
    }
  }
  return image;
}

/// From a lidar 3 m above, which sees the wall behind the board, too. Lidar frame = map.
BatchedSweepPtr sweep() {
  auto points = std::make_shared<Sweep>();
  const auto add = [&](double x, double y, double z) {
    points->points.push_back(
        {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0, 0, 0, 0});
  };
  // off the edges of voxels by a quarter of one: 2 px of the wall
  for (double y = -7.95; y < 8.0; y += 0.1)
    for (double z = -5.95; z < 6.0; z += 0.1) add(kWall_m, y, z);
  for (double y = -0.99; y < kBoardHalf_m; y += 0.02)
    for (double z = -0.99; z < kBoardHalf_m; z += 0.02) add(kBoard_m, y, z);
  auto batched = std::make_shared<BatchedSweep>();
  batched->stamp = kImage - 10 * kMillisecond;
  batched->frame = "lidar";
  batched->sweep = points;
  batched->batches = {{0, static_cast<std::uint32_t>(points->points.size()), batched->stamp, Pose{}}};
  return batched;
}

/// The depth stage and the map writer, as the replay has them.
void writeScene(const std::filesystem::path& out, LocalGraph::Threads threads, bool colour) {
  LocalGraph graph(threads);
  DepthParams depth;
  depth.cameras = {"camera"};
  depth.lidars = {"lidar"};
  MapWriterParams map;
  map.lidars = {"lidar"};
  map.colour_cameras = {"camera"};
  map.map.colour = colour;
  graph.beginThread();
  graph.add([&](LocalGraph::Bus& bus) { return bindDepth(bus, depth); });
  graph.beginThread();
  graph.add([&](LocalGraph::Bus& bus) { return bindMapWriter(bus, map, out.string()); });
  const Pose T_imu_camera{Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), Eigen::Vector3d::Zero()};
  graph.publish("tf_static", StaticTransforms{{{"base_link", "camera", T_imu_camera}}});
  graph.publish("anchor", Anchor{kImage - kSecond, {49.2, 16.6, 250.0}});
  for (int i = -20; i <= 40; ++i) {
    Odometry odometry;
    odometry.stamp = kImage + i * 10 * kMillisecond;
    graph.publish("odometry", odometry);
    if (i == -1) graph.publish("lidar/batches", sweep());
    if (i == 0) graph.publish("camera/camera_info", info());
    if (i == 0) graph.publish("camera/image", picture());
    graph.advance(odometry.stamp);
  }
  graph.finish();
}

std::vector<MapPoint> pointsOf(const std::string& pcd, bool coloured) {
  const std::string end = "DATA binary\n";
  const std::size_t begin = pcd.find(end) + end.size(), record = coloured ? 24 : 20;
  std::vector<MapPoint> points((pcd.size() - begin) / record);
  for (std::size_t i = 0; i < points.size(); ++i) std::memcpy(&points[i], &pcd[begin + i * record], record);
  return points;
}

TEST(MapColour, WhatTheCameraSeesHasItsColourWhatIsHiddenHasNone) {
  const test::TemporaryFolder folder;
  writeScene(folder / "run", LocalGraph::Threads::kOne, true);
  const std::string pcd = folder.read("run/map/map.pcd");
  EXPECT_NE(pcd.find("FIELDS x y z intensity count rgb\nSIZE 4 4 4 4 4 4\nTYPE F F F F U F\n"),
            std::string::npos);
  std::size_t red = 0, blue = 0, green = 0, hidden = 0;
  constexpr double kVoxel_m = 0.2;  // a voxel at a border belongs to both sides
  for (const MapPoint& p : pointsOf(pcd, true)) {
    const double y = p.y, z = p.z, aside = std::max(std::abs(y), std::abs(z));
    if (p.x < 10.0F) {
      green += p.colour == kGreen ? 1 : 0;
      if (aside < kBoardHalf_m - kVoxel_m) {
        EXPECT_EQ(p.colour, kGreen) << y << " " << z;
      }
    } else if (aside < kShadowHalf_m - kVoxel_m) {
      ++hidden;
      EXPECT_EQ(p.colour, 0U) << "behind the board: " << y << " " << z;
    } else if (aside > kShadowHalf_m + 2 * kVoxel_m && std::abs(y) > 2 * kVoxel_m) {
      // the image ends beyond the wall
      EXPECT_EQ(p.colour, y > 0.0 ? kRed : kBlue) << y << " " << z;
      ++(y > 0.0 ? red : blue);
    }
  }
  EXPECT_GT(red, 900U);
  EXPECT_GT(blue, 900U);
  EXPECT_GT(green, 60U);
  EXPECT_GT(hidden, 300U);
  const auto index = nlohmann::json::parse(folder.read("run/map/tiles.json"));
  EXPECT_GT(index["coloured"], red + blue + green);
  EXPECT_LE(index["coloured"], index["points"].get<std::size_t>() - hidden);
}

TEST(MapColour, ThreadsMakeTheSameBytes) {
  const test::TemporaryFolder folder;
  writeScene(folder / "one", LocalGraph::Threads::kOne, true);
  writeScene(folder / "several", LocalGraph::Threads::kSeveral, true);
  for (const char* file : {"map/map.pcd", "map/map.ply", "map/tiles.json"})
    EXPECT_EQ(folder.read("one/" + std::string(file)), folder.read("several/" + std::string(file))) << file;
}

TEST(MapColour, TheMapWithoutIsTheSameButForTheColours) {
  const test::TemporaryFolder folder;
  writeScene(folder / "with", LocalGraph::Threads::kOne, true);
  writeScene(folder / "without", LocalGraph::Threads::kOne, false);
  const std::vector<MapPoint> with = pointsOf(folder.read("with/map/map.pcd"), true);
  const std::vector<MapPoint> without = pointsOf(folder.read("without/map/map.pcd"), false);
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    ASSERT_EQ(std::memcmp(&with[i], &without[i], 20), 0) << i;
    ASSERT_EQ(without[i].colour, 0U);
  }
  EXPECT_EQ(folder.read("without/map/map.pcd").find("rgb"), std::string::npos);
  EXPECT_EQ(folder.read("without/map/map.ply").find("red"), std::string::npos);
}

// ---- what is kept of many observations ----

/// A return in the middle of each voxel of a row.
BatchedSweep rowOfReturns(int voxels, double voxel_m) {
  auto points = std::make_shared<Sweep>();
  for (int i = 0; i < voxels; ++i) {
    const auto x = static_cast<float>((i + 0.5) * voxel_m), middle = static_cast<float>(0.5 * voxel_m);
    points->points.push_back({x, middle, middle, 0, 0, 0, 0});
  }
  BatchedSweep batched;
  batched.sweep = points;
  batched.batches.push_back({0, static_cast<std::uint32_t>(voxels), 0, Pose{}});
  return batched;
}

TEST(MapColour, NearObservationsWeighMoreByTheSquareOfTheDepth) {
  const test::TemporaryFolder folder;
  MapParams params;
  params.colour = true;
  MapWriter writer(folder / "run", params);
  writer.add(rowOfReturns(3, params.voxel_m));
  // At 4 m a weight of 255, at 8 m of 63: (255 * 200 + 63 * 100) / 318 = 180.2
  writer.add({{0.1F, 0.1F, 0.1F, 4.0F, 200, 0, 7}, {0.15F, 0.1F, 0.1F, 8.0F, 100, 0, 7}});
  writer.add({{0.3F, 0.1F, 0.1F, 90.0F, 1, 2, 3}});
  writer.add({{5.1F, 0.1F, 0.1F, 3.0F, 9, 9, 9}});  // where no return was: no point
  writer.finish({0, {49.2, 16.6, 250.0}});
  const std::vector<MapPoint> points = pointsOf(folder.read("run/map/map.pcd"), true);
  ASSERT_EQ(points.size(), 3U);
  EXPECT_EQ(points[0].colour, 0xFFB40007U);
  EXPECT_EQ(points[1].colour, 0xFF010203U);
  EXPECT_EQ(points[2].colour, 0U) << "nothing seen there";
  EXPECT_EQ(nlohmann::json::parse(folder.read("run/map/tiles.json"))["coloured"], 2);
  const std::string ply = folder.read("run/map/map.ply");
  EXPECT_NE(ply.find("property uchar blue\nproperty uchar green\nproperty uchar red\nproperty uchar alpha\n"),
            std::string::npos);
  EXPECT_EQ(ply.substr(ply.size() - 72 + 20, 4), std::string("\x07\x00\xB4\xFF", 4));
}

TEST(MapColour, OrderAndTilesOnDiskHaveNoInfluence) {
  const test::TemporaryFolder folder;
  std::mt19937 random(5);
  std::uniform_real_distribution<float> x(0.0F, 10.0F), depth(2.0F, 40.0F);
  std::vector<ColouredPoint> seen(5000);
  for (ColouredPoint& p : seen) {
    const auto byte = [&] { return static_cast<std::uint8_t>(random() % 256); };
    p = {x(random), 0.1F, 0.1F, depth(random), byte(), byte(), byte()};
  }
  MapParams params;
  params.colour = true;
  const auto drive = [&](const std::string& name, double keep_radius_m, bool colours_first) {
    params.keep_radius_m = keep_radius_m;
    MapWriter writer(folder / name, params);
    const BatchedSweep row = rowOfReturns(50, params.voxel_m);
    if (!colours_first) writer.add(row);
    for (std::size_t i = 0; i < seen.size(); i += 500) {
      writer.add(std::vector<ColouredPoint>(&seen[i], &seen[i] + 500));
      BatchedSweep far = rowOfReturns(1, params.voxel_m);
      far.T_map_lidar.translation.x() = far.batches[0].T_map_lidar.translation.x() = 1000.0;
      writer.add(far);  // the tiles of the row go to disk
    }
    if (colours_first) writer.add(row);
    EXPECT_EQ(writer.spills() > 5, keep_radius_m < 1000.0);
    writer.finish({0, {49.2, 16.6, 250.0}});
    return folder.read(name + "/map/map.pcd");
  };
  const std::string expected = drive("held", 1e6, false);
  EXPECT_EQ(drive("spilled", 100.0, false), expected);
  std::shuffle(seen.begin(), seen.end(), random);
  EXPECT_EQ(drive("shuffled", 100.0, true), expected);
}

TEST(MapColour, NeedsCameras) {
  MapWriterParams params;
  params.map.colour = true;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params.colour_cameras = {"camera"};
  EXPECT_NO_THROW(validate(params));
}

}  // namespace
}  // namespace atlas
