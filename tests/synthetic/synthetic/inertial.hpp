// SPDX-License-Identifier: MIT
// The text streams of the IMU and of the GNSS receiver, as in the Brno Urban Dataset.
#pragma once

#include <filesystem>
#include <vector>

#include "synthetic/random.hpp"
#include "synthetic/world.hpp"

namespace atlas::synthetic {

constexpr Duration kImuPeriod = 2'500'000;  ///< ns, 400 Hz

/// Stamps of imu/imu.txt: a perfect grid, 1.000287 ms after the start as in the real sample.
std::vector<Stamp> imuStamps(const World& world);

/// An Xsens MTi-G-710: turn-on bias, slow bias, white noise, its own slow orientation filter.
struct ImuReading {
  Eigen::Vector3d angular_velocity_radps, specific_force_mps2;
  Eigen::Quaterniond orientation, increment;  ///< R_enu_imu of its own filter; R_previous_now from the gyros
};
class ImuModel {
 public:
  explicit ImuModel(const World& world);
  /// Readings in order of time.
  ImuReading read(Stamp stamp);

 private:
  const World& world_;
  Random random_;
  Eigen::Vector3d gyro_bias_, accel_bias_;  ///< at switching on
  std::vector<GaussMarkov> slow_;           ///< gyro x y z, accelerometer x y z, roll, pitch, magnetic yaw
};

/// imu/{imu,d_quat,gnss,mag,pressure,temp,time}.txt. Accelerations have the dataset's inverted sign.
void writeImu(const World& world, const std::filesystem::path& folder);
/// gnss/{pose,time}.txt: rear antenna; azimuth 0 where the receiver has no heading (after a gap of 0.5 s each
/// 40 s).
void writeGnss(const World& world, const std::filesystem::path& folder);
/// radar_ti/scans.txt: up to 12 targets at 20 Hz; velocity is the range rate, positive when the target goes
/// away.
void writeRadar(const World& world, const std::filesystem::path& folder);

}  // namespace atlas::synthetic
