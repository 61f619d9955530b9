// SPDX-License-Identifier: MIT
// Velodyne HDL-32E on a moving car. One scan is one revolution of columns; every column fires its 32 lasers
// at its own time, from where the car is then, at where everything else is then. Conventions: point index =
// column * 32 + laser, laser 0 is the lowest; a column takes 46.08 us; azimuth starts at the +x axis of the
// lidar frame and goes clockwise seen from above; the scan's stamp is the time of its LAST column.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "synthetic/random.hpp"
#include "synthetic/world.hpp"

namespace atlas::synthetic {

constexpr int kLasers = 32;
constexpr Duration kColumn = 46080;          ///< ns, HDL-32E manual: 32 lasers * 1.152 us + recharge
constexpr double kLowestLaser_deg = -30.67;  ///< HDL-32E manual, table of vertical angles
constexpr double kLaserStep_deg = 41.34 / 31.0;
constexpr float kLidarRange = 100.0F;  ///< m

struct LidarReturn {
  float x = 0, y = 0, z = 0, intensity = 0;  ///< as in the PCD; all zero = no return
};
struct TruthPoint {
  float x, y, z;  ///< map, without noise; NaN = no return
  float object;   ///< object id; 0 = static city
};
struct LidarScan {
  Stamp stamp = 0;
  int columns = 0;
  std::vector<LidarReturn> points;
  std::vector<TruthPoint> truth;  ///< same order; filled when asked for
};

class Lidar {
 public:
  /// `name`: lidar_left (15th row from below is dead) or lidar_right (18th row).
  Lidar(const World& world, const std::string& name);
  /// Next revolution, in order.
  [[nodiscard]] LidarScan next(bool with_truth);
  /// Stamp that the next revolution will have.
  [[nodiscard]] Stamp nextStamp() const { return next_begin_ + (next_columns_ - 1) * kColumn; }
  [[nodiscard]] static Stamp columnStamp(Stamp scan_stamp, int columns, int column) {
    return scan_stamp - static_cast<Duration>(columns - 1 - column) * kColumn;
  }
  /// Direction of a laser at an azimuth (clockwise from +x), lidar frame.
  [[nodiscard]] static Eigen::Vector3d direction(double azimuth_rad, int laser);

 private:
  struct Candidate;
  struct Frame;
  [[nodiscard]] Frame prepareFrame(const LidarScan& scan) const;
  void fire(const Frame& frame, int column, LidarScan& scan);
  void planNext();

  const World& world_;
  std::string name_;
  Pose T_imu_lidar_;
  int dead_laser_;
  Random random_, rotation_random_;
  Stamp next_begin_ = 0;
  int next_columns_ = 0;
};

}  // namespace atlas::synthetic
