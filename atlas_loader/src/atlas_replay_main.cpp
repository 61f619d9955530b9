// SPDX-License-Identifier: MIT
// atlas_replay (--bag F | --record DIR) --out OUT: the whole suite offline, without a ROS master, by the same
// stages and wiring.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>

#include "input_arguments.hpp"
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
  atlas_loader::addRecordArguments(app, options.input);
  app.add_option("--write", options.write, "also write: deskewed, lines, map_colour")->delimiter(',');
  app.add_flag("--smooth", options.smooth,
               "two passes: position and smooth first, then de-skew and map with the smoothed trajectory");
  app.add_flag("--stereo", options.stereo,
               "match the images of the stereo pair and take them into the occupancy grid");
  app.add_flag("--one-thread", options.one_thread,
               "work in one thread instead of several; the outputs are the same");
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
