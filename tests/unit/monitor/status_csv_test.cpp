// SPDX-License-Identifier: MIT
#include "atlas/output/status_csv.hpp"

#include <gtest/gtest.h>

namespace atlas {
namespace {

TEST(StatusCsv, OneRowAStatus) {
  EXPECT_EQ(statusCsvHeader(), "stamp_ns,sensor,score,anomalies\n");
  EXPECT_EQ(statusCsvRow({1568186745407734180, "imu", 1.0, {}}), "1568186745407734180,imu,1.000,\n");
  const SensorStatus two{
      5, "gnss", 0.64, {{"gap", 9.86, 1.7, "periods", 1}, {"heading_lost", 1.2, 1, "s", 2}}};
  EXPECT_EQ(statusCsvRow(two), "5,gnss,0.640,gap=9.860;heading_lost=1.200\n");
}

}  // namespace
}  // namespace atlas
