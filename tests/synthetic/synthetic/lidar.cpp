// SPDX-License-Identifier: MIT
#include "synthetic/lidar.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "synthetic/packet.hpp"
#include "synthetic/rig.hpp"

namespace atlas::synthetic {
namespace {

constexpr int kBins = 360;
constexpr double kDegree = M_PI / 180.0;
constexpr double kResolution = 0.002;  // m, the HDL-32E counts ranges in steps of 2 mm

/// 0..1 of the laser's light that comes back, times 255 in the file.
double reflectance(const Primitive* primitive, int hit) {
  if (hit == kHitRoad) return 0.08;
  if (hit == kHitSidewalk || hit == kHitKerb) return 0.2;
  switch (primitive->material) {
    case Material::kBuilding:
      return 0.25 + 0.2 * (primitive->variant % 16) / 16.0;
    case Material::kMetal:
      return 0.35;
    case Material::kTrunk:
      return 0.15;
    case Material::kCrown:
      return 0.3;
    case Material::kCarBody:
      return 0.1 + 0.5 * primitive->colour[1] / 255.0;
    case Material::kCarGlass:
      return 0.06;
    default:
      return 0.3;
  }
}

}  // namespace

/// A primitive near the car during one scan, with the part of the sphere around the lidar that it can cover.
struct Lidar::Candidate {
  int index;
  float nearest;             ///< m
  std::int16_t first, last;  ///< lasers [first, last)
};
struct Lidar::Frame {
  Scene::Snapshot snapshot;
  double time_s;                             ///< of the snapshot: the middle of the scan, on the route
  std::vector<std::vector<Candidate>> bins;  ///< by azimuth, clockwise from +x of the lidar, nearest first
};

Lidar::Lidar(const World& world, const std::string& name)
    : world_(world),
      name_(name),
      T_imu_lidar_(T_imu_sensor(name)),
      dead_laser_(name == "lidar_left" ? 14 : 17),
      random_(world.options().seed, name + " noise"),
      rotation_random_(world.options().seed, name + " rotation") {
  if (name != "lidar_left" && name != "lidar_right")
    throw std::invalid_argument("synthetic lidar: unknown name \"" + name + "\"");
  // The first revolution begins after the first IMU sample; the two lidars are not in phase.
  next_begin_ = world.options().start + (name == "lidar_left" ? 12'203'183 : 41'377'290);
  planNext();
}

void Lidar::planNext() {
  next_columns_ = 2170 + rotation_random_.integer(9);
}  // 9.97 .. 10.0 Hz, as in the real stamps

Eigen::Vector3d Lidar::direction(double azimuth_rad, int laser) {
  const double elevation = (kLowestLaser_deg + kLaserStep_deg * laser) * kDegree;
  return {std::cos(elevation) * std::cos(azimuth_rad), -std::cos(elevation) * std::sin(azimuth_rad),
          std::sin(elevation)};
}

LidarScan Lidar::next(bool with_truth) {
  LidarScan scan;
  scan.columns = next_columns_;
  scan.stamp = nextStamp();
  scan.points.resize(static_cast<std::size_t>(scan.columns) * kLasers);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  if (with_truth) scan.truth.assign(scan.points.size(), {nan, nan, nan, nan});
  const Frame frame = prepareFrame(scan);
  for (int column = 0; column < scan.columns; ++column) fire(frame, column, scan);
  next_begin_ += next_columns_ * kColumn;
  planNext();
  return scan;
}

Lidar::Frame Lidar::prepareFrame(const LidarScan& scan) const {
  Frame frame;
  const Stamp middle = columnStamp(scan.stamp, scan.columns, scan.columns / 2);
  frame.time_s = world_.routeTime(middle);
  const Pose T_city_lidar = world_.T_city_imu(middle) * T_imu_lidar_;
  const Pose T_lidar_city = T_city_lidar.inverse();
  frame.snapshot = world_.scene().snapshot(T_city_lidar.translation, kLidarRange + 3.0, frame.time_s);
  frame.bins.resize(kBins);
  for (int index = 0; index < static_cast<int>(frame.snapshot.primitives.size()); ++index) {
    const Primitive& primitive = frame.snapshot.primitives[index];
    const double c = std::cos(primitive.yaw), s = std::sin(primitive.yaw);
    const Eigen::Vector3d centre = T_lidar_city * primitive.centre;
    double nearest = 1e9, low = 90.0 * kDegree, high = -90.0 * kDegree, from = 0.0, to = 0.0;
    const double middle_azimuth = std::atan2(-centre.y(), centre.x());
    for (int corner = 0; corner < 8; ++corner) {
      const double x = (corner & 1 ? 1 : -1) * primitive.half.x(),
                   y = (corner & 2 ? 1 : -1) * primitive.half.y();
      const Eigen::Vector3d p =
          T_lidar_city * (primitive.centre + Eigen::Vector3d(c * x - s * y, s * x + c * y,
                                                             (corner & 4 ? 1 : -1) * primitive.half.z()));
      const double turn = wrapAngle(std::atan2(-p.y(), p.x()) - middle_azimuth);
      from = std::min(from, turn);
      to = std::max(to, turn);
      const double elevation = std::atan2(p.z(), p.head<2>().norm());
      low = std::min(low, elevation);
      high = std::max(high, elevation);
    }
    // Distance in the primitive's axes. During half a scan, car and object move by up to 1.3 m against each
    // other.
    const PreparedPrimitive p = prepare(primitive, T_city_lidar.translation);
    const double gx = std::max(0.0F, std::fabs(p.ox) - p.hx), gy = std::max(0.0F, std::fabs(p.oy) - p.hy),
                 gz = std::max(0.0F, std::fabs(p.oz) - p.hz);
    nearest = std::max(0.0, std::sqrt(gx * gx + gy * gy + gz * gz) - 1.3);
    const double flat = std::hypot(gx, gy);
    if (nearest > static_cast<double>(kLidarRange)) continue;
    // Margin: the motion seen from that distance, and 2 deg of turning and nodding of the car.
    const double margin = flat > 2.5 ? std::asin(1.4 / flat) + 2.5 * kDegree : M_PI;
    // A flat face seen at a slant rises or falls between its corners: elevations of edges exceed those of
    // corners.
    const bool around = margin >= M_PI || to - from > 150.0 * kDegree;
    const bool tall = around || to - from > 20.0 * kDegree;
    const auto laser = [](double elevation) {
      return (elevation / kDegree - kLowestLaser_deg) / kLaserStep_deg;
    };
    const int first = tall ? 0 : std::clamp(static_cast<int>(std::floor(laser(low - margin))), 0, kLasers);
    const int last =
        tall ? kLasers : std::clamp(static_cast<int>(std::ceil(laser(high + margin))) + 1, 0, kLasers);
    if (first >= last) continue;
    const Candidate candidate{index, static_cast<float>(nearest), static_cast<std::int16_t>(first),
                              static_cast<std::int16_t>(last)};
    const int begin = around ? 0 : static_cast<int>(std::floor((middle_azimuth + from - margin) / kDegree));
    const int end = around ? kBins - 1
                           : std::min(begin + kBins - 1,
                                      static_cast<int>(std::floor((middle_azimuth + to + margin) / kDegree)));
    for (int bin = begin; bin <= end; ++bin) frame.bins[((bin % kBins) + kBins) % kBins].push_back(candidate);
  }
  for (auto& bin : frame.bins) {
    std::sort(bin.begin(), bin.end(), [](const Candidate& a, const Candidate& b) {
      return a.nearest != b.nearest ? a.nearest < b.nearest : a.index < b.index;
    });
  }
  return frame;
}

void Lidar::fire(const Frame& frame, int column, LidarScan& scan) {
  const Stamp stamp = columnStamp(scan.stamp, scan.columns, column);
  const double azimuth = 2.0 * M_PI * column / scan.columns;
  const Pose T_city_lidar = world_.T_city_imu(stamp) * T_imu_lidar_;
  const Eigen::Matrix3d R = T_city_lidar.rotation.toRotationMatrix();
  RayPacket packet;
  packet.origin = T_city_lidar.translation;
  packet.size = kLasers;
  std::array<Eigen::Vector3d, kLasers> rays;
  for (int laser = 0; laser < kLasers; ++laser) {
    rays[laser] = direction(azimuth, laser);
    const Eigen::Vector3d d = R * rays[laser];
    packet.dx[laser] = static_cast<float>(d.x());
    packet.dy[laser] = static_cast<float>(d.y());
    packet.dz[laser] = static_cast<float>(d.z());
  }
  packet.reset(kLidarRange);
  traceGround(packet);
  const double after_s = world_.routeTime(stamp) - frame.time_s;
  const auto& bin = frame.bins[static_cast<std::size_t>(azimuth / kDegree) % kBins];
  for (const Candidate& candidate : bin) {
    const float farthest =
        *std::max_element(packet.t.begin() + candidate.first, packet.t.begin() + candidate.last);
    if (candidate.nearest > farthest) continue;
    const Eigen::Vector3d seen_from = packet.origin - after_s * frame.snapshot.velocity[candidate.index];
    tracePrimitive(packet, prepare(frame.snapshot.primitives[candidate.index], seen_from), candidate.index,
                   candidate.first, candidate.last);
  }
  for (int laser = 0; laser < kLasers; ++laser) {
    // Random numbers are drawn for every ray, so that a beam's noise does not depend on what the others hit.
    const double noise = random_.normal(), luck = random_.uniform();
    const int hit = packet.hit[laser];
    if (hit == kHitNothing || laser == dead_laser_ || luck < world_.options().noise.lidar_lost_fraction)
      continue;
    const std::size_t at = static_cast<std::size_t>(column) * kLasers + laser;
    const double range = static_cast<double>(packet.t[laser]);
    const double measured =
        kResolution * std::round((range + world_.options().noise.lidar_range_m * noise) / kResolution);
    if (measured < 1.0) continue;  // the HDL-32E is blind nearer than 1 m
    const Eigen::Vector3f p = (measured * rays[laser]).cast<float>();
    const Primitive* primitive = hit >= 0 ? &frame.snapshot.primitives[hit] : nullptr;
    const double light = 255.0 * reflectance(primitive, hit) * (0.9 + 0.2 * luck);
    scan.points[at] = {p.x(), p.y(), p.z(), static_cast<float>(std::round(light))};
    if (scan.truth.empty()) continue;
    const Eigen::Vector3f q =
        (world_.T_map_city() * (packet.origin + range * (R * rays[laser]))).cast<float>();
    scan.truth[at] = {q.x(), q.y(), q.z(), primitive ? static_cast<float>(primitive->object) : 0.0F};
  }
}

}  // namespace atlas::synthetic
