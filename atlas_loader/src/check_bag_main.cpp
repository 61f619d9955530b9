// SPDX-License-Identifier: MIT
// check_bag F.bag: prints what is in a bag and what is wrong with it. Exit status 0: nothing, 1: problems, 2: unreadable.
#include <cstdio>
#include <iostream>

#include "bag_check.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: check_bag F.bag\n";
    return 2;
  }
  try {
    const atlas_loader::BagCheck check = atlas_loader::checkBag(argv[1]);
    std::printf("%-42s %9s %9s %9s %6s %6s %9s\n", "topic", "messages", "rate Hz", "gap s", "back", "twice", "delay s");
    for (const auto& [topic, t] : check.topics) {
      std::printf("%-42s %9lu %9.2f %9.3f %6lu %6lu %9.3f\n", topic.c_str(), static_cast<unsigned long>(t.messages), t.rate_hz,
                  t.largest_gap_s, static_cast<unsigned long>(t.backwards), static_cast<unsigned long>(t.duplicates),
                  t.median_delay_s);
    }
    for (const std::string& remark : check.remarks) std::printf("note: %s\n", remark.c_str());
    for (const std::string& problem : check.problems) std::printf("PROBLEM: %s\n", problem.c_str());
    std::printf("%zu problems\n", check.problems.size());
    return check.problems.empty() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "check_bag: " << error.what() << "\n";
    return 2;
  }
}
