// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "report/run_tables.hpp"

namespace atlas::report {
namespace {

using nlohmann::json;
using Rows = std::vector<std::vector<std::string>>;

TEST(DatasetTable, framesThenClassesThenWhatIsMissing) {
  const json card = json::parse(R"({
    "frames": {"train": 1200, "val": 3, "test": 0},
    "classes": {"car": {"id": 2, "boxes": {"train": 40, "val": 5, "test": 6},
                        "sizes": {"small": 1, "medium": 2, "large": 48}}},
    "dropped": {"label: unknown class id": 7}})");
  EXPECT_EQ(datasetTable(card).rows,
            (Rows{{"frames", "1 200", "3", "0", "", "", ""}, {"car", "40", "5", "6", "1", "2", "48"}}));
  EXPECT_EQ(droppedTable(card).rows, (Rows{{"label: unknown class id", "7"}}));
}

TEST(DatasetTable, aCardWithoutContentsMakesNothing) {
  EXPECT_TRUE(datasetTable(json::object()).rows.empty());
  EXPECT_TRUE(droppedTable(json::object()).rows.empty());
}

}  // namespace
}  // namespace atlas::report
