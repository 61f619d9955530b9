// SPDX-License-Identifier: MIT
// atlas_report --out OUT: makes OUT/report/index.html from what a run left in OUT.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "report/page.hpp"

int main(int argc, char** argv) {
  atlas::report::PageOptions options;
  CLI::App app("Writes OUT/report/index.html from the outputs of a run.");
  app.add_option("--out", options.out, "output folder of a run")->required()->check(CLI::ExistingDirectory);
  app.add_option("--evaluation", options.evaluation, "JSON with errors against the truth")
      ->check(CLI::ExistingFile);
  app.add_option("--record-label", options.record_label, "what was replayed");
  app.add_option("--screenshot", options.screenshot, "PNG of RViz")->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);
  try {
    std::printf("report: %s\n", atlas::report::writeReport(options).c_str());
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "atlas_report: %s\n", error.what());
    return 1;
  }
}
