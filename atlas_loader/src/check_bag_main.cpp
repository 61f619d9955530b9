// SPDX-License-Identifier: MIT
// check_bag F.bag: prints what is in a bag and what is wrong with it. Exit status 0: nothing, 1: problems, 2:
// unreadable.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "bag_check.hpp"

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

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Judges a bag: order, gaps, rates, gravity, missing topics and frames, stamps against the time of "
      "recording.");
  std::string bag;
  app.add_option("bag", bag, "bag to judge")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    const atlas_loader::BagCheck check = atlas_loader::checkBag(bag);
    print(check);
    return check.problems.empty() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "check_bag: " << error.what() << "\n";
    return 2;
  }
}
