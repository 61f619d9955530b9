// SPDX-License-Identifier: MIT
// Traceability: stages tell what their products were made from, the rows of origins.csv, and the tree.
#include <gtest/gtest.h>

#include "atlas/camera/depth_stage.hpp"
#include "atlas/output/origins_csv.hpp"
#include "atlas/output/trace_tree.hpp"

namespace atlas {
namespace {

constexpr Stamp kStart = 1'568'186'745 * kSecond;
Stamp at(double time_s) { return kStart + fromSeconds(time_s); }

BatchedSweepPtr sweepAt(Stamp stamp, bool with_pose) {
  auto points = std::make_shared<Sweep>();
  points->stamp = stamp;
  points->points.push_back({5, 0, 0, 0, 0, 0, 0});
  auto batched = std::make_shared<BatchedSweep>();
  batched->stamp = stamp;
  batched->sweep = points;
  if (with_pose) batched->batches.push_back({0, 1, stamp, Pose()});
  return batched;
}

TEST(Origins, ADepthImageNamesTheSweepsOfItsWindowAndNoOthers) {
  DepthParams params;
  params.cameras = {"camera_ir"};
  params.lidars = {"lidar_left", "lidar_right"};
  DepthStage stage(params);
  std::vector<ProductOrigins> told;
  stage.on_origins = [&](const ProductOrigins& product) { told.push_back(product); };
  for (int i = 0; i < 20; ++i) {
    stage.push(0, sweepAt(at(0.1 * i), i != 8));  // number 8 has no pose and shows nothing
    stage.push(1, sweepAt(at(0.1 * i + 0.05), true));
    CameraInfo info;
    info.stamp = at(0.1 * i + 0.02);
    stage.push(0, info);
  }
  for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
  ASSERT_EQ(told.size(), 20U);
  const ProductOrigins& image = told[10];  // at 1.02 s: the window is (0.52, 1.12]
  EXPECT_EQ(image.product, "camera_ir/depth/image");
  EXPECT_EQ(image.index, 10U);
  EXPECT_EQ(image.stamp, at(1.02));
  std::string text;
  for (const Origin& o : image.origins)
    text += o.topic + (o.index ? " " + std::to_string(*o.index) : "") + "\n";
  EXPECT_EQ(text,
            "camera_ir/camera_info 10\n"
            "lidar_right/batches 5\nlidar_left/batches 6\nlidar_right/batches 6\nlidar_left/batches 7\n"
            "lidar_right/batches 7\nlidar_right/batches 8\nlidar_left/batches 9\nlidar_right/batches 9\n"
            "lidar_left/batches 10\nlidar_right/batches 10\nlidar_left/batches 11\nodometry\n");
}

const ProductOrigins kLabels{
    "camera_ir/projected_detections",
    7,
    at(2),
    {{"camera_ir/camera_info", at(2), 7U, {}}, {"camera_left_front/frustums", at(1.99), 20U, {}}}};

TEST(OriginsCsv, RowsGoBothWays) {
  EXPECT_EQ(originsCsvHeader(), "product,index,stamp_ns,origins\n");
  const std::string row = originsCsvRow(kLabels);
  EXPECT_EQ(row,
            "camera_ir/projected_detections,7,1568186747000000000,"
            "camera_ir/camera_info#7@0;camera_left_front/frustums#20@-10000000\n");
  const auto back = parseOriginsRow(row);
  ASSERT_TRUE(back);
  EXPECT_EQ(originsCsvRow(*back), row);
  EXPECT_EQ(back->origins[1].stamp, at(1.99));
  const ProductOrigins without{"odometry", 1, 5, {{"imu/data", 5, {}, {}}}};
  EXPECT_EQ(originsCsvRow(without), "odometry,1,5,imu/data#@0\n");
  EXPECT_FALSE(parseOriginsRow("odometry,1,5,imu/data#@0")->origins[0].index);
  EXPECT_TRUE(parseOriginsRow("empty,1,5,")->origins.empty());
  const ProductOrigins object{"objects/17", 40, at(3), {{"obstacles", at(2.9), {}, 4U}}};
  EXPECT_EQ(originsCsvRow(object), "objects/17,40,1568186748000000000,obstacles#/4@-100000000\n");
  EXPECT_EQ(parseOriginsRow(originsCsvRow(object))->origins[0].item, 4U);
}

TEST(OriginsCsv, BrokenRowsAreNoRows) {
  for (const char* row :
       {"", "a", "a,b,5,", "a,1,x,", "a,1,5,b", "a,1,5,b#x@0", "a,1,5,b#1@", "a,1,5,#1@0", "a,1,5,b#1/x@0"})
    EXPECT_FALSE(parseOriginsRow(row)) << row;
}

TEST(TraceTree, GoesDownToTheRawData) {
  const std::vector<ProductOrigins> rows = {
      kLabels,
      {"camera_left_front/frustums",
       20,
       at(1.99),
       {{"camera_left_front/detections", at(1.99), 20U, {}}, {"lidar_left/batches", at(1.9), 19U, {}}}},
      {"camera_left_front/frustums", 21, at(2.09), {{"lidar_left/batches", at(2.0), 20U, {}}}}};
  int searches = 0;
  const FindOrigins find = [&](const std::vector<Origin>& wanted) {
    ++searches;
    std::vector<ProductOrigins> found;
    for (const ProductOrigins& row : rows) {
      for (const Origin& origin : wanted) {
        if (row.product == origin.topic && row.stamp == origin.stamp) found.push_back(row);
      }
    }
    return found;
  };
  EXPECT_EQ(traceTree({"camera_ir/projected_detections", at(2), 7U, {}}, find),
            "camera_ir/projected_detections #7 @ 1568186747000000000\n"
            "  camera_ir/camera_info #7 @ 1568186747000000000\n"
            "  camera_left_front/frustums #20 @ 1568186746990000000\n"
            "    camera_left_front/detections #20 @ 1568186746990000000\n"
            "      camera_left_front/image #20 @ 1568186746990000000\n"
            "    lidar_left/batches #19 @ 1568186746900000000\n"
            "      lidar_left/points #19 @ 1568186746900000000\n"
            "      odometry @ 1568186746900000000\n"
            "        imu/data around @ 1568186746900000000\n"
            "        imu/data, gnss/fix, gnss/heading before @ 1568186746900000000\n");
  EXPECT_EQ(searches, 2) << "once for each level that has to be looked up";
}

TEST(TraceTree, AnObjectGoesDownToItsObstacle) {
  const FindOrigins find = [](const std::vector<Origin>& wanted) {
    std::vector<ProductOrigins> found;
    if (wanted[0].topic == "objects/17") found.push_back({"objects/17", 40, 7, {{"obstacles", 7, {}, 4U}}});
    return found;
  };
  EXPECT_EQ(traceTree({"objects/17", 7, 40U, {}}, find),
            "objects/17 #40 @ 7\n"
            "  obstacles item 4 @ 7\n"
            "    batches of the first lidar @ 7\n"
            "    newest batches of the other lidars @ 7\n");
}

TEST(TraceTree, SaysWhatTheRunDidNotWrite) {
  const FindOrigins nothing = [](const std::vector<Origin>&) { return std::vector<ProductOrigins>{}; };
  EXPECT_EQ(traceTree({"grid", 5, 3U, {}}, nothing), "grid #3 @ 5  (origins not written by this run)\n");
}

}  // namespace
}  // namespace atlas
