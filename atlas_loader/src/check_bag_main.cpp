// SPDX-License-Identifier: MIT
// check_bag F.bag: prints what is in a bag and what is wrong with it. Exit status 0: nothing, 1: problems, 2:
// unreadable.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "bag_check.hpp"
#include "scan_stamp_check.hpp"

namespace {

void print(const atlas_loader::BagCheck& check) {
  std::printf("%-42s %9s %9s %9s %6s %6s %9s\n", "topic", "messages", "rate Hz", "gap s", "back", "twice",
              "delay s");
  for (const auto& [topic, t] : check.topics) {
    std::printf("%-42s %9lu %9.2f %9.3f %6lu %6lu %9.3f\n", topic.c_str(),
                static_cast<unsigned long>(t.messages), t.rate_hz, t.largest_gap_s,
                static_cast<unsigned long>(t.backwards), static_cast<unsigned long>(t.duplicates),
                t.median_delay_s);
  }
  for (const std::string& remark : check.remarks) std::printf("note: %s\n", remark.c_str());
  for (const std::string& problem : check.problems) std::printf("PROBLEM: %s\n", problem.c_str());
  std::printf("%zu problem%s\n", check.problems.size(), check.problems.size() == 1 ? "" : "s");
}

void addScanStamps(const std::string& bag, atlas_loader::BagCheck& check) {
  atlas_loader::InputOptions input;
  input.bag = bag;
  for (const atlas_loader::ScanStampFit& fit : atlas_loader::tryScanStamps(input)) {
    const atlas_loader::ScanStampVerdict verdict = atlas_loader::judge(fit);
    (verdict.is_problem ? check.problems : check.remarks).push_back(verdict.text);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Judges a bag: order, gaps, rates, gravity, missing topics and frames, stamps against the time of "
      "recording.");
  std::string bag;
  bool scan_stamps = false;
  app.add_option("bag", bag, "bag to judge")->required();
  app.add_flag("--scan-stamps", scan_stamps,
               "also position the bag and try which moment of a sweep the stamps of lidars mark (slow)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    atlas_loader::BagCheck check = atlas_loader::checkBag(bag);
    if (scan_stamps) addScanStamps(bag, check);
    print(check);
    return check.problems.empty() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "check_bag: " << error.what() << "\n";
    return 2;
  }
}
