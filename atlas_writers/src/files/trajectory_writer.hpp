// SPDX-License-Identifier: MIT
// The trajectory below trajectory/, line by line, in constant memory: <name>.tum, <name>.kitti (poses without
// stamps), <name>.csv (with covariance), <name>.geojson (WGS84, thinned, for maps) and anchor.json.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "atlas/sensor/products.hpp"
#include "files/output_file.hpp"

namespace atlas {

class TrajectoryWriter {
 public:
  /// out: the run's output folder. Without close() no file appears.
  explicit TrajectoryWriter(const std::filesystem::path& out, const std::string& name = "trajectory");

  /// Writes anchor.json: {latitude, longitude, altitude}, degrees and metres, digits that give back the same
  /// doubles. Poses before it have no place on the globe and are not in the GeoJSON file. Call once, before
  /// the poses.
  void writeAnchor(const Anchor& anchor);
  void write(const Odometry& odometry);
  /// Completes all files; each is valid with any number of poses. Nothing happens a second time.
  void close();

 private:
  void writeGeo(const Eigen::Vector3d& p_map);

  std::filesystem::path folder_;
  std::string name_;
  std::unique_ptr<OutputFile> tum_, kitti_, csv_, geojson_;
  std::optional<LocalEnu> enu_;
  std::optional<Eigen::Vector3d> last_geo_map_;  ///< the newest pose in the GeoJSON file
  std::string first_geo_;                        ///< held back: a line needs two points
  std::size_t geo_points_ = 0;
};

}  // namespace atlas
