// SPDX-License-Identifier: MIT
#include "atlas/output/grid_pgm.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace atlas {
namespace {

OccupancyMap threeByTwo() {
  OccupancyMap map;
  map.stamp = 5;
  map.resolution_m = 0.2F;
  map.origin = {-4.2, 10.0, 0.5};
  map.columns = 3;
  map.rows = 2;
  map.percent = {0,  50, 100,  // y = 10.0
                 -1, 20, 65};
  return map;
}

/// As map_server reads a picture that is not negated: occupied, free or unknown.
std::string meaning(int grey) {
  const double occupied = (255 - grey) / 255.0;
  if (occupied > 0.65) return "occupied";
  if (occupied < 0.196) return "free";
  return "unknown";
}

TEST(GridPgm, firstRowOfThePictureIsTheLargestY) {
  const auto bytes = gridPgm(threeByTwo());
  ASSERT_GT(bytes.size(), 2U);
  EXPECT_EQ(bytes[0], 'P');
  EXPECT_EQ(bytes[1], '5');
  const cv::Mat read = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  ASSERT_EQ(read.size(), cv::Size(3, 2));
  const cv::Mat expected = (cv::Mat_<std::uint8_t>(2, 3) << 205, 204, 89, 255, 128, 0);
  EXPECT_EQ(cv::norm(read, expected, cv::NORM_INF), 0.0) << read;
  EXPECT_EQ(meaning(read.at<std::uint8_t>(1, 2)), "occupied");
  EXPECT_EQ(meaning(read.at<std::uint8_t>(1, 0)), "free");
  EXPECT_EQ(meaning(read.at<std::uint8_t>(1, 1)), "unknown");
  EXPECT_EQ(meaning(read.at<std::uint8_t>(0, 0)), "unknown") << "205 is map_saver's grey for it";
}

TEST(GridPgm, yamlSaysWhereItLies) {
  EXPECT_EQ(gridYaml(threeByTwo(), "5.pgm"),
            "image: 5.pgm\nresolution: 0.2\norigin: [-4.200000, 10.000000, 0.0]\n"
            "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST(GridPgm, aMapWithoutCellsIsRefused) { EXPECT_THROW(gridPgm(OccupancyMap()), std::invalid_argument); }

OccupancyFrame frameOf(const std::vector<float>& occupied, const std::vector<float>& unknown) {
  OccupancyFrame frame;
  frame.stamp = 7;
  frame.geometry.cell_m = 0.25;
  frame.geometry.columns = static_cast<int>(occupied.size());
  frame.geometry.rows = 1;
  frame.geometry.first_column = -8;
  frame.geometry.first_row = 12;
  frame.road_m = -0.75;
  auto cells = std::make_shared<CellEstimates>();
  cells->resize(occupied.size());
  cells->occupied = occupied;
  cells->unknown = unknown;
  frame.cells = cells;
  return frame;
}

TEST(OccupancyMap, percentAndUnknown) {
  const auto map =
      occupancyMap(frameOf({0.0F, 0.024F, 0.5F, 0.996F, 0.9F}, {0.0F, 0.2F, 0.9F, 0.5F, 0.51F}), 0.5);
  EXPECT_EQ(map->percent, (std::vector<std::int8_t>{0, 2, -1, 100, -1}));
  EXPECT_EQ(map->origin, Eigen::Vector3d(-2.0, 3.0, -0.75));
  EXPECT_EQ(map->resolution_m, 0.25F);
  EXPECT_EQ(map->columns, 5U);
  EXPECT_EQ(map->rows, 1U);
  EXPECT_EQ(map->stamp, 7);
}

TEST(OccupancyMap, withoutAPoseItHasNoCells) {
  OccupancyFrame frame;
  frame.stamp = 9;
  const auto map = occupancyMap(frame, 0.5);
  EXPECT_EQ(map->stamp, 9);
  EXPECT_TRUE(map->percent.empty());
  EXPECT_EQ(map->columns, 0U);
}

}  // namespace
}  // namespace atlas
