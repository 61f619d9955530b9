// SPDX-License-Identifier: MIT
#include "atlas/output/trajectory_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include "atlas/output/fixed_text.hpp"

namespace atlas {
namespace {

std::string fixed(double value, int decimals) {
  std::string text;
  appendFixed(text, value, decimals);
  return text;
}
std::string seconds(Stamp stamp) {
  std::string text;
  appendStampSeconds(text, stamp);
  return text;
}
Odometry somewhere() {
  Odometry o;
  o.stamp = 1568805602123456789;
  o.T_map_imu = {Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), {12.5, -3.25, 0.0625}};
  return o;
}

TEST(TrajectoryText, tumLineByHand) {
  EXPECT_EQ(tumLine(somewhere()),
            "1568805602.123456789 12.500000000 -3.250000000 0.062500000 0.500000000 -0.500000000 0.500000000 "
            "0.500000000\n");
}

TEST(TrajectoryText, kittiLineIsTheMatrixRowByRow) {
  Odometry o = somewhere();
  o.T_map_imu.rotation = Eigen::Quaterniond(std::sqrt(0.5), 0, 0, std::sqrt(0.5));  // 90 deg to the left
  std::istringstream line(kittiLine(o));
  std::vector<double> m;
  for (double value = 0.0; line >> value;) m.push_back(value);
  const std::vector<double> expected = {0, -1, 0, 12.5, 1, 0, 0, -3.25, 0, 0, 1, 0.0625};
  ASSERT_EQ(m.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) EXPECT_NEAR(m[i], expected[i], 1e-9) << i;
}

TEST(TrajectoryText, csvHasAColumnForEachTitle) {
  Odometry o = somewhere();
  o.velocity_imu_mps = {9.5, 0.25, -0.125};
  for (std::size_t i = 0; i < 36; ++i) o.pose_covariance[i] = 1e-4 * static_cast<double>(i);
  const std::string title = csvTitle(), line = csvLine(o);
  EXPECT_EQ(std::count(title.begin(), title.end(), ','), std::count(line.begin(), line.end(), ','));
  EXPECT_EQ(std::count(title.begin(), title.end(), ','), 13 + 21) << "stamp, 7 + 6 values, 21 covariances";
  EXPECT_EQ(line.rfind("1568805602123456789,12.500000000,-3.250000000,", 0), 0U);
  EXPECT_NE(line.find(",9.500000000,0.250000000,-0.125000000,"), std::string::npos);
  EXPECT_NE(title.find("cov_x_x,cov_x_y,cov_x_z,cov_x_rx"), std::string::npos);
  EXPECT_NE(title.find("cov_rz_rz\n"), std::string::npos);
  EXPECT_NE(line.find(",0.0035\n"), std::string::npos) << "cov_rz_rz is the last element";
}

TEST(TrajectoryText, covarianceLineHasVelocityAndThreeUpperTriangles) {
  Odometry o = somewhere();
  o.velocity_imu_mps = {9.5, 0.25, -0.125};
  for (std::size_t i = 0; i < 36; ++i) {
    o.pose_covariance[i] = static_cast<double>(i);
    o.twist_covariance[i] = 100.0 + static_cast<double>(i);
  }
  EXPECT_EQ(covarianceLine(o),
            "1568805602123456789,9.500000000,0.250000000,-0.125000000,"
            "0,1,2,7,8,14,100,101,102,107,108,114,21,22,23,28,29,35\n");
  EXPECT_EQ(covarianceTitle(),
            "stamp_ns,vx,vy,vz,cov_p_xx,cov_p_xy,cov_p_xz,cov_p_yy,cov_p_yz,cov_p_zz,"
            "cov_v_xx,cov_v_xy,cov_v_xz,cov_v_yy,cov_v_yz,cov_v_zz,"
            "cov_r_xx,cov_r_xy,cov_r_xz,cov_r_yy,cov_r_yz,cov_r_zz\n");
}

TEST(TrajectoryText, stampsAreExactToTheNanosecond) {
  EXPECT_EQ(seconds(0), "0.000000000");
  EXPECT_EQ(seconds(1), "0.000000001");
  EXPECT_EQ(seconds(999'999'999), "0.999999999");
  EXPECT_EQ(seconds(-1'500'000'000), "-1.500000000");
  EXPECT_EQ(seconds(std::numeric_limits<Stamp>::max()), "9223372036.854775807");
  EXPECT_EQ(seconds(std::numeric_limits<Stamp>::min()), "-9223372036.854775808");
}

// Halves of the last decimal may go either way (one way counts in decimal digits, the other in binary ones),
// so the strings are compared where there is none.
TEST(TrajectoryText, numbersAgreeWithTheSlowWay) {
  std::mt19937_64 random(9);
  for (int i = 0; i < 20000; ++i) {
    const int decimals = static_cast<int>(random() % 10);
    const double unit = std::pow(10.0, -decimals);
    const auto whole = static_cast<double>(static_cast<std::int64_t>(random() >> (24 + random() % 30)));
    const double value = (random() % 2 == 0 ? 1.0 : -1.0) * (whole + 0.3) * unit;
    ASSERT_EQ(fixed(value, decimals), fixedText(value, decimals)) << value << " " << decimals;
  }
}

TEST(TrajectoryText, edges) {
  EXPECT_EQ(fixed(0.0, 3), "0.000");
  EXPECT_EQ(fixed(-0.0, 3), "0.000");
  EXPECT_EQ(fixed(-0.0004, 3), "0.000") << "no minus zero";
  EXPECT_EQ(fixed(-0.0006, 3), "-0.001");
  EXPECT_EQ(fixed(0.9996, 3), "1.000");
  EXPECT_EQ(fixed(42.4, 0), "42");
  EXPECT_EQ(fixed(std::nan(""), 3), "nan");
  EXPECT_EQ(fixed(-std::numeric_limits<double>::infinity(), 3), "-inf");
  EXPECT_EQ(fixed(1e20, 3), "100000000000000000000.000");
}

TEST(TrajectoryText, theLocaleHasNoInfluence) {
  Odometry o = somewhere();
  o.pose_covariance[0] = 0.00123;
  const std::string before = tumLine(o) + csvLine(o);
  const std::string old = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "cs_CZ.UTF-8", "fr_FR.UTF-8", "de_DE"}) {
    if (std::setlocale(LC_ALL, name) == nullptr) continue;  // not installed
    EXPECT_EQ(tumLine(o) + csvLine(o), before) << name;
  }
  std::setlocale(LC_ALL, old.c_str());
}

}  // namespace
}  // namespace atlas
