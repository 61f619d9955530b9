// SPDX-License-Identifier: MIT
#include "atlas/lidar/point_filter.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace atlas {
namespace {

constexpr std::size_t kRings = 65536;

bool hasReturn(const LidarPoint& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// The newest return of each ring, for rings up to the highest one met.
class LastReturns {
 public:
  /// Whether the ring's last return lies exactly there; remembers this one.
  bool repeats(const LidarPoint& p) {
    if (p.ring >= last_.size()) last_.resize(static_cast<std::size_t>(p.ring) + 1, nullptr);
    const LidarPoint* before = last_[p.ring];
    last_[p.ring] = &p;
    return before != nullptr && before->x == p.x && before->y == p.y && before->z == p.z;
  }

 private:
  std::vector<const LidarPoint*> last_;
};

}  // namespace

std::optional<VehicleBox> vehicleBoxFrom(const std::vector<double>& limits_m) {
  if (limits_m.empty()) return std::nullopt;
  if (limits_m.size() != 6) {
    throw std::invalid_argument("vehicle_box_m must have no or 6 values (x y z lowest, x y z highest), got " +
                                std::to_string(limits_m.size()));
  }
  VehicleBox box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lowest[axis] = limits_m[static_cast<std::size_t>(axis)];
    box.highest[axis] = limits_m[static_cast<std::size_t>(axis) + 3];
    if (!(box.lowest[axis] < box.highest[axis])) {
      throw std::invalid_argument("vehicle_box_m: lowest must be below highest, got " +
                                  std::to_string(box.lowest[axis]) + " and " +
                                  std::to_string(box.highest[axis]));
    }
  }
  return box;
}

FilteredSweep filterPoints(const SweepPtr& sweep, const PointFilter& filter, const Pose& T_imu_lidar) {
  FilteredSweep result{sweep};
  if (filter.doesNothing()) return result;
  std::vector<bool> dead(filter.dead_rings.empty() ? 0 : kRings, false);
  for (const int ring : filter.dead_rings) dead.at(static_cast<std::size_t>(ring)) = true;
  const Eigen::Matrix3d R = T_imu_lidar.rotation.toRotationMatrix();
  const auto isOnVehicle = [&](const LidarPoint& p) {
    const Eigen::Array3d q = R * Eigen::Vector3f(p.x, p.y, p.z).cast<double>() + T_imu_lidar.translation;
    return (q >= filter.vehicle->lowest.array()).all() && (q <= filter.vehicle->highest.array()).all();
  };

  LastReturns last;
  std::shared_ptr<Sweep> copy;  // made at the first point that has to change
  const std::vector<LidarPoint>& points = sweep->points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LidarPoint& p = points[i];
    if (!hasReturn(p)) continue;
    std::size_t* count = nullptr;
    if (!dead.empty() && dead[p.ring]) {
      count = &result.of_dead_rings;
    } else if (filter.drop_duplicates && last.repeats(p)) {
      count = &result.duplicates;
    } else if (filter.vehicle && isOnVehicle(p)) {
      count = &result.on_vehicle;
    }
    if (count == nullptr) continue;
    ++*count;
    if (!copy) copy = std::make_shared<Sweep>(*sweep);
    copy->points[i].x = copy->points[i].y = copy->points[i].z = std::numeric_limits<float>::quiet_NaN();
  }
  if (copy) result.sweep = copy;
  return result;
}

}  // namespace atlas
