// SPDX-License-Identifier: MIT
// score_tracking --labels DIR --results DIR [--sequences 0012,...]: tracks in KITTI's format against its
// labels by the measures of AB3DMOT (3D overlap of at least 0.25), HOTA and IDF1.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include "synthetic/kitti_tracks.hpp"

namespace {

namespace fs = std::filesystem;
using namespace atlas::synthetic;

void scoreClass(const std::string& name, const ScoredSequences& sequences, double overlap) {
  const RecallScore recall = overRecall(sequences, overlap);
  if (recall.best.truths == 0) return;
  const ScoredSequences judged = withoutIgnored(sequences, overlap, recall.best_score);
  const HotaScore hota = hotaScore(judged);
  std::printf("%-11s %6.2f %6.2f %6.2f %6.2f %6.2f %4llu %4llu %5llu %5llu %6.2f %6.2f %7llu\n", name.c_str(),
              100.0 * recall.samota, 100.0 * recall.amota, 100.0 * recall.amotp, 100.0 * recall.best.mota(),
              100.0 * recall.best.motp(), static_cast<unsigned long long>(recall.best.switches),
              static_cast<unsigned long long>(recall.best.fragments),
              static_cast<unsigned long long>(recall.best.false_positives),
              static_cast<unsigned long long>(recall.best.false_negatives), 100.0 * hota.hota,
              100.0 * identityScore(judged, overlap).idf1,
              static_cast<unsigned long long>(recall.best.truths));
}

int run(int argc, char** argv) {
  fs::path labels, results;
  std::vector<std::string> sequences;
  double overlap = 0.25;
  CLI::App app("Scores tracks in KITTI's format by the measures of AB3DMOT, HOTA and IDF1");
  app.add_option("--labels", labels, "folder with 0000.txt, ...")->required()->check(CLI::ExistingDirectory);
  app.add_option("--results", results, "folder with 0000.txt, ...")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_option("--sequences", sequences, "0012,... (default: all in results)")->delimiter(',');
  app.add_option("--overlap", overlap, "least intersection over union in 3D")
      ->capture_default_str()
      ->check(CLI::Range(0.01, 1.0));
  CLI11_PARSE(app, argc, argv);
  if (sequences.empty()) {
    for (const auto& entry : fs::directory_iterator(results)) {
      if (entry.path().extension() == ".txt") sequences.push_back(entry.path().stem().string());
    }
    std::sort(sequences.begin(), sequences.end());
  }
  if (sequences.empty()) throw std::invalid_argument(results.string() + ": no results (0000.txt, ...)");
  std::printf("%-11s %6s %6s %6s %6s %6s %4s %4s %5s %5s %6s %6s %7s\n", "class", "sAMOTA", "AMOTA", "AMOTP",
              "MOTA", "MOTP", "IDS", "FRAG", "FP", "FN", "HOTA", "IDF1", "truths");
  for (const char* name : {"Car", "Pedestrian", "Cyclist"}) {
    ScoredSequences all;
    for (const std::string& sequence : sequences)
      all.push_back(readKittiTracks(labels / (sequence + ".txt"), results / (sequence + ".txt"), name));
    scoreClass(name, all, overlap);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "score_tracking: %s\n", error.what());
    return 1;
  }
}
