// SPDX-License-Identifier: MIT
// Rows of the dataset, with samples of a real record of 2019-09-11, and the gravity test.
#include "record/bud_rows.hpp"

#include <gtest/gtest.h>

#include "record/gravity_test.hpp"
#include "small_record.hpp"

namespace atlas::record {
namespace {

class BudRows : public ::testing::Test {
 protected:
  RowFields& of(const std::string& text) {
    text_ = text;
    fields_.assign(Line{text_, 1, 0, false});
    return fields_;
  }
  std::string text_;
  RowFields fields_{"file.txt", ','};
};

const char* const kImuRow =
    "1568186745408734467, 0.346637, -0.395, -9.55036, -0.00194611, 0.00642984, 0.00237526, 0.016559, "
    "0.0288746, "
    "0.0474863, 0.998317\r";

TEST_F(BudRows, Imu) {
  const ImuSample plain = parseImu(of(kImuRow), {});
  ASSERT_TRUE(fields_.ok()) << fields_.example();
  EXPECT_EQ(plain.stamp, 1'568'186'745'408'734'467);
  EXPECT_TRUE(plain.linear_acceleration_mps2.isApprox(Eigen::Vector3d(0.346637, -0.395, -9.55036)));
  EXPECT_TRUE(plain.angular_velocity_radps.isApprox(Eigen::Vector3d(-0.00194611, 0.00642984, 0.00237526)));
  ASSERT_TRUE(plain.orientation);
  EXPECT_NEAR(plain.orientation->norm(), 1.0, 1e-12);
  EXPECT_NEAR(plain.orientation->x(), 0.016559, 1e-6);
  const ImuSample corrected = parseImu(of(kImuRow), {5'000'000, true});
  EXPECT_EQ(corrected.stamp, plain.stamp - 5'000'000);
  EXPECT_TRUE(corrected.linear_acceleration_mps2.isApprox(-plain.linear_acceleration_mps2))
      << "all three axes";
  EXPECT_TRUE(corrected.angular_velocity_radps.isApprox(plain.angular_velocity_radps))
      << "rates keep their sign";
}

TEST_F(BudRows, ImuWithoutARotationHasNoOrientation) {
  const ImuSample sample = parseImu(of("1568186745408734467, 0, 0, -9.8, 0, 0, 0, 0, 0, 0, 0"), {});
  EXPECT_TRUE(fields_.ok());
  EXPECT_FALSE(sample.orientation);
  parseImu(of("1568186745408734467, 0, 0, -9.8, 0, 0, 0, 0, 0, 0"), {});
  EXPECT_EQ(fields_.reason(), "too few fields");
}

TEST_F(BudRows, OtherImuFiles) {
  EXPECT_TRUE(parseMagnetic(of("1568186745410202085, 0.240066, 0.943281, -1.00343"), {})
                  .field.isApprox(Eigen::Vector3d(0.240066, 0.943281, -1.00343)));
  EXPECT_EQ(parseScalar(of("1568186745410202085, 98879"), {}, "pressure").value, 98879.0);
  EXPECT_EQ(parseScalar(of("1568186745407734180, 29.0625"), {}, "temperature").value, 29.0625);
  const TimeReference time =
      parseTime(of("1568186745407734180, 2019, 9, 11, 7, 25, 45, 403600000"), {}, "imu");
  EXPECT_TRUE(fields_.ok());
  EXPECT_EQ(time.stamp - time.sensor_time, 4'134'180)
      << "the latency that the format's description has measured";
  EXPECT_EQ(time.source, "imu");
  parseTime(of("1568186745407734180, 2019, 13, 11, 7, 25, 45, 403600000"), {}, "imu");
  EXPECT_EQ(fields_.reason(), "not a date");
}

TEST_F(BudRows, GnssPose) {
  const std::string row = "1568186745436549395, 49.22810527, 16.57547959, 281.368, 63.5158";
  const GnssFix fix = parseFix(of(row), {}, 5);
  ASSERT_TRUE(fields_.ok());
  EXPECT_EQ(fix.position.latitude_deg, 49.22810527);
  EXPECT_EQ(fix.position.longitude_deg, 16.57547959);
  EXPECT_EQ(fix.position.altitude_m, 281.368);
  EXPECT_EQ(fix.frame, "gnss_rear");
  EXPECT_FALSE(fix.covariance_enu_m2) << "the receiver writes none";
  const auto heading = parseHeading(of(row), {});
  ASSERT_TRUE(heading);
  EXPECT_NEAR(heading->yaw_rad, (90.0 - 63.5158) * M_PI / 180.0, 1e-12)
      << "clockwise from north becomes REP-103 yaw";
}

TEST_F(BudRows, AzimuthExactlyZeroIsNoHeading) {
  EXPECT_FALSE(parseHeading(of("1568186745436549395, 49.2, 16.5, 281, 0"), {}));
  EXPECT_TRUE(fields_.ok()) << "the position of the row is good";
  const auto north = parseHeading(of("1568186745436549395, 49.2, 16.5, 281, 360"), {});
  ASSERT_TRUE(north);
  EXPECT_NEAR(north->yaw_rad, M_PI / 2, 1e-12);
  parseHeading(of("1568186745436549395, 49.2, 16.5, 281, 361"), {});
  EXPECT_EQ(fields_.reason(), "azimuth out of range");
}

TEST_F(BudRows, PositionHasToBeOnEarth) {
  parseFix(of("1568186745436549395, 149.2, 16.5, 281"), {}, 4);
  EXPECT_EQ(fields_.reason(), "position out of range");
  parseFix(of("1568186745436549395, 0, 0, 0"), {}, 4);
  EXPECT_EQ(fields_.reason(), "no position");
}

TEST_F(BudRows, Radar) {
  const RadarScan scan = parseRadar(of("1568186745436549395, 2, 10.5, 1, 0.5, -3.25, 20, -2, 0, 1e-1"), {});
  ASSERT_TRUE(fields_.ok()) << fields_.example();
  ASSERT_EQ(scan.targets.size(), 2U);
  EXPECT_TRUE(scan.targets[0].position.isApprox(Eigen::Vector3d(10.5, 1, 0.5)));
  EXPECT_EQ(scan.targets[0].radial_velocity_mps, -3.25);
  EXPECT_EQ(scan.targets[1].radial_velocity_mps, 0.1);
  EXPECT_TRUE(parseRadar(of("1568186745436549395, 0"), {}).targets.empty());
  EXPECT_TRUE(fields_.ok());
  parseRadar(of("1568186745436549395, 2, 10.5, 1, 0.5, -3.25"), {});
  EXPECT_EQ(fields_.reason(), "too few fields");
  parseRadar(of("1568186745436549395, -1"), {});
  EXPECT_EQ(fields_.reason(), "out of range");
}

using Sign = GravityVerdict::Sign;

GravityVerdict verdictOn(const std::string& text) {
  const test::TemporaryFolder folder;
  return testGravity(folder.write("imu.txt", text));
}

TEST(GravityTest, DecidesBySamplesNotByFaith) {
  EXPECT_EQ(verdictOn(test::imuText(100, -9.81)).sign, Sign::kInverted);
  EXPECT_EQ(verdictOn(test::imuText(100, +9.81)).sign, Sign::kUp);
  EXPECT_EQ(verdictOn(test::imuText(100, 0.3)).sign, Sign::kUndecided);
  EXPECT_EQ(verdictOn("").sign, Sign::kUndecided);
  EXPECT_EQ(verdictOn("garbage\n" + test::imuText(3, -9.81)).samples, 3U);
}

TEST(GravityTest, TurnsTheSampleIntoTheWorld) {
  // IMU upside down: its z axis points down, so at rest a correct accelerometer says -g along z.
  const std::string row = ", 0, 0, -9.81, 0, 0, 0, 1, 0, 0, 0";
  EXPECT_EQ(verdictOn(test::rows(20, 2'500'000, [&](int) { return row; })).sign, Sign::kUp);
}

TEST(GravityTest, WithoutOrientationTheLevelAxisDecides) {
  const std::string row = ", 0, 0, -9.81, 0, 0, 0, 0, 0, 0, 0";
  EXPECT_EQ(verdictOn(test::rows(20, 2'500'000, [&](int) { return row; })).sign, Sign::kInverted);
}

}  // namespace
}  // namespace atlas::record
