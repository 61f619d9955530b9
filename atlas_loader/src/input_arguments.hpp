// SPDX-License-Identifier: MIT
// Command line arguments about a record that several programs have.
#pragma once

#include <CLI/CLI.hpp>

#include "open_input.hpp"

namespace atlas_loader {

inline void addRecordArguments(CLI::App& app, InputOptions& options) {
  app.add_option("--calibration", options.calibration, "calibration folder of a record that carries none");
  app.add_option("--start", options.start_s, "skip this many seconds");
  app.add_option("--duration", options.duration_s, "only this many seconds");
  app.add_option("--imu-latency", options.imu_latency_s, "s from an IMU sample to its stamp in the record");
  app.add_option("--gnss-latency", options.gnss_latency_s, "s from a GNSS fix to its stamp in the record");
  app.add_option("--lidar-latency", options.lidar_latency_s,
                 "s from the end of a scan to its stamp in the record");
  app.add_option("--scan-stamp", options.scan_stamp, "what the stamp of a scan marks: end or start")
      ->check(CLI::IsMember({"end", "start"}));
}

}  // namespace atlas_loader
