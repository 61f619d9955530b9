// SPDX-License-Identifier: MIT
#include "report/grid_picture.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "atlas/output/grid_pgm.hpp"
#include "atlas/output/objects_text.hpp"

namespace atlas::report {
namespace {

namespace fs = std::filesystem;

class GridPicture : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(out_);
    fs::create_directories(out_ / "grid");
    write("objects.csv", objectsCsvHeader());
  }
  void TearDown() override { fs::remove_all(out_); }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(out_ / "grid" / name, std::ios::binary | std::ios::app) << content;
  }
  /// 10 x 10 cells of 1 m from (100, 200), all free but one.
  void writeGrid(Stamp stamp) const {
    OccupancyMap map;
    map.stamp = stamp;
    map.resolution_m = 1.0F;
    map.origin = {100.0, 200.0, 0.0};
    map.columns = map.rows = 10;
    map.percent.assign(100, 0);
    map.percent[2 * 10 + 7] = 100;  // x 107..108, y 202..203
    const auto pgm = gridPgm(map);
    const std::string name = std::to_string(stamp);
    write(name + ".pgm", std::string(pgm.begin(), pgm.end()));
    write(name + ".yaml", gridYaml(map, name + ".pgm"));
  }
  void writeObject(Stamp stamp, bool is_static) const {
    Objects objects;
    objects.stamp = stamp;
    objects.objects.resize(1);
    Object& o = objects.objects[0];
    o.id = 4;
    o.position = {103.0, 206.0, 0.0};
    o.size = {2.0, 2.0, 1.5};
    o.velocity_mps = {3.0, 0.0, 0.0};
    o.is_static = is_static;
    write("objects.csv", objectsCsvRows(objects));
  }
  fs::path out_ = fs::path(testing::TempDir()) / "grid_picture_test";
};

TEST_F(GridPicture, NoneWithoutGrids) { EXPECT_FALSE(chooseGrid(out_).has_value()); }

TEST_F(GridPicture, TheGridWithWhatMovesAndWhatMovesInRed) {
  for (Stamp stamp : {1, 2, 3}) writeGrid(stamp);
  writeObject(2, true);
  writeObject(3, false);
  const auto picture = chooseGrid(out_);
  ASSERT_TRUE(picture.has_value());
  ASSERT_EQ(picture->pixels.size(), cv::Size(1000, 1000)) << "100 px a metre";
  const auto at = [&](double x, double y) {  // north is up
    return picture->pixels.at<cv::Vec3b>(static_cast<int>((210.0 - y) * 100.0),
                                         static_cast<int>((x - 100.0) * 100.0));
  };
  EXPECT_EQ(at(107.5, 202.5), cv::Vec3b(0, 0, 0)) << "the occupied cell";
  EXPECT_EQ(at(102.5, 202.5), cv::Vec3b(255, 255, 255)) << "its mirror is free";
  EXPECT_EQ(at(102.5, 207.0), cv::Vec3b(0, 0, 230)) << "left side of the box, red: the grid of stamp 3";
  EXPECT_EQ(at(104.5, 206.0), cv::Vec3b(0, 0, 230)) << "the arrow of its velocity";
}

TEST_F(GridPicture, ARowThatIsNoObjectIsNamed) {
  writeGrid(1);
  writeObject(1, true);
  write("objects.csv", "1,2,three\n");
  try {
    (void)chooseGrid(out_);
    FAIL() << "a bad row was read";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("row 3"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("objects.csv"), std::string::npos);
  }
}

TEST_F(GridPicture, AGridThatNothingPlacesIsRefused) {
  writeGrid(1);
  fs::remove(out_ / "grid/1.yaml");
  EXPECT_THROW((void)chooseGrid(out_), std::runtime_error);
}

}  // namespace
}  // namespace atlas::report
