// SPDX-License-Identifier: MIT
// GNSS receiver with two antennas (Trimble BX982) and the TI radar of session 3.
#include <algorithm>
#include <cmath>

#include "synthetic/calendar.hpp"
#include "synthetic/inertial.hpp"
#include "synthetic/rig.hpp"
#include "synthetic/text_file.hpp"

namespace atlas::synthetic {
namespace {

constexpr Duration kPhase = 28'815'215;   // ns after the start, as in the real sample
constexpr Duration kPeriod = 50'000'000;  // 20 Hz
constexpr Duration kJitter = 6'000'000;   // the real stamps are 24 to 62 ms apart
constexpr int kGapEvery = 800, kGapAt = 340,
              kGapRows = 9;  // a gap of 0.5 s each 40 s, the first after 17 s ...
constexpr int kWithoutHeading =
    23;  // ... and then as many rows with azimuth 0: the real sample has just that

}  // namespace

void writeGnss(const World& world, const std::filesystem::path& folder) {
  const NoiseOptions& noise = world.options().noise;
  Random random(world.options().seed, "gnss");
  GaussMarkov slow_heading(noise.heading_slow_rad, 8.0, random);
  TextFile pose(folder / "pose.txt", TextFile::LineEnd::kDos),
      time(folder / "time.txt", TextFile::LineEnd::kDos);
  const Eigen::Vector3d antenna_imu = T_imu_sensor("gnss_rear").translation;
  int row = 0;
  for (Stamp grid = world.options().start + kPhase; grid < world.end() - kJitter; grid += kPeriod, ++row) {
    const auto jitter = static_cast<Duration>(random.uniform(-1.0, 1.0) * static_cast<double>(kJitter));
    const Stamp stamp = grid + jitter, measured = stamp - fromSeconds(world.options().gnss_latency_s);
    const double east = random.normal(), north = random.normal(), up = random.normal();
    const double heading_error = slow_heading.step(0.05, random) + noise.heading_white_rad * random.normal();
    const int in_cycle = row % kGapEvery - kGapAt;
    if (in_cycle >= 0 && in_cycle < kGapRows) continue;
    const bool heading_lost = in_cycle >= kGapRows && in_cycle < kGapRows + kWithoutHeading;
    const Pose T_map_imu = world.T_map_imu(measured);
    const Eigen::Vector3d error(noise.gnss_horizontal_m * east, noise.gnss_horizontal_m * north,
                                noise.gnss_vertical_m * up);
    const Geodetic fix = world.enu().toGeodetic(T_map_imu * antenna_imu + error);
    const Eigen::Vector3d forward = T_map_imu.rotation * Eigen::Vector3d::UnitX();
    double azimuth =
        std::fmod((std::atan2(forward.x(), forward.y()) + heading_error) * 180.0 / M_PI + 720.0, 360.0);
    if (azimuth < 0.001) azimuth = 0.001;  // exactly 0 means "none"
    if (heading_lost) azimuth = 0.0;
    pose.print("%lld, %.8f, %.8f, %g, %g\n", static_cast<long long>(stamp), fix.latitude_deg,
               fix.longitude_deg, fix.altitude_m, azimuth);
    const CalendarTime c = calendarTime(measured, 10'000'000);
    time.print("%lld, %d, %d, %d, %d, %d, %d, %lld\n", static_cast<long long>(stamp), c.year, c.month, c.day,
               c.hour, c.minute, c.second, static_cast<long long>(c.nanosecond));
  }
}

void writeRadar(const World& world, const std::filesystem::path& folder) {
  Random random(world.options().seed, "radar");
  TextFile file(folder / "scans.txt", TextFile::LineEnd::kDos);
  const Pose T_imu_radar = T_imu_sensor("radar_ti");
  for (Stamp stamp = world.options().start + 31'000'000; stamp < world.end(); stamp += 50'000'000) {
    const double t = world.routeTime(stamp);
    const Pose T_city_radar = world.ego().T_city_imu(t) * T_imu_radar;
    const Eigen::Vector3d p_before = (world.ego().T_city_imu(t - 0.01) * T_imu_radar).translation;
    const Eigen::Vector3d own_velocity = (T_city_radar.translation - p_before) / 0.01;
    std::vector<std::pair<Eigen::Vector3d, double>> targets;
    for (const Object& object : world.scene().objects()) {
      if (!Scene::exists(object, t)) continue;
      const ObjectState state = world.scene().stateAt(object, t);
      const Eigen::Vector3d at(state.x, state.y, state.z + 0.5 * object.size.z());
      const Eigen::Vector3d p = T_city_radar.inverse() * at;
      if (p.x() < 1.0 || p.norm() > 45.0 || std::fabs(p.y()) > p.x() * 1.7) continue;  // 60 deg to both sides
      const Eigen::Vector3d line = (at - T_city_radar.translation).normalized();
      const double range_rate = line.dot(state.velocity - own_velocity) + 0.1 * random.normal();
      const Eigen::Vector3d noisy =
          p * (1.0 - 0.5 * object.size.y() / p.norm()) +
          Eigen::Vector3d(0.1 * random.normal(), 0.3 * random.normal(), 0.3 * random.normal());
      targets.emplace_back(noisy, range_rate);
    }
    std::stable_sort(targets.begin(), targets.end(),
                     [](const auto& a, const auto& b) { return a.first.norm() < b.first.norm(); });
    if (targets.size() > 12) targets.resize(12);
    file.print("%lld, %zu", static_cast<long long>(stamp), targets.size());
    for (const auto& [p, velocity] : targets)
      file.print(", %.4f, %.4f, %.4f, %.4f", p.x(), p.y(), p.z(), velocity);
    file.print("\n");
  }
}

}  // namespace atlas::synthetic
