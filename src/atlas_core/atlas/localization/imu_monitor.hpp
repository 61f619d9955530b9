// SPDX-License-Identifier: MIT
// What the IMU's signal says about itself: white noise (vibration included) from second differences, and
// blocks of 0.2 s whose means and spreads tell standing from moving.
//
//   x(k) - 2 x(k-1) + x(k-2) of white noise has 6 times its variance; slow motion drops out
#pragma once

#include <optional>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

class ImuMonitor {
 public:
  struct Block {
    Eigen::Vector3d gyro_radps, force_mps2;                   ///< means
    double gyro_spread_radps = 0.0, force_spread_mps2 = 0.0;  ///< standard deviation of the noisiest axis
    double span_s = 0.0;
    int samples = 0;
  };
  /// Takes the next sample; a block when one is complete.
  std::optional<Block> add(const ImuSample& sample);
  /// Samples before are not continued.
  void clear() { count_ = seen_ = 0; }

  /// Spectral densities of the white noise over the last second or so.
  [[nodiscard]] double gyroDensity() const { return gyro_density_; }
  [[nodiscard]] double forceDensity() const { return force_density_; }

 private:
  static constexpr Duration kBlock = kSecond / 5;
  void watchNoise(const ImuSample& sample);

  int count_ = 0;  ///< samples in the present block
  int seen_ = 0;   ///< samples in a row, up to 2
  Stamp begin_ = 0, last_ = 0;
  Eigen::Vector3d gyro_sum_, gyro_squares_, force_sum_, force_squares_;
  Eigen::Vector3d gyro_first_, force_first_;  ///< subtracted, so that the squares keep their digits
  Eigen::Vector3d gyro_[2], force_[2];        ///< the two samples before
  double gyro_density_ = 0.0, force_density_ = 0.0;
  double gyro_variance_ = 0.0, force_variance_ = 0.0;
};

}  // namespace atlas
