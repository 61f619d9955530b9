// SPDX-License-Identifier: MIT
#include "atlas/output/trajectory_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "atlas/output/fixed_text.hpp"

namespace atlas {
namespace {

constexpr int kMetreDecimals = 9;  ///< also of quaternions: more than the data hold

/// Nine significant digits for numbers of unknown size.
void appendGeneral(std::string& text, double value) {
  char buffer[40];
  const int length = std::snprintf(buffer, sizeof buffer, "%.9g", value);
  std::replace(buffer, buffer + length, ',', '.');  // locales with a decimal comma
  text.append(buffer, static_cast<std::size_t>(length));
}

void appendDigits(std::string& text, std::uint64_t value, int at_least) {
  char buffer[24];
  int length = 0;
  while (value > 0 || length < at_least) {
    buffer[length++] = static_cast<char>('0' + value % 10);
    value /= 10;
  }
  while (length > 0) text.push_back(buffer[--length]);
}

}  // namespace

void appendFixed(std::string& text, double value, int decimals) {
  double scale = 1.0;
  for (int i = 0; i < decimals; ++i) scale *= 10.0;
  if (!(std::abs(value) * scale < 9.0e15)) {  // NaN, infinity, or more digits than a double holds
    text += fixedText(value, decimals);
    return;
  }
  const auto scaled = static_cast<std::uint64_t>(std::llround(std::abs(value) * scale));
  const auto unit = static_cast<std::uint64_t>(scale);
  if (value < 0.0 && scaled != 0) text.push_back('-');
  appendDigits(text, scaled / unit, 1);
  if (decimals == 0) return;
  text.push_back('.');
  appendDigits(text, scaled % unit, decimals);
}

void appendStampSeconds(std::string& text, Stamp stamp) {
  if (stamp < 0) text.push_back('-');
  const std::uint64_t ns =
      stamp < 0 ? 0 - static_cast<std::uint64_t>(stamp) : static_cast<std::uint64_t>(stamp);
  appendDigits(text, ns / kSecond, 1);
  text.push_back('.');
  appendDigits(text, ns % kSecond, 9);
}

std::string tumLine(const Odometry& odometry) {
  const Eigen::Vector3d& p = odometry.T_map_imu.translation;
  const Eigen::Quaterniond& q = odometry.T_map_imu.rotation;
  std::string line;
  appendStampSeconds(line, odometry.stamp);
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) {
    line.push_back(' ');
    appendFixed(line, value, kMetreDecimals);
  }
  line.push_back('\n');
  return line;
}

std::string kittiLine(const Odometry& odometry) {
  const Eigen::Matrix3d R = odometry.T_map_imu.rotation.toRotationMatrix();
  std::string line;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      if (!line.empty()) line.push_back(' ');
      appendFixed(line, column < 3 ? R(row, column) : odometry.T_map_imu.translation(row), kMetreDecimals);
    }
  }
  line.push_back('\n');
  return line;
}

std::string csvTitle() {
  std::string title = "stamp_ns,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz";
  const char* const axes[6] = {"x", "y", "z", "rx", "ry", "rz"};
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column)
      title += std::string(",cov_") + axes[row] + "_" + axes[column];
  }
  return title + "\n";
}

std::string csvLine(const Odometry& odometry) {
  const Eigen::Vector3d& p = odometry.T_map_imu.translation;
  const Eigen::Quaterniond& q = odometry.T_map_imu.rotation;
  const Eigen::Vector3d& v = odometry.velocity_imu_mps;
  const Eigen::Vector3d& w = odometry.angular_velocity_imu_radps;
  std::string line = std::to_string(odometry.stamp);
  for (const double value :
       {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z()}) {
    line.push_back(',');
    appendFixed(line, value, kMetreDecimals);
  }
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = row; column < 6; ++column) {
      line.push_back(',');
      appendGeneral(line, odometry.pose_covariance[6 * row + column]);
    }
  }
  line.push_back('\n');
  return line;
}

std::string covarianceTitle() {
  std::string title = "stamp_ns,vx,vy,vz";
  for (const char* const part : {"p", "v", "r"}) {
    for (const char* const element : {"xx", "xy", "xz", "yy", "yz", "zz"})
      title += std::string(",cov_") + part + "_" + element;
  }
  return title + "\n";
}

std::string covarianceLine(const Odometry& odometry) {
  std::string line = std::to_string(odometry.stamp);
  for (const double value : odometry.velocity_imu_mps) {
    line.push_back(',');
    appendFixed(line, value, kMetreDecimals);
  }
  const auto appendBlock = [&line](const std::array<double, 36>& covariance, std::size_t first) {
    for (std::size_t row = first; row < first + 3; ++row) {
      for (std::size_t column = row; column < first + 3; ++column) {
        line.push_back(',');
        appendGeneral(line, covariance[6 * row + column]);
      }
    }
  };
  appendBlock(odometry.pose_covariance, 0);
  appendBlock(odometry.twist_covariance, 0);
  appendBlock(odometry.pose_covariance, 3);
  line.push_back('\n');
  return line;
}

}  // namespace atlas
