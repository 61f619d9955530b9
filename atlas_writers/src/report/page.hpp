// SPDX-License-Identifier: MIT
// The one-page report OUT/report/index.html with its pictures beside it. Whatever the run did not make is
// left out and said so.
#pragma once

#include <filesystem>
#include <string>

namespace atlas::report {

struct PageOptions {
  std::filesystem::path out;         ///< output folder of a run
  std::filesystem::path evaluation;  ///< JSON of the comparison with the truth; may be empty
  std::filesystem::path screenshot;  ///< PNG of RViz; may be empty
  std::string record_label;          ///< what was replayed, for the subtitle
};

/// Writes OUT/report/ and returns the page's path. Throws std::runtime_error when OUT or run.json cannot be
/// read.
std::filesystem::path writeReport(const PageOptions& options);

}  // namespace atlas::report
