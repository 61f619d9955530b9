// SPDX-License-Identifier: MIT
// evaluate_run --truth RECORD/truth --out OUT [--json FILE]: errors of a run against the truth of a synthetic
// drive. See synthetic/evaluate.hpp.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <fstream>
#include <stdexcept>

#include "synthetic/evaluate.hpp"

namespace {

namespace fs = std::filesystem;

void writeJson(const fs::path& path, const nlohmann::ordered_json& json) {
  if (path.has_parent_path()) fs::create_directories(path.parent_path());
  const fs::path temporary = path.string() + ".part";
  std::ofstream file(temporary);
  file << json.dump(1) << "\n";
  file.close();
  if (!file) throw std::runtime_error("cannot write " + temporary.string());
  fs::rename(temporary, path);
}

int run(int argc, char** argv) {
  atlas::synthetic::RunFolders folders;
  fs::path json;
  CLI::App app("Compares the output folder of a run with the truth of a synthetic drive");
  app.add_option("--truth", folders.truth, "RECORD/truth")->required()->check(CLI::ExistingDirectory);
  app.add_option("--out", folders.out, "output folder of the run")->required()->check(CLI::ExistingDirectory);
  app.add_option("--record", folders.record, "record with the detections (default: the folder of truth)");
  app.add_option("--json", json, "write the same numbers to this file");
  CLI11_PARSE(app, argc, argv);
  if (folders.record.empty()) folders.record = fs::absolute(folders.truth / "x").parent_path().parent_path();
  const atlas::synthetic::Evaluation evaluation = atlas::synthetic::evaluateRun(folders);
  std::fputs(evaluation.toText().c_str(), stdout);
  if (evaluation.empty()) throw std::runtime_error(folders.out.string() + ": nothing in it can be compared");
  if (!json.empty()) writeJson(json, evaluation.toJson());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "evaluate_run: %s\n", error.what());
    return 1;
  }
}
