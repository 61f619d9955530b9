// SPDX-License-Identifier: MIT
// A car with exact ground truth and sensors whose errors are known, for the positioning tests. The car obeys
// the bicycle model: the rear axle moves along the heading, the imu sits `axle_m` ahead of it, the antenna at
// `lever_arm_imu`.
#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "atlas/base/geodesy.hpp"
#include "atlas/base/geometry.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas::test {

const Geodetic kBrno{49.2281, 16.5755, 281.0};

struct Truth {
  Stamp stamp = 0;
  Pose T_map_imu;
  Eigen::Vector3d velocity_map = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_map = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_imu = Eigen::Vector3d::Zero();
};

struct Errors {
  double fix_horizontal_m = 0.02, fix_vertical_m = 0.04;
  double accelerometer_noise = 0.01;  ///< (m/s^2)/sqrt(Hz)
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();
  double gyroscope_noise = 0.0002;  ///< (rad/s)/sqrt(Hz)
  Eigen::Vector3d gyroscope_bias = Eigen::Vector3d::Zero();
  double tilt_rad = 0.0;  ///< slow error of the imu's own roll and pitch
  double heading_white_rad = 0.0, heading_slow_rad = 0.0, heading_slow_time_s = 20.0;
  bool earth_rotates = false;  ///< the gyroscopes feel the Earth turn, the accelerometers Coriolis
};
inline Errors noErrors() {
  Errors e;
  e.fix_horizontal_m = e.fix_vertical_m = e.accelerometer_noise = e.gyroscope_noise = 0.0;
  return e;
}
/// RTK at 2 cm, MEMS IMU, two-antenna heading with its slow wander.
inline Errors realisticErrors(std::mt19937& random) {
  std::normal_distribution<double> n;
  constexpr double kDeg = M_PI / 180.0;
  Errors e;
  e.accelerometer_bias = 0.02 * Eigen::Vector3d(n(random), n(random), n(random));
  e.gyroscope_bias = 0.1 * kDeg * Eigen::Vector3d(n(random), n(random), n(random));
  e.tilt_rad = 0.2 * kDeg;
  e.heading_white_rad = 1.0 * kDeg;
  e.heading_slow_rad = 2.0 * kDeg;
  return e;
}

struct DriveParams {
  double duration_s = 60.0;
  double imu_rate_hz = 100.0;
  double axle_m = 1.3;
  Eigen::Vector3d lever_arm_imu{-0.48, -0.19, 0.0};
  double start_yaw_rad = 0.5;
  double sway_rad = 0.02;                                               ///< roll and pitch amplitude
  std::function<double(double)> speed = [](double) { return 0.0; };     ///< of the rear axle, m/s, over time
  std::function<double(double)> yaw_rate = [](double) { return 0.0; };  ///< rad/s
};

/// Stands 3 s, drives at up to `top_mps` with bends, stands for the last 3 s.
inline DriveParams cityDrive(double duration_s, double top_mps = 10.0) {
  DriveParams p;
  p.duration_s = duration_s;
  const double last = duration_s - 3.0;
  p.speed = [=](double t) {
    if (t < 3.0 || t > last) return 0.0;
    const double ramp = std::min({1.0, (t - 3.0) / 5.0, (last - t) / 5.0});
    return top_mps * ramp * ramp * (3.0 - 2.0 * ramp);
  };
  const auto speed = p.speed;
  p.yaw_rate = [=](double t) { return speed(t) / top_mps * 0.35 * std::sin(2.0 * M_PI * (t - 3.0) / 17.0); };
  return p;
}

/// Truth at each IMU sample, integrated with 20 substeps.
inline std::vector<Truth> drive(const DriveParams& p) {
  const Stamp start = 1'568'186'745 * kSecond;
  const int samples = static_cast<int>(p.duration_s * p.imu_rate_hz) + 1;
  const int substeps = 20;
  const double h = 1.0 / p.imu_rate_hz / substeps;
  const auto orientation = [&](double yaw, double t) {
    const double fade = 1.0 - std::exp(-t);
    return fromRollPitchYaw(
        {p.sway_rad * fade * std::sin(0.9 * t), p.sway_rad * fade * std::sin(0.6 * t + 1.0), yaw});
  };
  std::vector<Truth> truth;
  double yaw = p.start_yaw_rad, t = 0.0;
  Eigen::Vector2d axle(0.0, 0.0);
  const Eigen::Vector2d start_imu = p.axle_m * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
  for (int k = 0; k < samples; ++k) {
    const double s = p.speed(t), w = p.yaw_rate(t), e = 1e-4;
    const double ds = (p.speed(t + e) - p.speed(t - e)) / (2 * e),
                 dw = (p.yaw_rate(t + e) - p.yaw_rate(t - e)) / (2 * e);
    const Eigen::Vector2d forward(std::cos(yaw), std::sin(yaw)), left(-forward.y(), forward.x());
    Truth now;
    now.stamp = start + fromSeconds(k / p.imu_rate_hz);
    const Eigen::Vector2d at = axle + p.axle_m * forward - start_imu;
    now.T_map_imu = {orientation(yaw, t), {at.x(), at.y(), 0.0}};
    const Eigen::Vector2d v = s * forward + w * p.axle_m * left;
    const Eigen::Vector2d a = (ds - w * w * p.axle_m) * forward + (dw * p.axle_m + w * s) * left;
    now.velocity_map << v, 0.0;
    now.acceleration_map << a, 0.0;
    now.rate_imu =
        logSo3(orientation(yaw - w * e, t - e).conjugate() * orientation(yaw + w * e, t + e)) / (2 * e);
    truth.push_back(now);
    for (int i = 0; i < substeps; ++i) {  // midpoint rule
      const double middle = yaw + 0.5 * h * p.yaw_rate(t + 0.25 * h);
      axle += h * p.speed(t + 0.5 * h) * Eigen::Vector2d(std::cos(middle), std::sin(middle));
      yaw += h * p.yaw_rate(t + 0.5 * h);
      t += h;
    }
    t = (k + 1) / p.imu_rate_hz;
  }
  return truth;
}

/// What the sensors say about a drive. Fixes and headings at `gnss_rate_hz`, their stamps between the IMU's.
struct Recording {
  std::vector<ImuSample> imu;
  std::vector<GnssFix> fixes;
  std::vector<GnssHeading> headings;
};

inline Truth truthAt(const std::vector<Truth>& truth, Stamp stamp) {
  const double period = static_cast<double>(truth[1].stamp - truth[0].stamp);
  const double at = static_cast<double>(stamp - truth[0].stamp) / period;
  const std::size_t i = std::min(static_cast<std::size_t>(at), truth.size() - 2);
  const double ratio = std::min(1.0, at - static_cast<double>(i));
  Truth result = truth[i];
  result.stamp = stamp;
  result.T_map_imu = interpolate(truth[i].T_map_imu, truth[i + 1].T_map_imu, ratio);
  const double dt = ratio * period * 1e-9;  // exact to third order where linear interpolation is not
  result.T_map_imu.translation =
      truth[i].T_map_imu.translation + dt * truth[i].velocity_map + 0.5 * dt * dt * truth[i].acceleration_map;
  return result;
}

inline Recording record(const std::vector<Truth>& truth, const DriveParams& p, const Errors& e,
                        std::mt19937& random, double gnss_rate_hz = 20.0,
                        Duration offset = 3 * kMillisecond) {
  std::normal_distribution<double> n;
  const auto noise3 = [&] { return Eigen::Vector3d(n(random), n(random), n(random)); };
  const double g = normalGravity(kBrno.latitude_deg, kBrno.altitude_m);
  const double root_rate = std::sqrt(p.imu_rate_hz);
  const double latitude = kBrno.latitude_deg * M_PI / 180.0;
  const Eigen::Vector3d earth =
      (e.earth_rotates ? 7.292115e-5 : 0.0) * Eigen::Vector3d(0.0, std::cos(latitude), std::sin(latitude));
  const Eigen::Vector3d tilt(e.tilt_rad * n(random), e.tilt_rad * n(random), 0.0);
  Recording out;
  for (const Truth& t : truth) {
    ImuSample s;
    s.stamp = t.stamp;
    const Eigen::Quaterniond R_imu_map = t.T_map_imu.rotation.conjugate();
    s.angular_velocity_radps =
        t.rate_imu + R_imu_map * earth + e.gyroscope_bias + e.gyroscope_noise * root_rate * noise3();
    s.linear_acceleration_mps2 =
        R_imu_map * (t.acceleration_map + 2.0 * earth.cross(t.velocity_map) + g * Eigen::Vector3d::UnitZ()) +
        e.accelerometer_bias + e.accelerometer_noise * root_rate * noise3();
    // Roll and pitch with a slow error; a yaw that is magnetic and 63 deg wrong.
    s.orientation = fromRollPitchYaw({0, 0, 1.1}) * t.T_map_imu.rotation * expSo3(tilt);
    out.imu.push_back(s);
  }
  const LocalEnu map(kBrno);
  const Eigen::Vector3d p0 = truth[0].T_map_imu * p.lever_arm_imu;  // the first fix is the anchor
  double slow = e.heading_slow_rad * n(random);
  const double phi = std::exp(-1.0 / gnss_rate_hz / e.heading_slow_time_s);
  const Duration period = fromSeconds(1.0 / gnss_rate_hz);
  for (Stamp stamp = truth[0].stamp + offset; stamp <= truth.back().stamp; stamp += period) {
    const Truth t = truthAt(truth, stamp);
    Eigen::Vector3d antenna = t.T_map_imu * p.lever_arm_imu - p0;
    if (!out.fixes.empty()) {
      antenna +=
          Eigen::Vector3d(e.fix_horizontal_m, e.fix_horizontal_m, e.fix_vertical_m).cwiseProduct(noise3());
    }
    out.fixes.push_back({stamp, map.toGeodetic(antenna), std::nullopt});
    slow = phi * slow + std::sqrt(1.0 - phi * phi) * e.heading_slow_rad * n(random);
    const double yaw = toRollPitchYaw(t.T_map_imu.rotation).yaw + slow + e.heading_white_rad * n(random);
    out.headings.push_back({stamp, wrapAngle(yaw), std::nullopt});
  }
  return out;
}

}  // namespace atlas::test
