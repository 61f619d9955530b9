// SPDX-License-Identifier: MIT
#include "synthetic/truth.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "synthetic/inertial.hpp"
#include "synthetic/text_file.hpp"

namespace atlas::synthetic {
namespace {

using Path = std::filesystem::path;

constexpr const char* kReadme =
    "Truth of a synthetic drive. Map: ENU at anchor.json; quaternions x y z w; metres, radians, stamps in ns "
    "(UTC).\n"
    "\n"
    "anchor.json            origin of the true map, WGS84\n"
    "meta.json              options and noise values the drive was made with\n"
    "trajectory.tum         T_map_imu at every stamp of imu/imu.txt: stamp_s x y z qx qy qz qw\n"
    "objects.csv            every object within 100 m at 10 Hz: "
    "stamp_ns,id,class,x,y,z,yaw,length,width,height,vx,vy,vz;\n"
    "                       x,y,z = centre of the box\n"
    "points/<lidar>/%06d.bin  float32 x y z object per point, in the order of the scan: where the beam hit "
    "at its own time,\n"
    "                       without noise, in the true map; object 0 = ground, houses, trees, poles; NaN = "
    "no return\n"
    "boxes2d/<camera>.csv   stamp_ns,frame,object,class,x1,y1,x2,y2,visible_fraction,depth,range: outer "
    "edges of the visible\n"
    "                       pixels; fraction of the object's pixels inside the image that are not hidden; "
    "nearest visible\n"
    "                       point along the optical axis and straight. Pixel centres have whole "
    "coordinates.\n"
    "                       A cyclist is one object of class bicycle.\n"
    "depth/<camera>/%06d.png  z-depth x 256, 16 bit, of the distorted image, by frame number; 0 = sky or "
    "beyond 255 m\n"
    "\n"
    "A scan's stamp is the time of its LAST column (46.08 us each); point index = column * 32 + laser, laser "
    "0 lowest.\n"
    "imu/imu.txt carries accelerations with inverted sign, as the real dataset does.\n";

void writeMeta(const World& world, const Path& path) {
  const DriveOptions& o = world.options();
  const NoiseOptions& n = o.noise;
  const nlohmann::ordered_json meta = {
      {"seed", o.seed},
      {"duration_s", o.duration_s},
      {"skip_s", o.skip_s},
      {"stop_at_s", o.stop_at_s},
      {"stop_for_s", o.stop_for_s},
      {"start_ns", o.start},
      {"rgb_scale", o.rgb_scale},
      {"imu_latency_s", o.imu_latency_s},
      {"gnss_latency_s", o.gnss_latency_s},
      {"street_yaw_rad", o.street_yaw_rad},
      {"truth_points_every", o.truth_points_every},
      {"truth_depth_every", o.truth_depth_every},
      {"gravity_mps2", normalGravity(o.anchor.latitude_deg, o.anchor.altitude_m)},
      {"noise",
       {{"gyro_density_radps_rthz", n.gyro_density_radps_rthz},
        {"gyro_turn_on_bias_radps", n.gyro_turn_on_bias_radps},
        {"gyro_instability_radps", n.gyro_instability_radps},
        {"accel_density_mps2_rthz", n.accel_density_mps2_rthz},
        {"accel_turn_on_bias_mps2", n.accel_turn_on_bias_mps2},
        {"accel_instability_mps2", n.accel_instability_mps2},
        {"orientation_rad", n.orientation_rad},
        {"magnetic_yaw_offset_rad", n.magnetic_yaw_offset_rad},
        {"magnetic_yaw_rad", n.magnetic_yaw_rad},
        {"gnss_horizontal_m", n.gnss_horizontal_m},
        {"gnss_vertical_m", n.gnss_vertical_m},
        {"heading_white_rad", n.heading_white_rad},
        {"heading_slow_rad", n.heading_slow_rad},
        {"lidar_range_m", n.lidar_range_m},
        {"lidar_lost_fraction", n.lidar_lost_fraction},
        {"detection_px", n.detection_px},
        {"detection_missed_fraction", n.detection_missed_fraction}}}};
  std::ofstream(path) << meta.dump(2) << "\n";
}

void writeObjects(const World& world, const Path& path) {
  TextFile file(path, TextFile::LineEnd::kUnix);
  file.print("stamp_ns,id,class,x,y,z,yaw,length,width,height,vx,vy,vz\n");
  for (Stamp stamp = world.options().start; stamp < world.end(); stamp += 100 * kMillisecond) {
    const double t = world.routeTime(stamp);
    const Eigen::Vector3d here = world.ego().T_city_imu(t).translation;
    for (const Object& object : world.scene().objects()) {
      if (!Scene::exists(object, t)) continue;
      const ObjectState state = world.scene().stateAt(object, t);
      const Eigen::Vector3d centre(state.x, state.y, state.z + 0.5 * object.size.z());
      if ((centre - here).head<2>().norm() > 100.0) continue;
      const Eigen::Vector3d p = world.T_map_city() * centre, v = world.T_map_city().rotation * state.velocity;
      file.print("%lld,%d,%d,%.4f,%.4f,%.4f,%.5f,%.3f,%.3f,%.3f,%.4f,%.4f,%.4f\n",
                 static_cast<long long>(stamp), object.id, static_cast<int>(object.object_class), p.x(),
                 p.y(), p.z(), wrapAngle(state.yaw + world.options().street_yaw_rad), object.size.x(),
                 object.size.y(), object.size.z(), v.x(), v.y(), v.z());
    }
  }
}

/// "1568186745.408734467" to ns, digit by digit.
std::optional<Stamp> parseStamp(const std::string& text) {
  const std::size_t dot = text.find('.');
  std::string digits = text.substr(0, dot);
  std::string fraction = dot == std::string::npos ? "" : text.substr(dot + 1);
  fraction.resize(9, '0');
  digits += fraction;
  if (digits.size() > 19 || digits.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  return std::strtoll(digits.c_str(), nullptr, 10);
}

}  // namespace

void writeTruth(const World& world, const Path& folder) {
  const Geodetic& anchor = world.options().anchor;
  TextFile(folder / "anchor.json", TextFile::LineEnd::kUnix)
      .print("{\"latitude\": %.17g, \"longitude\": %.17g, \"altitude\": %.17g}\n", anchor.latitude_deg,
             anchor.longitude_deg, anchor.altitude_m);
  writeMeta(world, folder / "meta.json");
  std::ofstream(folder / "README.txt") << kReadme;
  TextFile file(folder / "trajectory.tum", TextFile::LineEnd::kUnix);
  for (const Stamp stamp : imuStamps(world)) {
    const Pose pose = world.T_map_imu(stamp);
    const Eigen::Vector3d& p = pose.translation;
    const Eigen::Quaterniond& q = pose.rotation;
    file.print("%lld.%09lld %.9f %.9f %.9f %.12f %.12f %.12f %.12f\n",
               static_cast<long long>(stamp / kSecond), static_cast<long long>(stamp % kSecond), p.x(), p.y(),
               p.z(), q.x(), q.y(), q.z(), q.w());
  }
  writeObjects(world, folder / "objects.csv");
}

std::vector<StampedPose> readTrajectory(const Path& tum) {
  std::vector<StampedPose> poses;
  std::ifstream file(tum);
  for (std::string line; std::getline(file, line);) {
    std::istringstream fields(line);
    fields.imbue(std::locale::classic());
    std::string time;
    double x, y, z, qx, qy, qz, qw;
    if (!(fields >> time >> x >> y >> z >> qx >> qy >> qz >> qw)) continue;
    const auto stamp = parseStamp(time);
    const Eigen::Quaterniond q(qw, qx, qy, qz);
    if (!stamp || !std::isfinite(x + y + z) || std::fabs(q.norm() - 1.0) > 1e-3) continue;
    poses.push_back({*stamp, {q.normalized(), {x, y, z}}});
  }
  return poses;
}

std::optional<Geodetic> readAnchor(const Path& json) {
  std::ifstream file(json);
  const auto content = nlohmann::json::parse(file, nullptr, false);
  for (const char* key : {"latitude", "longitude", "altitude"}) {
    if (!content.is_object() || !content.contains(key) || !content[key].is_number()) return std::nullopt;
  }
  return Geodetic{content["latitude"], content["longitude"], content["altitude"]};
}

std::vector<TruthBox2d> readBoxes2d(const Path& csv) {
  std::vector<TruthBox2d> boxes;
  std::ifstream file(csv);
  for (std::string line; std::getline(file, line);) {
    TruthBox2d b;
    long long stamp = 0;
    if (std::sscanf(line.c_str(), "%lld,%d,%d,%d,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &stamp, &b.frame, &b.object,
                    &b.class_id, &b.x1, &b.y1, &b.x2, &b.y2, &b.visible_fraction, &b.depth_m,
                    &b.range_m) != 11) {
      continue;
    }
    b.stamp = stamp;
    boxes.push_back(b);
  }
  return boxes;
}

}  // namespace atlas::synthetic
