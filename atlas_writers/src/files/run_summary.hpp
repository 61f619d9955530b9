// SPDX-License-Identifier: MIT
// run.json: what a run read, did and skipped. Everything that was not used is in it with a reason.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "atlas/sensor/record_reader.hpp"

namespace atlas {

struct RunInput {
  std::string path;
  std::uint64_t bytes = 0;
  std::string sha256;
  std::string hashed;  ///< what the hash covers: "file", or "names, sizes and files up to 16 MB" for folders
};

struct RunSummary {
  std::string mode;       ///< "offline" or "nodelets"
  bool complete = false;  ///< every stage came to its end
  std::string failure;    ///< empty when complete
  std::vector<RunInput> inputs;
  std::string configuration;                     ///< JSON text
  std::map<std::string, std::uint64_t> streams;  ///< events given to the stages, by topic
  std::map<std::string, std::map<std::string, std::uint64_t>> stages;  ///< counters by stage
  std::map<std::string, FileReport> files;                             ///< rows of each input file or topic
  std::vector<std::string> notes;
  double data_s = 0, wall_s = 0, cpu_s = 0, peak_rss_mb = 0;
};

/// Version of the suite, as in package.xml.
std::string suiteVersion();

/// SHA-256 of a file or, for a folder, of the sorted list of its files with their sizes and the contents of
/// those up to 16 MB. Throws std::runtime_error naming what cannot be read.
RunInput hashInput(const std::string& path);

std::string toJson(const RunSummary& summary);
/// Writes <out>/run.json (temporary name, then renamed).
void writeRunSummary(const std::string& out, const RunSummary& summary);

/// Fills cpu_s and peak_rss_mb of this process.
void measureProcess(RunSummary& summary);

}  // namespace atlas
