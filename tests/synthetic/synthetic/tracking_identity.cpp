// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "synthetic/tracking_score.hpp"

namespace atlas::synthetic {
namespace {

constexpr int kAlphas = 19;  ///< 0.05, 0.10, ..., 0.95

/// Frames in which each pair of identities is similar enough, and in which each exists.
struct Together {
  std::map<std::pair<int, int>, std::uint64_t> pair;
  std::map<int, std::uint64_t> truth, track;
};

Together together(const std::vector<ScoredFrame>& frames, double threshold) {
  Together counts;
  for (const ScoredFrame& frame : frames) {
    for (const ScoredTruth& truth : frame.truths) ++counts.truth[truth.id];
    for (const ScoredTrack& track : frame.tracks) ++counts.track[track.id];
    for (std::size_t i = 0; i < frame.truths.size(); ++i) {
      for (std::size_t j = 0; j < frame.tracks.size(); ++j) {
        if (frame.similarity[i][j] >= threshold) ++counts.pair[{frame.truths[i].id, frame.tracks[j].id}];
      }
    }
  }
  return counts;
}

/// Sum over frames of the similarity of a pair, over that of all its rivals: who belongs to whom (TrackEval).
std::map<std::pair<int, int>, double> globalAlignment(const std::vector<ScoredFrame>& frames,
                                                      const Together& exist) {
  std::map<std::pair<int, int>, double> shared;
  for (const ScoredFrame& frame : frames) {
    std::vector<double> of_truth(frame.truths.size(), 0.0), of_track(frame.tracks.size(), 0.0);
    for (std::size_t i = 0; i < frame.truths.size(); ++i) {
      for (std::size_t j = 0; j < frame.tracks.size(); ++j) {
        of_truth[i] += frame.similarity[i][j];
        of_track[j] += frame.similarity[i][j];
      }
    }
    for (std::size_t i = 0; i < frame.truths.size(); ++i) {
      for (std::size_t j = 0; j < frame.tracks.size(); ++j) {
        const double s = frame.similarity[i][j];
        if (s > 0.0) shared[{frame.truths[i].id, frame.tracks[j].id}] += s / (of_truth[i] + of_track[j] - s);
      }
    }
  }
  std::map<std::pair<int, int>, double> alignment;
  for (const auto& [ids, sum] : shared) {
    const double either = static_cast<double>(exist.truth.at(ids.first) + exist.track.at(ids.second)) - sum;
    alignment[ids] = sum / either;
  }
  return alignment;
}

struct Matches {
  std::uint64_t true_positives = 0, truths = 0, tracks = 0;
  double association_sum = 0.0;
};

/// True positives at one alpha, and the sum over them of |TPA| / |TPA + FPA + FNA| (eq. 9).
Matches matchesAt(const std::vector<ScoredFrame>& frames, const Together& exist,
                  const std::map<std::pair<int, int>, double>& alignment, double alpha) {
  Matches result;
  std::map<std::pair<int, int>, std::uint64_t> matched;
  for (const ScoredFrame& frame : frames) {
    std::vector<std::vector<double>> gain(frame.truths.size(), std::vector<double>(frame.tracks.size(), 0.0));
    for (std::size_t i = 0; i < frame.truths.size(); ++i) {
      for (std::size_t j = 0; j < frame.tracks.size(); ++j) {
        const double s = frame.similarity[i][j];
        if (s < alpha - 1e-12) continue;
        // most pairs first, then the lasting ones, then the similar ones
        gain[i][j] = 1000.0 + alignment.at({frame.truths[i].id, frame.tracks[j].id}) + 1e-3 * s;
      }
    }
    const std::vector<int> pair = bestPairs(gain);
    for (std::size_t i = 0; i < pair.size(); ++i) {
      if (pair[i] < 0) continue;
      ++matched[{frame.truths[i].id, frame.tracks[static_cast<std::size_t>(pair[i])].id}];
      ++result.true_positives;
    }
    result.truths += frame.truths.size();
    result.tracks += frame.tracks.size();
  }
  for (const auto& [ids, count] : matched) {
    const double either = static_cast<double>(exist.truth.at(ids.first) + exist.track.at(ids.second) - count);
    result.association_sum += static_cast<double>(count) * static_cast<double>(count) / either;
  }
  return result;
}

}  // namespace

IdentityScore identityScore(const ScoredSequences& sequences, double threshold) {
  std::uint64_t true_positives = 0, truths = 0, tracks = 0;
  for (const auto& frames : sequences) {
    const Together counts = together(frames, threshold);
    std::vector<int> truth_ids, track_ids;
    for (const auto& [id, count] : counts.truth) {
      truth_ids.push_back(id);
      truths += count;
    }
    for (const auto& [id, count] : counts.track) {
      track_ids.push_back(id);
      tracks += count;
    }
    std::vector<std::vector<double>> gain(truth_ids.size(), std::vector<double>(track_ids.size(), 0.0));
    for (std::size_t i = 0; i < truth_ids.size(); ++i) {
      for (std::size_t j = 0; j < track_ids.size(); ++j) {
        const auto both = counts.pair.find({truth_ids[i], track_ids[j]});
        if (both != counts.pair.end()) gain[i][j] = static_cast<double>(both->second);
      }
    }
    const std::vector<int> pair = bestPairs(gain);
    for (std::size_t i = 0; i < pair.size(); ++i) {
      if (pair[i] >= 0)
        true_positives += static_cast<std::uint64_t>(gain[i][static_cast<std::size_t>(pair[i])]);
    }
  }
  IdentityScore score;
  if (truths + tracks == 0) return score;
  score.idf1 = 2.0 * static_cast<double>(true_positives) / static_cast<double>(truths + tracks);
  score.precision = tracks == 0 ? 0.0 : static_cast<double>(true_positives) / static_cast<double>(tracks);
  score.recall = truths == 0 ? 0.0 : static_cast<double>(true_positives) / static_cast<double>(truths);
  return score;
}

HotaScore hotaScore(const ScoredSequences& sequences) {
  HotaScore score;
  std::vector<Together> exist;
  std::vector<std::map<std::pair<int, int>, double>> alignments;
  for (const auto& frames : sequences) {
    exist.push_back(together(frames, 0.0));
    alignments.push_back(globalAlignment(frames, exist.back()));
  }
  for (int a = 1; a <= kAlphas; ++a) {
    Matches all;
    for (std::size_t s = 0; s < sequences.size(); ++s) {
      const Matches matches = matchesAt(sequences[s], exist[s], alignments[s], 0.05 * a);
      all.true_positives += matches.true_positives;
      all.truths += matches.truths;
      all.tracks += matches.tracks;
      all.association_sum += matches.association_sum;
    }
    if (all.true_positives == 0) continue;
    const double tp = static_cast<double>(all.true_positives);
    const double detection = tp / (static_cast<double>(all.truths + all.tracks) - tp);
    const double association = all.association_sum / tp;
    score.detection += detection / kAlphas;
    score.association += association / kAlphas;
    score.hota += std::sqrt(detection * association) / kAlphas;
  }
  return score;
}

ScoredSequences withoutIgnored(const ScoredSequences& sequences, double threshold,
                               std::optional<double> least_score) {
  ScoredSequences result;
  for (const auto& frames : sequences) {
    result.emplace_back();
    const std::map<int, double> means = meanScores(frames);
    for (const ScoredFrame& frame : frames) {
      const std::vector<int> pair = pairsOf(frame, threshold);
      std::vector<char> keep(frame.tracks.size(), 1);
      for (std::size_t j = 0; j < frame.tracks.size(); ++j) keep[j] = frame.tracks[j].ignored ? 0 : 1;
      for (std::size_t i = 0; i < pair.size(); ++i) {
        if (pair[i] >= 0) keep[static_cast<std::size_t>(pair[i])] = frame.truths[i].ignored ? 0 : 1;
      }
      for (std::size_t j = 0; j < keep.size(); ++j) {
        if (least_score && means.at(frame.tracks[j].id) < *least_score) keep[j] = 0;
      }
      ScoredFrame kept;
      for (std::size_t j = 0; j < keep.size(); ++j) {
        if (keep[j] != 0) kept.tracks.push_back(frame.tracks[j]);
      }
      for (std::size_t i = 0; i < frame.truths.size(); ++i) {
        if (frame.truths[i].ignored) continue;
        kept.truths.push_back(frame.truths[i]);
        kept.similarity.emplace_back();
        for (std::size_t j = 0; j < keep.size(); ++j) {
          if (keep[j] != 0) kept.similarity.back().push_back(frame.similarity[i][j]);
        }
      }
      result.back().push_back(std::move(kept));
    }
  }
  return result;
}

}  // namespace atlas::synthetic
