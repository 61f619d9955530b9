// SPDX-License-Identifier: MIT
// atlas_replay (--bag F | --record DIR) --out OUT: the whole suite offline, without a ROS master, by the same
// stages and wiring.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "open_input.hpp"
#include "progress_bar.hpp"
#include "replay.hpp"
#include "run_report.hpp"

int main(int argc, char** argv) {
  CLI::App app("Replays a bag or a record through the suite, offline.");
  atlas_loader::ReplayOptions options;
  app.add_option("--bag", options.input.bag, "bag to replay");
  app.add_option("--record", options.input.record, "record to replay (Brno Urban Dataset, KITTI raw)");
  app.add_option("--out", options.out, "output folder")->required();
  app.add_option("--config", options.config,
                 "parameters of all stages (default: the packaged ones that fit the input)");
  app.add_option("--calibration", options.input.calibration,
                 "calibration folder of a record that carries none");
  app.add_option("--start", options.input.start_s, "skip this many seconds");
  app.add_option("--duration", options.input.duration_s, "replay this many seconds");
  app.add_option("--write", options.write, "also write: deskewed")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  try {
    const atlas::RunSummary summary = atlas_loader::replay(options);
    for (const std::string& line : atlas_loader::RunReport::summaryLines(summary))
      std::printf("%s\n", line.c_str());
    return summary.complete ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "atlas_replay: " << error.what() << "\n";
    return 2;
  }
}
