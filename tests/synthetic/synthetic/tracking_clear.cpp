// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "atlas/fusion/assignment.hpp"
#include "synthetic/tracking_score.hpp"

namespace atlas::synthetic {
namespace {

constexpr int kRecalls = 40;

constexpr double kKept = 1e6, kPair = 1000.0;  ///< gains: kept pairs first, then as many as possible

void judgeFrame(const ScoredFrame& frame, const std::vector<int>& pair, const std::set<int>& missing,
                const std::map<int, double>& means, std::map<int, std::vector<int>>& found,
                std::map<int, std::vector<char>>& ignored, ClearScore& score) {
  std::vector<char> used(frame.tracks.size(), 0);
  for (std::size_t i = 0; i < frame.truths.size(); ++i) {
    const ScoredTruth& truth = frame.truths[i];
    const bool is_found = pair[i] >= 0;
    const auto j = static_cast<std::size_t>(std::max(pair[i], 0));
    found[truth.id].push_back(is_found ? frame.tracks[j].id : -1);
    ignored[truth.id].push_back(truth.ignored ? 1 : 0);
    if (is_found) {
      used[j] = 1;
      score.scores.push_back(means.at(frame.tracks[j].id));
    }
    if (truth.ignored) {
      score.ignored_true_positives += is_found ? 1 : 0;
      continue;
    }
    ++score.truths;
    if (is_found) {
      ++score.true_positives;
      score.similarity_sum += frame.similarity[i][j];
    } else {
      ++score.false_negatives;
    }
  }
  for (std::size_t j = 0; j < frame.tracks.size(); ++j) {
    if (used[j] == 0 && !frame.tracks[j].ignored && missing.count(frame.tracks[j].id) == 0)
      ++score.false_positives;
  }
}

/// Switches and fragments of one true object, as the development kit of KITTI counts them.
void judgeIdentity(const std::vector<int>& g, const std::vector<char>& ignored, ClearScore& score) {
  if (std::all_of(ignored.begin(), ignored.end(), [](char i) { return i != 0; })) return;
  int last = g.front();
  const std::size_t n = g.size();
  for (std::size_t f = 1; f < n; ++f) {
    if (ignored[f] != 0) {
      last = -1;
      continue;
    }
    if (last != g[f] && last != -1 && g[f] != -1 && g[f - 1] != -1) ++score.switches;
    if (f + 1 < n && g[f - 1] != g[f] && last != -1 && g[f] != -1 && g[f + 1] != -1) ++score.fragments;
    if (g[f] != -1) last = g[f];
  }
  if (n > 1 && g[n - 2] != g[n - 1] && last != -1 && g[n - 1] != -1 && ignored[n - 1] == 0) ++score.fragments;
}

/// Thresholds of the score at which the recall passes k / 40, with k / 40.
std::vector<std::pair<double, double>> thresholds(std::vector<double> scores, std::uint64_t truths) {
  std::sort(scores.begin(), scores.end(), std::greater<>());
  std::vector<std::pair<double, double>> result;
  double recall = 0.0;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const double left = static_cast<double>(i + 1) / static_cast<double>(truths);
    const bool last = i + 1 == scores.size();
    const double right = last ? left : static_cast<double>(i + 2) / static_cast<double>(truths);
    if (right - recall < recall - left && !last) continue;
    result.emplace_back(scores[i], recall);
    recall += 1.0 / kRecalls;
  }
  if (!result.empty()) result.erase(result.begin());  // recall 0
  return result;
}

}  // namespace

std::map<int, double> meanScores(const std::vector<ScoredFrame>& frames) {
  std::map<int, std::pair<double, int>> sums;
  for (const ScoredFrame& frame : frames) {
    for (const ScoredTrack& track : frame.tracks) {
      sums[track.id].first += track.score;
      ++sums[track.id].second;
    }
  }
  std::map<int, double> means;
  for (const auto& [id, sum] : sums) means[id] = sum.first / sum.second;
  return means;
}

std::vector<int> bestPairs(const std::vector<std::vector<double>>& gain) {
  std::vector<std::vector<AssignmentEdge>> edges(gain.size());
  std::size_t columns = 0;
  for (std::size_t i = 0; i < gain.size(); ++i) {
    columns = std::max(columns, gain[i].size());
    for (std::size_t j = 0; j < gain[i].size(); ++j) {
      if (gain[i][j] > 0.0) edges[i].push_back({static_cast<std::uint32_t>(j), -gain[i][j]});
    }
  }
  return assign(edges, columns, 0.0);
}

double ClearScore::mota() const {
  if (truths == 0) return 0.0;
  return 1.0 -
         static_cast<double>(false_negatives + false_positives + switches) / static_cast<double>(truths);
}
double ClearScore::motp() const {
  return true_positives == 0 ? 0.0 : similarity_sum / static_cast<double>(true_positives);
}

std::vector<int> pairsOf(const ScoredFrame& frame, double threshold, const std::map<int, int>& kept) {
  std::vector<std::vector<double>> gain(frame.truths.size(), std::vector<double>(frame.tracks.size(), 0.0));
  for (std::size_t i = 0; i < frame.truths.size(); ++i) {
    const auto before = kept.find(frame.truths[i].id);
    for (std::size_t j = 0; j < frame.tracks.size(); ++j) {
      const double s = frame.similarity[i][j];
      if (s < threshold) continue;
      const bool keep = before != kept.end() && before->second == frame.tracks[j].id;
      gain[i][j] = (keep ? kKept : kPair) + s;
    }
  }
  return bestPairs(gain);
}

std::map<int, int> idsOf(const ScoredFrame& frame, const std::vector<int>& pairs) {
  std::map<int, int> ids;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs[i] >= 0) ids[frame.truths[i].id] = frame.tracks[static_cast<std::size_t>(pairs[i])].id;
  }
  return ids;
}

ClearScore clearMot(const ScoredSequences& sequences, double threshold, std::optional<double> least_score,
                    Pairing pairing) {
  ClearScore score;
  for (const auto& frames : sequences) {
    const std::map<int, double> means = meanScores(frames);
    std::set<int> missing;
    for (const auto& [id, mean] : means) {
      if (least_score && mean < *least_score) missing.insert(id);
    }
    std::map<int, std::vector<int>> found;
    std::map<int, std::vector<char>> ignored;
    std::map<int, int> kept;
    for (const ScoredFrame& frame : frames) {
      ScoredFrame usable = frame;
      for (auto& row : usable.similarity) {
        for (std::size_t j = 0; j < row.size(); ++j) {
          if (missing.count(frame.tracks[j].id) != 0) row[j] = -1.0;
        }
      }
      const std::vector<int> pair = pairsOf(usable, threshold, kept);
      if (pairing == Pairing::kKeep) kept = idsOf(frame, pair);
      judgeFrame(frame, pair, missing, means, found, ignored, score);
    }
    for (const auto& [id, g] : found) judgeIdentity(g, ignored.at(id), score);
  }
  return score;
}

RecallScore overRecall(const ScoredSequences& sequences, double threshold) {
  RecallScore result;
  const ClearScore all = clearMot(sequences, threshold);
  result.best = all;
  const std::uint64_t positives = all.true_positives + all.ignored_true_positives + all.false_negatives;
  if (all.truths == 0 || positives == 0) return result;
  bool first = true;
  for (const auto& [least_score, recall] : thresholds(all.scores, positives)) {
    const ClearScore score = clearMot(sequences, threshold, least_score);
    const double errors = static_cast<double>(score.false_negatives + score.false_positives + score.switches);
    const double truths = static_cast<double>(score.truths);
    result.samota +=
        std::clamp(1.0 - (errors - (1.0 - recall) * truths) / (recall * truths), 0.0, 1.0) / kRecalls;
    result.amota += score.mota() / kRecalls;
    result.amotp += score.motp() / kRecalls;
    ++result.recalls_reached;
    if (first || score.mota() > result.best.mota()) {
      result.best = score;
      result.best_score = least_score;
    }
    first = false;
  }
  return result;
}

}  // namespace atlas::synthetic
