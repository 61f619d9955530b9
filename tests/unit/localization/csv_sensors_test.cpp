// SPDX-License-Identifier: MIT
#include "csv_sensors.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace atlas_localization {
namespace {

std::filesystem::path written(const std::string& name, const std::string& text) {
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / name;
  std::ofstream(path) << text;
  return path;
}
constexpr const char* kImuHead = "stamp_ns,ax,ay,az,gx,gy,gz\n";
constexpr const char* kGnssHead = "stamp_ns,lat,lon,alt,sd_e,sd_n,sd_u,heading_deg,sd_heading\n";

template <class Action>
std::string messageOf(const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

TEST(CsvSensors, GoodRows) {
  ImuCsv imu(written("good_imu.csv", std::string(kImuHead) + "1000,0.1,0.2,9.8,0.01,0.02,0.03\n"));
  const auto sample = imu.next();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->stamp, 1000);
  EXPECT_EQ(sample->linear_acceleration_mps2, Eigen::Vector3d(0.1, 0.2, 9.8));
  EXPECT_EQ(sample->angular_velocity_radps, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_FALSE(sample->orientation);
  GnssCsv gnss(written("good_gnss.csv", std::string(kGnssHead) + "5,49,16,200,0.1,0.2,0.3,90,3\n"
                                                                 "6,49,16,200,0.1,0.2,0.3,,\n"));
  const auto row = gnss.next();
  ASSERT_TRUE(row && row->heading);
  EXPECT_NEAR(row->heading->yaw_rad, 0.0, 1e-12);  // east
  EXPECT_NEAR((*row->fix.covariance_enu_m2)[4], 0.04, 1e-12);
  const auto second = gnss.next();
  ASSERT_TRUE(second);
  EXPECT_FALSE(second->heading);
}

TEST(CsvSensors, BadRowsAreCountedWithLineFieldAndValue) {
  ImuCsv imu(written("bad_imu.csv", std::string(kImuHead) + "1000,0,0,9.8,0,0,0\n"
                                                            "2000,0,nan,9.8,0,0,0\n"
                                                            "1500,0,0,9.8,0,0,0\n"
                                                            "900,0,0,9.8,0,0,0\n"
                                                            "3000,0,0,9.8,0,0\n"
                                                            "4000,0,0,9.8,0,0,99\n"));
  int used = 0;
  while (imu.next()) ++used;
  EXPECT_EQ(used, 2);
  const atlas::FileReport& report = imu.rows().report();
  EXPECT_EQ(report.rows, 6u);
  EXPECT_EQ(report.used, 2u);
  ASSERT_EQ(report.examples.size(), 4u);
  EXPECT_NE(report.examples[0].find("bad_imu.csv:3: field 3 (ay): not finite: 'nan'"), std::string::npos);
  EXPECT_NE(report.examples[1].find(":5: field 1 (stamp_ns): not after the one before: '900'"),
            std::string::npos);
  EXPECT_NE(report.examples[3].find("field 7 (gz): beyond 40 rad/s: '99'"), std::string::npos);
  GnssCsv gnss(written("bad_gnss.csv", std::string(kGnssHead) + "5,91,16,200,0.1,0.2,0.3,,\n"
                                                                "6,49,16,200,0.1,0,0.3,,\n"));
  EXPECT_FALSE(gnss.next());
  EXPECT_NE(gnss.rows().report().examples[1].find("field 6 (sd_n): not positive: '0'"), std::string::npos);
}

TEST(CsvSensors, WrongHeaderAndMissingFileAreRefused) {
  EXPECT_NE(messageOf([] { ImuCsv imu("/nowhere/imu.csv"); }).find("cannot be opened"), std::string::npos);
  const auto path = written("head_imu.csv", "stamp_ns,ax,ay,az,gx,gz,gy\n");
  EXPECT_NE(messageOf([&] { ImuCsv imu(path); }).find("field 6 must be 'gy', got 'gz'"), std::string::npos);
}

TEST(CsvSensors, UnitsAreJudged) {
  const auto judged = [](const std::string& row) {
    ImuCsv imu(written("units_imu.csv", kImuHead + row));
    while (imu.next()) {
    }
    return messageOf([&] { imu.checkUnits(); });
  };
  EXPECT_EQ(judged("1,0,0,9.8,0,0,0\n"), "");
  EXPECT_NE(judged("1,0,0,1.0,0,0,0\n").find("in g"), std::string::npos);
  EXPECT_NE(judged("1,0,0,-9.8,0,0,0\n").find("point up"), std::string::npos);
  EXPECT_NE(judged("1,0,9.8,0,0,0,0\n").find("z is not up"), std::string::npos);
  EXPECT_NE(judged("1,0,0,9.8,0,0,12\n").find("in degrees?"), std::string::npos);
  EXPECT_NE(judged("").find("no usable row"), std::string::npos);
}

}  // namespace
}  // namespace atlas_localization
