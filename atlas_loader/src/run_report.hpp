// SPDX-License-Identifier: MIT
// Collects a run of the nodelet graph into run.json and into the lines that the user reads at its end.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "files/run_summary.hpp"
#include "open_input.hpp"
#include "run_source.hpp"

namespace atlas_loader {

class RunReport {
 public:
  RunReport(const InputOptions& input, std::string out, const std::string& mode);
  /// Takes the parameters below `ns` as the configuration.
  void readConfiguration(const std::string& ns);
  void fail(const std::string& why) { summary_.failure = why; }
  void note(const std::string& text) { notes_.push_back(text); }
  /// `reader` may be null (events that came from topics).
  void finish(const RunSource& source, const atlas::RecordReader* reader, bool complete);
  /// A screen at most: totals, and everything skipped or late.
  [[nodiscard]] std::vector<std::string> lines() const { return summaryLines(summary_); }
  static std::vector<std::string> summaryLines(const atlas::RunSummary& summary);

 private:
  std::string out_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  atlas::RunSummary summary_;
  std::vector<std::string> notes_;
};

/// JSON text of a ROS parameter tree.
std::string toJson(const XmlRpc::XmlRpcValue& value);

}  // namespace atlas_loader
