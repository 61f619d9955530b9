// SPDX-License-Identifier: MIT
#include "synthetic/inertial.hpp"

#include <cmath>

#include "synthetic/calendar.hpp"
#include "synthetic/text_file.hpp"

namespace atlas::synthetic {
namespace {

using Path = std::filesystem::path;
constexpr double kDt = 0.0025;             // s
constexpr Duration kImuPhase = 1'000'287;  // ns after the start: phases of the real sample
constexpr Duration kGnssPhase = 17'500'000;
constexpr Duration kSlowPhase = 2'467'905;                // mag and pressure
constexpr double kInclination_rad = 66.2 * M_PI / 180.0;  // of the Earth's field in Brno
constexpr double kFieldNorm = 1.42;                       // Xsens units, norm in the real sample

constexpr double kEarthRate_radps = 7.292115e-5;  // WGS84

/// The Earth's rotation in map (ENU) axes.
Eigen::Vector3d earthRotation(double latitude_deg) {
  const double latitude = latitude_deg * M_PI / 180.0;
  return kEarthRate_radps * Eigen::Vector3d(0.0, std::cos(latitude), std::sin(latitude));
}

Eigen::Vector3d vectorOf(Random& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

void writeImuOwnFix(const World& world, const Path& folder) {
  // The IMU's own receiver: 4 Hz, metres of slow error, altitude not given (0, as in the sample), rows at 50
  // Hz repeat.
  Random random(world.options().seed, "imu gnss");
  GaussMarkov east(1.2, 40.0, random), north(1.2, 40.0, random);
  TextFile file(folder / "gnss.txt", TextFile::LineEnd::kDos);
  Geodetic fix;
  int row = 0;
  for (Stamp stamp = world.options().start + kGnssPhase; stamp < world.end(); stamp += 20'000'000, ++row) {
    if (row % 12 == 0) {
      const Eigen::Vector3d error(east.step(0.24, random), north.step(0.24, random), 0.0);
      fix = world.enu().toGeodetic(world.T_map_imu(stamp).translation + error);
    }
    file.print("%lld, %.8f, %.8f, 0\n", static_cast<long long>(stamp), fix.latitude_deg, fix.longitude_deg);
  }
}

void writeMagAndPressure(const World& world, const Path& folder) {
  Random random(world.options().seed, "imu mag");
  // A yaw that is off by d looks like a field that points d away from north.
  const double off = world.options().noise.magnetic_yaw_offset_rad;
  const Eigen::Vector3d field =
      kFieldNorm * Eigen::Vector3d(-std::cos(kInclination_rad) * std::sin(-off),
                                   std::cos(kInclination_rad) * std::cos(off), -std::sin(kInclination_rad));
  TextFile mag(folder / "mag.txt", TextFile::LineEnd::kDos),
      pressure(folder / "pressure.txt", TextFile::LineEnd::kDos);
  int row = 0;
  for (Stamp stamp = world.options().start + kSlowPhase; stamp < world.end(); stamp += 10'000'000, ++row) {
    const Pose T_map_imu = world.T_map_imu(stamp);
    const Eigen::Vector3d m = T_map_imu.rotation.conjugate() * field + 0.003 * vectorOf(random);
    mag.print("%lld, %g, %g, %g\n", static_cast<long long>(stamp), m.x(), m.y(), m.z());
    if (row % 2 != 0) continue;
    const double pa =
        98880.0 - 11.5 * T_map_imu.translation.z() + 3.0 * random.normal();  // 11.5 Pa/m near the ground
    pressure.print("%lld, %lld\n", static_cast<long long>(stamp), std::llround(pa));
  }
}

void writeTempAndTime(const World& world, const Path& folder) {
  TextFile temp(folder / "temp.txt", TextFile::LineEnd::kDos),
      time(folder / "time.txt", TextFile::LineEnd::kDos);
  for (Stamp stamp = world.options().start; stamp < world.end(); stamp += kImuPeriod) {
    const double warming = 29.0625 + 0.0625 * std::floor(toSeconds(stamp - world.options().start) / 20.0);
    temp.print("%lld, %g\n", static_cast<long long>(stamp), warming);
    const CalendarTime c = calendarTime(stamp - fromSeconds(world.options().imu_latency_s), 100'000);
    time.print("%lld, %d, %d, %d, %d, %d, %d, %lld\n", static_cast<long long>(stamp), c.year, c.month, c.day,
               c.hour, c.minute, c.second, static_cast<long long>(c.nanosecond));
  }
}

}  // namespace

std::vector<Stamp> imuStamps(const World& world) {
  std::vector<Stamp> stamps;
  for (Stamp stamp = world.options().start + kImuPhase; stamp < world.end(); stamp += kImuPeriod)
    stamps.push_back(stamp);
  return stamps;
}

ImuModel::ImuModel(const World& world) : world_(world), random_(world.options().seed, "imu") {
  const NoiseOptions& noise = world.options().noise;
  gyro_bias_ = noise.gyro_turn_on_bias_radps * vectorOf(random_);
  accel_bias_ = noise.accel_turn_on_bias_mps2 * vectorOf(random_);
  for (int i = 0; i < 3; ++i) slow_.emplace_back(noise.gyro_instability_radps, 100.0, random_);
  for (int i = 0; i < 3; ++i) slow_.emplace_back(noise.accel_instability_mps2, 100.0, random_);
  for (int i = 0; i < 2; ++i) slow_.emplace_back(noise.orientation_rad, 20.0, random_);
  slow_.emplace_back(noise.magnetic_yaw_rad, 30.0, random_);
}

ImuReading ImuModel::read(Stamp stamp) {
  const NoiseOptions& noise = world_.options().noise;
  for (GaussMarkov& process : slow_) process.step(kDt, random_);
  const Stamp measured = stamp - fromSeconds(world_.options().imu_latency_s);
  const double t = world_.routeTime(measured);
  const ImuKinematics ideal = world_.ego().kinematics(t);
  const double per_sample = 1.0 / std::sqrt(kDt);  // white noise of density d has sigma d / sqrt(dt)
  const Eigen::Vector3d gyro_error = gyro_bias_ +
                                     Eigen::Vector3d(slow_[0].value(), slow_[1].value(), slow_[2].value()) +
                                     noise.gyro_density_radps_rthz * per_sample * vectorOf(random_);
  const Eigen::Vector3d accel_error = accel_bias_ +
                                      Eigen::Vector3d(slow_[3].value(), slow_[4].value(), slow_[5].value()) +
                                      noise.accel_density_mps2_rthz * per_sample * vectorOf(random_);
  const Eigen::Quaterniond R_map_imu = world_.T_map_imu(measured).rotation;
  const Eigen::Quaterniond R_map_before = world_.T_map_imu(measured - kImuPeriod).rotation;
  // Gyroscopes see the Earth turn, accelerometers the Coriolis acceleration of moving on it.
  const Eigen::Vector3d earth = earthRotation(world_.options().anchor.latitude_deg);
  const Eigen::Vector3d v_map = (world_.T_map_imu(measured + kImuPeriod).translation -
                                 world_.T_map_imu(measured - kImuPeriod).translation) /
                                (2.0 * kDt);
  const Eigen::Vector3d earth_imu = R_map_imu.conjugate() * earth;
  ImuReading reading;
  reading.angular_velocity_radps = ideal.angular_velocity_radps + earth_imu + gyro_error;
  reading.specific_force_mps2 =
      ideal.specific_force_mps2 + R_map_imu.conjugate() * (2.0 * earth.cross(v_map)) + accel_error;
  reading.increment =
      (R_map_before.conjugate() * R_map_imu * expSo3((earth_imu + gyro_error) * kDt)).normalized();
  RollPitchYaw rpy = toRollPitchYaw(R_map_imu);
  rpy.roll += slow_[6].value();
  rpy.pitch += slow_[7].value();
  rpy.yaw += noise.magnetic_yaw_offset_rad + slow_[8].value();
  reading.orientation = fromRollPitchYaw(rpy);
  return reading;
}

void writeImu(const World& world, const Path& folder) {
  ImuModel model(world);
  TextFile imu(folder / "imu.txt", TextFile::LineEnd::kDos),
      increments(folder / "d_quat.txt", TextFile::LineEnd::kDos);
  for (const Stamp stamp : imuStamps(world)) {
    const ImuReading reading = model.read(stamp);
    const Eigen::Vector3d f = -reading.specific_force_mps2;  // the dataset's inverted sign
    const Eigen::Vector3d& w = reading.angular_velocity_radps;
    const Eigen::Quaterniond& q = reading.orientation;
    imu.print("%lld, %g, %g, %g, %g, %g, %g, %g, %g, %g, %g\n", static_cast<long long>(stamp), f.x(), f.y(),
              f.z(), w.x(), w.y(), w.z(), q.x(), q.y(), q.z(), q.w());
    const Eigen::Quaterniond& d = reading.increment;
    increments.print("%lld, %g, %g, %g, %g\n", static_cast<long long>(stamp), d.x(), d.y(), d.z(), d.w());
  }
  writeImuOwnFix(world, folder);
  writeMagAndPressure(world, folder);
  writeTempAndTime(world, folder);
}

}  // namespace atlas::synthetic
