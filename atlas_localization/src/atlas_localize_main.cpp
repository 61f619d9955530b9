// SPDX-License-Identifier: MIT
// atlas_localize --imu imu.csv --gnss gnss.csv --out DIR: positioning alone, on plain CSV.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "localize.hpp"

int main(int argc, char** argv) {
  CLI::App app(
      "Positioning from plain CSV: writes DIR/trajectory.tum, smoothed.tum, anchor.json, innovations.csv.\n"
      "imu:  stamp_ns,ax,ay,az,gx,gy,gz[,qx,qy,qz,qw]  (m/s^2, rad/s; forward-left-up, +g on z at rest)\n"
      "gnss: stamp_ns,lat,lon,alt,sd_e,sd_n,sd_u[,heading_deg,sd_heading]  (degrees, m; clockwise from "
      "north)");
  atlas_localization::LocalizeOptions options;
  std::vector<double> lever_arm;
  app.add_option("--imu", options.imu, "CSV of the IMU")->required();
  app.add_option("--gnss", options.gnss, "CSV of the GNSS receiver")->required();
  app.add_option("--out", options.out, "output folder")->required();
  app.add_option("--lever-arm", lever_arm, "x,y,z of the antenna in the imu frame, m")
      ->delimiter(',')
      ->expected(3);
  app.add_option("--config", options.config, "YAML file with a section localization");
  app.add_option("--filter", options.filter, "eskf or kalman_1d (default: the configuration's, else eskf)");
  app.add_flag("--covariances", options.covariances,
               "also trajectory_covariance.csv and smoothed_covariance.csv: velocities and covariances");
  CLI11_PARSE(app, argc, argv);
  if (!lever_arm.empty()) options.lever_arm_m = Eigen::Vector3d(lever_arm[0], lever_arm[1], lever_arm[2]);
  try {
    const atlas_localization::LocalizeSummary summary = atlas_localization::localize(options);
    for (const std::string& line : summary.lines) std::printf("%s\n", line.c_str());
    std::printf("%llu poses\n", static_cast<unsigned long long>(summary.poses));
    return summary.poses > 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "atlas_localize: %s\n", error.what());
    return 2;
  }
}
