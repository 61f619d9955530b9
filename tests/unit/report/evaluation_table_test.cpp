// SPDX-License-Identifier: MIT
#include "report/evaluation_table.hpp"

#include <gtest/gtest.h>

namespace atlas::report {
namespace {

using Json = nlohmann::ordered_json;

/// Cells of all rows as "a|b|c\n", headers included.
std::string cellsOf(const std::string& html) {
  std::string text;
  for (std::size_t at = 0; at < html.size();) {
    if (html.compare(at, 5, "</td>") == 0 || html.compare(at, 5, "</th>") == 0) text += '|';
    if (html.compare(at, 5, "</tr>") == 0) text += '\n';
    if (html[at] == '<') {
      at = html.find('>', at) + 1;
    } else {
      if (html[at] != '\n') text += html[at];
      ++at;
    }
  }
  return text;
}

TEST(EvaluationTable, StatisticsAndNumbersBecomeRowsInTheirOrder) {
  const Json evaluation = Json::parse(R"({
    "trajectory": {
      "horizontal_error_m": {"count": 12000, "median": 0.0117, "rmse": 0.015, "p95": 0.0266, "max": 0.092},
      "stamps_answered_percent": 99.57},
    "depth_camera_ir": {"error_m": {"count": 3, "median": 0.5, "rmse": 0.5, "p95": 0.5, "max": 0.5}, "frames": 90}})");
  const std::string cells = cellsOf(evaluationHtml(evaluation));
  EXPECT_NE(cells.find("trajectory: horizontal error|0.0117|0.015|0.0266|0.092|12 000|m|\n"
                       "trajectory: stamps answered|99.57|||||%|\n"
                       "depth camera ir: error|0.5|0.5|0.5|0.5|3|m|\n"
                       "depth camera ir: frames|90||||||\n"),
            std::string::npos)
      << cells;
}

TEST(EvaluationTable, PartsAndWhatWasNotComparedAreFoldedAway) {
  const Json evaluation = Json::parse(R"({
    "points": {"distortion_m": {"count": 2, "median": 0.01, "rmse": 0.01, "p95": 0.01, "max": 0.01},
               "lidar_left": {"returns_invented": 7}},
    "skipped": {"depth: no such <folder>": 1}})");
  const std::string html = evaluationHtml(evaluation);
  const std::size_t parts = html.find("<details>");
  ASSERT_NE(parts, std::string::npos);
  EXPECT_NE(cellsOf(html.substr(0, parts)).find("points: distortion|0.01|"), std::string::npos);
  EXPECT_EQ(html.substr(0, parts).find("lidar"), std::string::npos);
  EXPECT_EQ(html.substr(0, parts).find("no such"), std::string::npos);
  EXPECT_NE(cellsOf(html.substr(parts)).find("points, lidar left: returns invented|7|"), std::string::npos);
  EXPECT_NE(html.find("depth: no such &lt;folder&gt;"), std::string::npos);
}

TEST(EvaluationTable, NothingMakesNothing) {
  EXPECT_EQ(evaluationHtml(Json::object()), "");
  EXPECT_EQ(evaluationHtml(Json::parse(R"(["a"])")), "");
  const std::string html = evaluationHtml(Json::parse(R"({"points": {"error_m": {"median": 1.0}}})"));
  EXPECT_NE(cellsOf(html).find("points: error|1|n/a|n/a|n/a|n/a|m|"), std::string::npos);
}

}  // namespace
}  // namespace atlas::report
