// SPDX-License-Identifier: MIT
#include "run_report.hpp"

#include <ros/param.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace atlas_loader {
namespace {

using nlohmann::json;

json toTree(const XmlRpc::XmlRpcValue& constant) {
  XmlRpc::XmlRpcValue value = constant;  // its accessors are not const
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return static_cast<bool>(value);
    case XmlRpc::XmlRpcValue::TypeInt:
      return static_cast<int>(value);
    case XmlRpc::XmlRpcValue::TypeDouble:
      return static_cast<double>(value);
    case XmlRpc::XmlRpcValue::TypeString:
      return static_cast<std::string>(value);
    case XmlRpc::XmlRpcValue::TypeArray: {
      json list = json::array();
      for (int i = 0; i < value.size(); ++i) list.push_back(toTree(value[i]));
      return list;
    }
    case XmlRpc::XmlRpcValue::TypeStruct: {
      json map = json::object();
      for (auto& [key, entry] : value) map[key] = toTree(entry);
      return map;
    }
    default:
      return nullptr;
  }
}

bool startsWith(const std::string& text, const std::string& begin) {
  return text.compare(0, begin.size(), begin) == 0;
}

}  // namespace

std::string toJson(const XmlRpc::XmlRpcValue& value) { return toTree(value).dump(); }

RunReport::RunReport(const InputOptions& input, std::string out, const std::string& mode)
    : out_(std::move(out)) {
  summary_.mode = mode;
  for (const std::string& path : {input.bag, input.record}) {
    if (!path.empty() && !out_.empty()) summary_.inputs.push_back(atlas::hashInput(path));
  }
}

void RunReport::readConfiguration(const std::string& ns) {
  XmlRpc::XmlRpcValue value;
  if (ros::param::get(ns, value)) summary_.configuration = toJson(value);
}

void RunReport::finish(const RunSource& source, const atlas::RecordReader* reader, bool complete) {
  summary_.complete = complete;
  if (summary_.failure.empty()) summary_.failure = source.failure();
  if (!complete && summary_.failure.empty()) summary_.failure = "interrupted";
  summary_.streams = source.published();
  for (const auto& [stage, report] : source.stages()) summary_.stages[stage] = report.counters;
  if (reader != nullptr) {
    summary_.files = reader->report();
    summary_.notes = reader->notes();
    summary_.data_s = atlas::toSeconds(reader->span().second - reader->span().first);
  }
  summary_.notes.insert(summary_.notes.end(), notes_.begin(), notes_.end());
  summary_.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  atlas::measureProcess(summary_);
  if (!out_.empty()) atlas::writeRunSummary(out_, summary_);
}

std::vector<std::string> RunReport::summaryLines(const atlas::RunSummary& summary) {
  std::vector<std::string> lines;
  std::uint64_t events = 0;
  for (const auto& [topic, count] : summary.streams) events += count;
  std::ostringstream total;
  total << (summary.complete ? "complete" : "INCOMPLETE (" + summary.failure + ")") << ": " << events
        << " events, ";
  total.precision(1);
  total << std::fixed << summary.data_s << " s of data in " << summary.wall_s << " s, " << summary.cpu_s
        << " s of CPU, " << summary.peak_rss_mb << " MB at most";
  lines.push_back(total.str());
  for (const auto& [name, file] : summary.files) {
    for (const auto& [reason, count] : file.skipped) {
      lines.push_back("  " + name + ": " + std::to_string(count) + " of " + std::to_string(file.rows) +
                      " skipped: " + reason);
    }
  }
  for (const auto& [stage, counters] : summary.stages) {
    for (const auto& [name, value] : counters) {
      if (value > 0 && (startsWith(name, "skipped") || startsWith(name, "late"))) {
        lines.push_back("  " + stage + ": " + std::to_string(value) + " " + name);
      }
    }
  }
  for (const std::string& note : summary.notes) lines.push_back("  note: " + note);
  return lines;
}

}  // namespace atlas_loader
