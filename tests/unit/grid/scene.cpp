// SPDX-License-Identifier: MIT
#include "scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace atlas::grid_scene {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kLidarAhead_m = 3.6, kLidarHeight_m = 0.47, kLidarSide_m = 0.6;
constexpr double kCameraAhead_m = 1.8, kCameraHeight_m = 1.28;
constexpr double kLidarReach_m = 80.0, kLidarPitch_rad = 1.0 * kDegree;  // nose down
constexpr double kElevations[] = {-1.6 * kDegree, -0.8 * kDegree, 0.0, 0.8 * kDegree};
constexpr int kBeams = 201;
constexpr int kRange_px = 64;

/// Uniform in [0, 1), a function of what is counted (two rounds of the finalizer of MurmurHash3).
double uniform(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  std::uint64_t h = a * 0x9E3779B97F4A7C15ULL + b * 0xC2B2AE3D27D4EB4FULL + c * 0x165667B19E3779F9ULL;
  for (int round = 0; round < 2; ++round) {
    h ^= h >> 33;
    h *= 0xFF51AFD7ED558CCDULL;
    h ^= h >> 33;
    h *= 0xC4CEB9FE1A85EC53ULL;
    h ^= h >> 33;
  }
  return static_cast<double>(h >> 11) * 0x1.0p-53;
}
double normal(std::uint64_t a, std::uint64_t b, std::uint64_t c) {
  const double u = std::max(1e-12, uniform(a, b, 2 * c)), v = uniform(a, b, 2 * c + 1);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * v);
}

/// Range at which a ray over the ground enters a box; nothing when it misses.
std::optional<double> enter(const Actor& actor, const Placing& at, const Eigen::Vector2d& from,
                            const Eigen::Vector2d& along) {
  const double c = std::cos(at.yaw), s = std::sin(at.yaw);
  const Eigen::Vector2d d = from - Eigen::Vector2d(at.x, at.y);
  const double origin[2] = {c * d.x() + s * d.y(), c * d.y() - s * d.x()};
  const double ray[2] = {c * along.x() + s * along.y(), c * along.y() - s * along.x()};
  const double half[2] = {0.5 * actor.length, 0.5 * actor.width};
  double first = 0.0, last = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 2; ++axis) {
    const double a = (-half[axis] - origin[axis]) / ray[axis], b = (half[axis] - origin[axis]) / ray[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  if (!(first <= last) || first <= 0.0) return std::nullopt;
  return first;
}

Pose mounted(const Scene& scene, double t_s, double ahead, double left, double height) {
  return egoPose(scene, t_s) * Pose{Eigen::Quaterniond::Identity(), {ahead, left, height - kBaseHeight_m}};
}

}  // namespace

Eigen::Vector2d Actor::velocityAt(double t_s) const {
  const Placing a = at(t_s - 0.01), b = at(t_s + 0.01);
  return Eigen::Vector2d(b.x - a.x, b.y - a.y) / 0.02;
}

std::function<Placing(double)> stands(double x, double y, double yaw) {
  return [=](double) { return Placing{x, y, yaw}; };
}
std::function<Placing(double)> drives(double x, double y, double yaw, double speed_mps) {
  return [=](double t) {
    return Placing{x + speed_mps * t * std::cos(yaw), y + speed_mps * t * std::sin(yaw), yaw};
  };
}

Pose egoPose(const Scene& scene, double t_s) {
  const Placing at = scene.ego(t_s);
  const double pitch = scene.pitch_rad ? scene.pitch_rad(t_s) : 0.0;
  return {fromRollPitchYaw({0.0, pitch, at.yaw}), {at.x, at.y, kBaseHeight_m}};
}

Odometry egoOdometry(const Scene& scene, double t_s, Stamp stamp) {
  const Placing a = scene.ego(t_s - 0.01), b = scene.ego(t_s + 0.01);
  Odometry odometry;
  odometry.stamp = stamp;
  odometry.T_map_imu = egoPose(scene, t_s);
  odometry.velocity_imu_mps.x() = std::hypot(b.x - a.x, b.y - a.y) / 0.02;
  odometry.angular_velocity_imu_radps.z() = std::remainder(b.yaw - a.yaw, 2.0 * M_PI) / 0.02;
  return odometry;
}

LidarLayers scanOf(const Scene& scene, const SensorSet& sensors, int lidar, double t_s, Stamp stamp) {
  LidarLayers result;
  result.stamp = stamp;
  const Pose level =
      mounted(scene, t_s, kLidarAhead_m, lidar == 0 ? kLidarSide_m : -kLidarSide_m, kLidarHeight_m);
  result.T_map_lidar = level * Pose{fromRollPitchYaw({0.0, kLidarPitch_rad, 0.0}), Eigen::Vector3d::Zero()};
  const Eigen::Vector3d origin = result.T_map_lidar.translation;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (int l = 0; l < 4; ++l) {
    LidarLayer layer{kElevations[l], {}};
    for (int beam = 0; beam < kBeams; ++beam) {
      const double azimuth = (0.5 * beam - 50.0) * kDegree, flat = std::cos(kElevations[l]);
      const Eigen::Vector3d ray =
          result.T_map_lidar.rotation *
          Eigen::Vector3d(flat * std::cos(azimuth), flat * std::sin(azimuth), std::sin(kElevations[l]));
      const double over_ground = std::hypot(ray.x(), ray.y()), rise = ray.z() / over_ground;
      const Eigen::Vector2d along = ray.head<2>() / over_ground;
      double range = rise < 0.0 ? -origin.z() / rise : kLidarReach_m;
      for (const Actor& actor : scene.actors) {
        const auto hit = enter(actor, actor.at(t_s), origin.head<2>(), along);
        if (!hit || *hit >= range) continue;
        const double z = origin.z() + rise * *hit;
        if (z >= actor.bottom && z <= actor.top) range = *hit;
      }
      const auto key = static_cast<std::uint64_t>(stamp) * 8 + static_cast<std::uint64_t>(lidar * 4 + l);
      LayerBeam b{static_cast<float>(std::atan2(along.y(), along.x())), kNan, kNan};
      if (range < kLidarReach_m && uniform(key, beam, 2000 + sensors.seed) >= sensors.drop_out) {
        b.height_m = static_cast<float>(origin.z() + rise * range);
        b.range_m = static_cast<float>(range + sensors.range_sigma_m * normal(key, beam, sensors.seed));
      }
      layer.beams.push_back(b);
    }
    result.layers.push_back(std::move(layer));
  }
  return result;
}

namespace {
StereoRig lexusRig() {
  StereoRig rig;
  rig.focal_px = 410.0;
  rig.u0_px = 256.0;
  rig.v0_px = 156.0;
  rig.baseline_m = 0.22;
  rig.width_px = 512;
  rig.height_px = 320;
  return rig;
}
GroundCells groundCells() { return {0.0, -20.0, 0.2, 200, 200}; }
}  // namespace

StereoEye::StereoEye()
    : rig_(lexusRig()),
      cells_(groundCells()),
      u_disparity_(rig_, kRange_px, params_),
      ground_(rig_, kRange_px, params_, cells_) {}

PlacedGrid StereoEye::look(const Scene& scene, const SensorSet& sensors, double t_s, Stamp stamp) {
  const Pose camera = mounted(scene, t_s, kCameraAhead_m, 0.0, kCameraHeight_m);
  const Eigen::Vector2d from = camera.translation.head<2>();
  const double yaw = scene.ego(t_s).yaw, pitch = scene.pitch_rad ? scene.pitch_rad(t_s) : 0.0;
  const double horizon = rig_.v0_px - rig_.focal_px * std::tan(pitch);
  DisparityImage image;
  image.disparity = cv::Mat::zeros(rig_.height_px, rig_.width_px, CV_16UC1);
  image.surface = cv::Mat::zeros(rig_.height_px, rig_.width_px, CV_8UC1);
  image.road = RoadProfile{horizon, rig_.baseline_m / kCameraHeight_m};
  std::vector<double> depth(rig_.height_px), label(rig_.height_px);
  for (int u = 0; u < rig_.width_px; ++u) {
    const double side = (u - rig_.u0_px) / rig_.focal_px, stretch = std::hypot(1.0, side);
    const double angle = yaw - std::atan(side);
    for (int v = 0; v < rig_.height_px; ++v) {
      const double d = image.road->disparityAt(v);
      depth[v] = d > 0.5 ? rig_.depthOf(d) : std::numeric_limits<double>::infinity();
      label[v] = d > 0.5 ? 2.0 : 0.0;
    }
    for (const Actor& actor : scene.actors) {
      const auto hit = enter(actor, actor.at(t_s), from, {std::cos(angle), std::sin(angle)});
      if (!hit) continue;
      const double z = *hit / stretch;
      const double top = horizon + rig_.focal_px * (kCameraHeight_m - actor.top) / z,
                   bottom = horizon + rig_.focal_px * (kCameraHeight_m - actor.bottom) / z;
      for (int v = std::max(0, static_cast<int>(std::ceil(top))); v <= bottom && v < rig_.height_px; ++v) {
        if (z > depth[v] + 1e-6) continue;
        depth[v] = z;
        label[v] = 1.0;
      }
    }
    for (int v = 0; v < rig_.height_px; ++v) {
      const std::uint64_t pixel = static_cast<std::uint64_t>(v) * 512 + static_cast<std::uint64_t>(u);
      const auto key = static_cast<std::uint64_t>(stamp);
      if (label[v] == 0.0 || uniform(key, pixel, 3000 + sensors.seed) < sensors.missing) continue;
      double d =
          rig_.disparityAt(depth[v]) + sensors.disparity_sigma_px * normal(key, pixel, 5000 + sensors.seed);
      if (uniform(key, pixel, 4000 + sensors.seed) < sensors.outliers)
        d = kRange_px * uniform(key, pixel, 4500 + sensors.seed);
      if (d < 1.0 || d >= kRange_px) continue;
      image.disparity.at<std::uint16_t>(v, u) = static_cast<std::uint16_t>(std::lround(d * kDisparityScale));
      image.surface.at<std::uint8_t>(v, u) = static_cast<std::uint8_t>(label[v]);
    }
  }
  auto grid = std::make_shared<SensorGrid>();
  grid->stamp = stamp;
  grid->frame = "camera";
  grid->origin_x_m = cells_.origin_x_m;
  grid->origin_y_m = cells_.origin_y_m;
  grid->cell_m = cells_.cell_m;
  grid->columns = cells_.columns;
  grid->rows = cells_.rows;
  grid->occupied = ground_.fill(u_disparity_.compute(image));
  return {grid, Pose{fromRollPitchYaw({0.0, 0.0, yaw}), {from.x(), from.y(), 0.0}}};
}

Scene carAhead() {
  Scene scene;
  scene.actors.push_back({"car", 4.4, 1.8, 0.15, 1.5, stands(14.0, 0.0)});
  return scene;
}

OccupancyParams paramsFor(FilterMode mode) {
  OccupancyParams params;
  params.road_below_imu_m = kBaseHeight_m;
  params.grid.ahead_m = 20.0;
  params.filter.mode = mode;
  return params;
}

}  // namespace atlas::grid_scene
