// SPDX-License-Identifier: MIT
// smooth_trajectory (--bag F | --record DIR) --out OUT: the trajectory of a recorded run, each pose from the
// measurements before and after it. Writes OUT/trajectory/smoothed.tum.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "atlas/localization/eskf_history.hpp"
#include "smooth_run.hpp"

int main(int argc, char** argv) {
  CLI::App app("Smooths the trajectory of a bag or a record, offline.");
  atlas_loader::InputOptions input;
  std::string out, config;
  app.add_option("--bag", input.bag, "bag to replay");
  app.add_option("--record", input.record, "record to replay (Brno Urban Dataset, KITTI raw)");
  app.add_option("--out", out, "output folder")->required();
  app.add_option("--config", config, "parameters (default: the packaged ones that fit the input)");
  app.add_option("--calibration", input.calibration, "calibration folder of a record that carries none");
  app.add_option("--start", input.start_s, "skip this many seconds");
  app.add_option("--duration", input.duration_s, "use this many seconds");
  CLI11_PARSE(app, argc, argv);
  try {
    const auto run = atlas_loader::smoothRun(input, atlas_loader::localizationParams(config, input), out);
    std::printf("%zu poses in %s/trajectory/smoothed.tum\n", run->size(), out.c_str());
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "smooth_trajectory: " << error.what() << "\n";
    return 2;
  }
}
