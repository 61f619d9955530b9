// SPDX-License-Identifier: MIT
// Scores of tracks against true ones, from the similarity of both in every frame.
// CLEAR MOT: Bernardin and Stiefelhagen 2008, "Evaluating Multiple Object Tracking Performance"; integrated
// over the recall: Weng et al. 2020, "3D Multi-Object Tracking: A Baseline and New Evaluation Metrics"
// (AB3DMOT). IDF1: Ristani et al. 2016. HOTA: Luiten et al. 2021, "HOTA: A Higher Order Metric for Evaluating
// Multi-Object Tracking", eq. 6 to 13.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace atlas::synthetic {

struct ScoredTruth {
  int id = 0;
  bool ignored = false;  ///< neither missing it nor finding it counts
};
struct ScoredTrack {
  int id = 0;
  double score = 0.0;
  bool ignored = false;  ///< no false positive when it belongs to nothing
};
struct ScoredFrame {
  std::vector<ScoredTruth> truths;
  std::vector<ScoredTrack> tracks;
  std::vector<std::vector<double>> similarity;  ///< [truth][track], 0..1
};
/// Sequences of frames; identities hold within a sequence.
using ScoredSequences = std::vector<std::vector<ScoredFrame>>;

struct ClearScore {
  std::uint64_t truths = 0, true_positives = 0, false_negatives = 0, false_positives = 0;
  std::uint64_t switches = 0, fragments = 0;
  std::uint64_t ignored_true_positives = 0;
  double similarity_sum = 0.0;
  std::vector<double> scores;  ///< of the tracks of all pairs, ignored ones too
  [[nodiscard]] double mota() const;
  [[nodiscard]] double motp() const;
};
/// Which pairs a frame has, where several are possible.
enum class Pairing {
  kEachFrame,  ///< the most similar ones, whatever was before: as the development kit of KITTI and AB3DMOT
  kKeep  ///< those of the frame before as long as they are valid: Bernardin and Stiefelhagen, section 2.1.3
};
/// Pairs of similarity >= threshold, the sum of the similarities as large as possible; tracks whose mean
/// score is below `least_score` do not exist. Switches and fragments as AB3DMOT's evaluation counts them:
/// against the last frame in which the object was found, and not where it is ignored.
[[nodiscard]] ClearScore clearMot(const ScoredSequences& sequences, double threshold,
                                  std::optional<double> least_score = std::nullopt,
                                  Pairing pairing = Pairing::kEachFrame);

struct RecallScore {
  double samota = 0.0, amota = 0.0, amotp = 0.0;
  ClearScore best;                  ///< at the score threshold with the highest MOTA
  double best_score = 0.0;          ///< that threshold
  std::size_t recalls_reached = 0;  ///< of 40
};
/// Over 40 values of recall; those that are not reached count as 0.
[[nodiscard]] RecallScore overRecall(const ScoredSequences& sequences, double threshold);

struct IdentityScore {
  double idf1 = 0.0, precision = 0.0, recall = 0.0;
};
[[nodiscard]] IdentityScore identityScore(const ScoredSequences& sequences, double threshold);

struct HotaScore {
  double hota = 0.0, detection = 0.0, association = 0.0;  ///< mean over alpha = 0.05, 0.10, ..., 0.95
};
[[nodiscard]] HotaScore hotaScore(const ScoredSequences& sequences);

/// Column of each row, -1 = none, so that the sum of `gain` is largest; only gains > 0 are taken.
[[nodiscard]] std::vector<int> bestPairs(const std::vector<std::vector<double>>& gain);
/// Track of each truth of a frame, -1 = none: those of `kept` (track by truth, ids) that are valid, then as
/// many as possible, the similar ones.
[[nodiscard]] std::vector<int> pairsOf(const ScoredFrame& frame, double threshold,
                                       const std::map<int, int>& kept = {});
/// The pairs by id, for the next frame's `kept`.
[[nodiscard]] std::map<int, int> idsOf(const ScoredFrame& frame, const std::vector<int>& pairs);
/// Ignored truths with their tracks, ignored tracks without truths, and tracks whose mean score is below
/// `least_score`, taken out.
[[nodiscard]] ScoredSequences withoutIgnored(const ScoredSequences& sequences, double threshold,
                                             std::optional<double> least_score = std::nullopt);
/// Mean score of each track of a sequence.
[[nodiscard]] std::map<int, double> meanScores(const std::vector<ScoredFrame>& frames);

}  // namespace atlas::synthetic
