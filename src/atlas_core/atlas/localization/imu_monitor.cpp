// SPDX-License-Identifier: MIT
#include "atlas/localization/imu_monitor.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {
namespace {
constexpr double kNoiseMemory_s = 1.0;

double spread(const Eigen::Vector3d& sum, const Eigen::Vector3d& squares, int count) {
  const Eigen::Vector3d mean = sum / count;
  return std::sqrt(std::max(0.0, (squares / count - mean.cwiseProduct(mean)).maxCoeff()));
}
}  // namespace

std::optional<ImuMonitor::Block> ImuMonitor::add(const ImuSample& sample) {
  watchNoise(sample);
  if (count_ == 0) {
    begin_ = sample.stamp;
    gyro_first_ = sample.angular_velocity_radps;
    force_first_ = sample.linear_acceleration_mps2;
    gyro_sum_.setZero();
    gyro_squares_.setZero();
    force_sum_.setZero();
    force_squares_.setZero();
  }
  const Eigen::Vector3d gyro = sample.angular_velocity_radps - gyro_first_;
  const Eigen::Vector3d force = sample.linear_acceleration_mps2 - force_first_;
  gyro_sum_ += gyro;
  gyro_squares_ += gyro.cwiseProduct(gyro);
  force_sum_ += force;
  force_squares_ += force.cwiseProduct(force);
  ++count_;
  if (sample.stamp - begin_ < kBlock) return std::nullopt;
  Block block;
  block.gyro_radps = gyro_first_ + gyro_sum_ / count_;
  block.force_mps2 = force_first_ + force_sum_ / count_;
  block.gyro_spread_radps = spread(gyro_sum_, gyro_squares_, count_);
  block.force_spread_mps2 = spread(force_sum_, force_squares_, count_);
  block.span_s = toSeconds(sample.stamp - begin_);
  block.samples = count_;
  count_ = 0;
  return block;
}

void ImuMonitor::watchNoise(const ImuSample& sample) {
  if (seen_ == 2) {
    const double dt = toSeconds(sample.stamp - last_);
    const double gain = std::min(1.0, dt / kNoiseMemory_s);
    const Eigen::Vector3d gyro = sample.angular_velocity_radps - 2.0 * gyro_[1] + gyro_[0];
    const Eigen::Vector3d force = sample.linear_acceleration_mps2 - 2.0 * force_[1] + force_[0];
    gyro_variance_ += gain * (gyro.squaredNorm() / 18.0 - gyro_variance_);
    force_variance_ += gain * (force.squaredNorm() / 18.0 - force_variance_);
    gyro_density_ = std::sqrt(gyro_variance_ * dt);
    force_density_ = std::sqrt(force_variance_ * dt);
  }
  if (seen_ == 0) {
    gyro_[1] = sample.angular_velocity_radps;
    force_[1] = sample.linear_acceleration_mps2;
  }
  gyro_[0] = gyro_[1];
  force_[0] = force_[1];
  gyro_[1] = sample.angular_velocity_radps;
  force_[1] = sample.linear_acceleration_mps2;
  seen_ = std::min(2, seen_ + 1);
  last_ = sample.stamp;
}

}  // namespace atlas
