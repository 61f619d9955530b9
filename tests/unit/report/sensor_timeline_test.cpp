// SPDX-License-Identifier: MIT
#include "report/sensor_timeline.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

namespace atlas::report {
namespace {

std::filesystem::path fileWith(const std::string& rows) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "status.csv";
  std::ofstream(file) << "stamp_ns,sensor,score,anomalies\n" << rows;
  return file;
}

TEST(SensorTimeline, AStatusLastsUntilTheNextOneOfItsSensor) {
  const auto bands =
      readStatus(fileWith("1000000000,imu,1.000,\n"
                          "1000000000,gnss,1.000,\n"
                          "2000000000,imu,1.000,\n"
                          "2500000000,gnss,0.160,gap=2.100;position_jump=3.000\n"
                          "3500000000,gnss,1.000,\n"
                          "5000000000,imu,1.000,\n"));
  ASSERT_EQ(bands.size(), 2U);
  EXPECT_EQ(bands[0].sensor, "gnss");
  ASSERT_EQ(bands[0].spans.size(), 3U);
  EXPECT_EQ(bands[0].spans[1].begin, 2500000000);
  EXPECT_EQ(bands[0].spans[1].end, 3500000000);
  EXPECT_EQ(bands[0].spans[1].anomalies, (std::vector<std::string>{"gap", "position_jump"}));
  EXPECT_EQ(bands[0].spans[2].end, 5000000000) << "until the end of all";
  ASSERT_EQ(bands[1].spans.size(), 1U) << "the same again is one span";
  const Table table = sensorTable(bands);
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"gnss", "gap 1 s, position_jump 1 s", "0.79", "0.16"}));
  EXPECT_EQ(table.rows[1], (std::vector<std::string>{"imu", "none", "1", "1"}));
  const std::string svg = timelineSvg(bands);
  EXPECT_NE(svg.find(">gap, position_jump</text>"), std::string::npos);
  EXPECT_NE(svg.find(">imu</text>"), std::string::npos);
}

TEST(SensorTimeline, NoFileMakesNothing) {
  EXPECT_TRUE(readStatus("/nowhere/status.csv").empty());
  EXPECT_EQ(timelineSvg({}), "");
}

TEST(SensorTimeline, BrokenRowsAreNamed) {
  const auto said = [](const std::string& rows) {
    try {
      readStatus(fileWith(rows));
    } catch (const std::runtime_error& error) {
      const std::string text = error.what();
      return text.substr(text.find("status.csv"));
    }
    return std::string("nothing");
  };
  EXPECT_EQ(said("1,imu,1.0\n"), "status.csv:2: need 4 fields, got 3");
  EXPECT_EQ(said("1,imu,1.0,\nx,imu,1.0,\n"), "status.csv:3: field 1 (stamp_ns): not a whole number: 'x'");
  EXPECT_EQ(said("1,imu,1.5,\n"), "status.csv:2: field 3 (score): not in 0..1: '1.5'");
}

}  // namespace
}  // namespace atlas::report
