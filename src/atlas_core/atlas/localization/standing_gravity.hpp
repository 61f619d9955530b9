// SPDX-License-Identifier: MIT
// The direction of gravity from the accelerometer alone, for IMUs that give no orientation: only while the
// vehicle stands, because the acceleration of driving is as large as the tilt it would be mistaken for.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

class StandingGravity {
 public:
  struct Up {
    Eigen::Vector3d direction_imu;  ///< unit
    double span_s;                  ///< averaged over so long
  };
  /// Takes a sample; the mean direction of "up" over half a second of standing. The first half second after a
  /// stop is not used, and a mean is given out half a second late, when the vehicle is seen to have stood on:
  /// the very beginning and end of a motion look like standing. speed: of the vehicle, when known.
  std::optional<Up> add(const ImuSample& sample, std::optional<double> speed_mps, double gravity_mps2);
  void clear() { blocks_ = count_ = 0; }

 private:
  Stamp first_ = 0;
  int blocks_ = 0;  ///< complete blocks of half a second
  int count_ = 0;   ///< samples in the present one
  Eigen::Vector3d sum_ = Eigen::Vector3d::Zero();
  std::optional<Up> held_;  ///< mean of the block before
};

}  // namespace atlas
