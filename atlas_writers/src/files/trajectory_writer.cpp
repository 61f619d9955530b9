// SPDX-License-Identifier: MIT
#include "files/trajectory_writer.hpp"

#include <nlohmann/json.hpp>

#include "atlas/output/trajectory_text.hpp"

namespace atlas {
namespace {

constexpr double kGeoStep_m = 1.0;  ///< between points of the GeoJSON line: viewers choke on IMU rate

std::string coordinate(const Geodetic& position) {
  std::string text = "[";
  appendFixed(text, position.longitude_deg, 9);  // 0.1 mm
  text += ',';
  appendFixed(text, position.latitude_deg, 9);
  text += ',';
  appendFixed(text, position.altitude_m, 3);
  return text + ']';
}

}  // namespace

TrajectoryWriter::TrajectoryWriter(const std::filesystem::path& out, const std::string& name)
    : folder_(out / "trajectory"),
      name_(name),
      tum_(std::make_unique<OutputFile>(folder_ / (name + ".tum"))),
      kitti_(std::make_unique<OutputFile>(folder_ / (name + ".kitti"))),
      csv_(std::make_unique<OutputFile>(folder_ / (name + ".csv"))) {
  csv_->write(csvTitle());
}

void TrajectoryWriter::writeAnchor(const Anchor& anchor) {
  const nlohmann::ordered_json json = {{"latitude", anchor.position.latitude_deg},
                                       {"longitude", anchor.position.longitude_deg},
                                       {"altitude", anchor.position.altitude_m}};
  writeFile(folder_ / "anchor.json", json.dump(1) + "\n");
  enu_.emplace(anchor.position);
  geojson_ = std::make_unique<OutputFile>(folder_ / (name_ + ".geojson"));
}

void TrajectoryWriter::write(const Odometry& odometry) {
  tum_->write(tumLine(odometry));
  kitti_->write(kittiLine(odometry));
  csv_->write(csvLine(odometry));
  if (enu_) writeGeo(odometry.T_map_imu.translation);
}

void TrajectoryWriter::writeGeo(const Eigen::Vector3d& p_map) {
  if (last_geo_map_ && (p_map - *last_geo_map_).norm() < kGeoStep_m) return;
  last_geo_map_ = p_map;
  const std::string text = coordinate(enu_->toGeodetic(p_map));
  if (geo_points_ == 0) first_geo_ = text;
  if (geo_points_ == 1) {
    geojson_->write(R"({"type":"Feature","properties":{},"geometry":{"type":"LineString","coordinates":[)"
                    "\n");
    geojson_->write(first_geo_);
  }
  if (geo_points_ >= 1) geojson_->write(",\n" + text);
  ++geo_points_;
}

void TrajectoryWriter::close() {
  if (!tum_) return;
  if (geojson_) {
    if (geo_points_ == 0)
      geojson_->write(R"({"type":"Feature","properties":{},"geometry":null})"
                      "\n");
    if (geo_points_ == 1) {
      geojson_->write(R"({"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":)" +
                      first_geo_ + "}}\n");
    }
    if (geo_points_ > 1) geojson_->write("]}}\n");
  }
  for (std::unique_ptr<OutputFile>* file : {&tum_, &kitti_, &csv_, &geojson_}) {
    if (*file) (*file)->commit();
    file->reset();
  }
}

}  // namespace atlas
