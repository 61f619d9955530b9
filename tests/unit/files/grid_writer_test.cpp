// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "files/grid_writer_stage.hpp"

namespace atlas {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

class GridWriterStageTest : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(out_); }
  void TearDown() override { fs::remove_all(out_); }
  static OccupancyMapPtr mapAt(Stamp stamp, bool cells = true) {
    auto map = std::make_shared<OccupancyMap>();
    map->stamp = stamp;
    if (!cells) return map;
    map->resolution_m = 0.5F;
    map->columns = map->rows = 1;
    map->percent = {100};
    return map;
  }
  std::vector<std::string> grids() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(out_ / "grid")) {
      if (entry.path().extension() == ".pgm") names.push_back(entry.path().stem());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  /// One frame's answers, in the order that the stage gives them.
  static void give(GridWriterStage& stage, Stamp stamp, bool cells,
                   const std::optional<CollisionRisk>& risk) {
    stage.push(mapAt(stamp, cells));
    auto objects = std::make_shared<Objects>();
    objects->stamp = stamp;
    objects->objects.resize(1);
    objects->objects[0].id = 3;
    stage.push(ObjectsPtr(objects));
    stage.push(RiskAnswer{stamp, risk});
  }
  fs::path out_ = fs::path(testing::TempDir()) / "grid_writer_test";
};

TEST_F(GridWriterStageTest, OneGridAPeriodAndEveryObjectAndRisk) {
  CollisionRisk risk;
  risk.total = 0.25;
  risk.unknown_share = 0.5;
  risk.expected_time_s = 1.5;
  risk.object = 3U;
  GridWriterParams params;
  params.period_s = 1.0;
  GridWriterStage stage(params, out_);
  const Stamp first = 10 * kSecond + 900 * kMillisecond;
  for (int i = 0; i < 5; ++i)
    give(stage, first + i * 300 * kMillisecond, i != 0, i == 1 ? std::optional(risk) : std::nullopt);
  for (const auto input : {GridWriterStage::kGrid, GridWriterStage::kObjects, GridWriterStage::kRisk})
    stage.finish(input);
  // 10.9 (no cells), 11.2, 11.5, 11.8, 12.1 s: the first ones with cells of the seconds 11 and 12
  EXPECT_EQ(grids(), (std::vector<std::string>{"11200000000", "12100000000"}));
  EXPECT_NE(contentOf(out_ / "grid/11200000000.yaml").find("image: 11200000000.pgm\n"), std::string::npos);
  const std::string risks = contentOf(out_ / "grid/risk.csv");
  EXPECT_NE(risks.find("10900000000,0,,,,\n11200000000,1,0.250000,1.500,3,0.500000\n11500000000,0,,,,\n"),
            std::string::npos)
      << risks;
  const std::string objects = contentOf(out_ / "grid/objects.csv");
  EXPECT_EQ(std::count(objects.begin(), objects.end(), '\n'), 1 + 5);
  EXPECT_EQ(stage.counters().all().at("grids"), 2U);
}

TEST_F(GridWriterStageTest, PeriodZeroWritesAll) {
  GridWriterParams params;
  params.period_s = 0.0;
  GridWriterStage stage(params, out_);
  for (Stamp stamp : {1, 2, 3}) give(stage, stamp, true, std::nullopt);
  for (const auto input : {GridWriterStage::kGrid, GridWriterStage::kObjects, GridWriterStage::kRisk})
    stage.finish(input);
  EXPECT_EQ(grids(), (std::vector<std::string>{"1", "2", "3"}));
}

TEST_F(GridWriterStageTest, AStageThatIsStoppedLeavesCompleteFiles) {
  {
    GridWriterStage stage({}, out_);
    give(stage, kSecond, true, std::nullopt);
    for (const auto input : {GridWriterStage::kGrid, GridWriterStage::kObjects, GridWriterStage::kRisk})
      stage.advance(input, kSecond);
  }
  EXPECT_TRUE(fs::exists(out_ / "grid/objects.csv"));
  EXPECT_TRUE(fs::exists(out_ / "grid/risk.csv"));
}

TEST_F(GridWriterStageTest, ABadPeriodIsNamed) {
  GridWriterParams params;
  params.period_s = -1.0;
  EXPECT_THROW(validate(params), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
