// SPDX-License-Identifier: MIT
// record_to_bag RECORD -o F.bag: a record as a bag, with a summary of every row of every file.
#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "input_arguments.hpp"
#include "open_input.hpp"
#include "progress_bar.hpp"
#include "record_bag.hpp"

namespace {

std::atomic<bool> g_interrupted{false};  // set by the signal handler, which can reach nothing else

int convert(const atlas_loader::InputOptions& options, const std::string& output) {
  const auto reader = atlas_loader::openInput(options);
  atlas_loader::ProgressBar bar("converting", atlas_loader::requestedSpan(reader->span(), options));
  const auto counts = atlas_loader::writeBag(*reader, output, [&bar](atlas::Stamp stamp) {
    bar.show(stamp);
    return !g_interrupted;
  });
  if (!counts.complete) {
    std::cerr << "\nrecord_to_bag: interrupted, what was written is in " << output << ".part\n";
    return 130;  // as a shell says of a program ended by Ctrl-C
  }
  bar.finish();
  for (const std::string& line : atlas_loader::conversionSummary(*reader, counts))
    std::printf("%s\n", line.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Converts a record (Brno Urban Dataset, KITTI raw) into a bag.");
  atlas_loader::InputOptions options;
  std::string output;
  bool force = false;
  app.add_option("record", options.record, "folder of the record")->required();
  app.add_option("-o,--output", output, "bag to write")->required();
  app.add_option("--images", options.images, "h265 (packets as recorded), jpeg or raw")
      ->check(CLI::IsMember({"h265", "jpeg", "raw"}));
  atlas_loader::addRecordArguments(app, options);
  app.add_option("--topics", options.topics, "only these topics")->delimiter(',');
  app.add_flag("--force", force, "overwrite the bag");
  CLI11_PARSE(app, argc, argv);
  if (std::filesystem::exists(output) && !force) {
    std::cerr << output << " exists; --force overwrites it\n";
    return 2;
  }
  std::signal(SIGINT, [](int) { g_interrupted = true; });
  std::signal(SIGTERM, [](int) { g_interrupted = true; });
  try {
    return convert(options, output);
  } catch (const std::exception& error) {
    std::cerr << "record_to_bag: " << error.what() << "\n";
    return 1;
  }
}
