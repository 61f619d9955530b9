// SPDX-License-Identifier: MIT
// A drive towards a wall with lines asked for: what lines.csv says of it.
#include "files/line_writer.hpp"

#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "files/writer_stages.hpp"
#include "small_drive.hpp"
#include "temporary_folder.hpp"

namespace atlas::test {
namespace {

/// The rows of OUT/lines/lines.csv after a run of all sensors of the drive, split at their commas.
std::vector<std::vector<std::string>> rowsOf(const SmallDrive& drive, const TemporaryFolder& out) {
  PipelineParams params;
  params.lines.emplace();
  LocalGraph graph;
  addPipeline(graph, params);
  graph.add([&](LocalGraph::Bus& bus) { return bindLineWriter(bus, {}, out.path().string()); });
  for (const SourceEvent& event : drive.events()) event.publish(graph);
  graph.finish();
  std::istringstream text(out.read("lines/lines.csv"));
  std::vector<std::vector<std::string>> rows;
  for (std::string row; std::getline(text, row);) {
    std::istringstream fields(row);
    rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

TEST(LineWriter, LinesOfBothLidarsLieOnTheWall) {
  const TemporaryFolder out;
  const SmallDrive drive(1.0);
  const auto rows = rowsOf(drive, out);
  ASSERT_FALSE(rows.empty());
  const std::string header = kLineHeader;
  EXPECT_EQ(rows[0].size(), static_cast<std::size_t>(std::count(header.begin(), header.end(), ',') + 1));
  std::map<std::string, int> lines;  // of each lidar
  for (std::size_t i = 1; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), rows[0].size()) << "row " << i;
    const auto number = [&](std::size_t column) { return std::stod(rows[i][column]); };
    EXPECT_EQ(number(2), lines[rows[i][1]]++ % 50) << "one line up each of the 50 columns, a sweep";
    EXPECT_EQ(rows[i][3], "surface");
    // Exact sensors: what is left is the filter's error of position and heading, at 30 m.
    for (const std::size_t x : {5U, 8U}) EXPECT_NEAR(number(x), kWall_m, 0.05) << "row " << i;
    EXPECT_NEAR(number(6), number(9), 0.02) << "upright";
    EXPECT_NEAR(std::abs(number(10) - number(7)), 4.0, 0.05) << "11 returns, 0.4 m apart; the lowest is road";
    EXPECT_EQ(number(11), 11);
  }
  ASSERT_EQ(lines.size(), 2U);
  for (const auto& [lidar, count] : lines)
    EXPECT_GE(count, 8 * 50) << lidar << ": of ten sweeps, once there is a pose";
}

}  // namespace
}  // namespace atlas::test
