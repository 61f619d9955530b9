// SPDX-License-Identifier: MIT
// The scores on cases that can be counted by hand.
#include "synthetic/tracking_score.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace atlas::synthetic {
namespace {

/// Objects 1, 2, ... beside each other; tracks[i] is the id of the track on object i + 1, 0 = none.
ScoredFrame frameOf(const std::vector<int>& tracks, int wrong = 0, double score = 1.0) {
  ScoredFrame frame;
  for (std::size_t i = 0; i < tracks.size(); ++i) frame.truths.push_back({static_cast<int>(i) + 1, false});
  for (const int id : tracks) {
    if (id != 0) frame.tracks.push_back({id, score, false});
  }
  for (int k = 0; k < wrong; ++k) frame.tracks.push_back({900 + k, 0.1, false});
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    frame.similarity.emplace_back();
    for (const ScoredTrack& track : frame.tracks)
      frame.similarity.back().push_back(track.id == tracks[i] ? 0.8 : 0.0);
  }
  return frame;
}

TEST(TrackingScore, ClearMotByHand) {
  // two objects over four frames: one missed once, one changes its track, one track on nothing
  const ScoredSequences sequences = {
      {frameOf({10, 20}), frameOf({10, 0}), frameOf({10, 20}, 1), frameOf({11, 20})}};
  const ClearScore score = clearMot(sequences, 0.5);
  EXPECT_EQ(score.truths, 8U);
  EXPECT_EQ(score.true_positives, 7U);
  EXPECT_EQ(score.false_negatives, 1U);
  EXPECT_EQ(score.false_positives, 1U);
  EXPECT_EQ(score.switches, 1U);
  EXPECT_NEAR(score.mota(), 1.0 - 3.0 / 8.0, 1e-12);
  EXPECT_NEAR(score.motp(), 0.8, 1e-12);
  EXPECT_EQ(clearMot(sequences, 0.9).true_positives, 0U);
}

TEST(TrackingScore, IgnoredOnesCountNeitherWay) {
  ScoredFrame frame = frameOf({10, 0}, 1);
  frame.truths[1].ignored = true;
  frame.tracks[1].ignored = true;
  const ClearScore score = clearMot({{frame}}, 0.5);
  EXPECT_EQ(score.truths, 1U);
  EXPECT_EQ(score.false_negatives + score.false_positives, 0U);
  const ScoredSequences judged = withoutIgnored({{frame}}, 0.5);
  EXPECT_EQ(judged[0][0].truths.size(), 1U);
  EXPECT_EQ(judged[0][0].tracks.size(), 1U);
}

TEST(TrackingScore, IdentityByHand) {
  // the first of four frames on one track, three on another: the longer one is the object's
  const ScoredSequences sequences = {{frameOf({10}), frameOf({11}), frameOf({11}), frameOf({11})}};
  const IdentityScore score = identityScore(sequences, 0.5);
  EXPECT_NEAR(score.recall, 0.75, 1e-12);
  EXPECT_NEAR(score.precision, 0.75, 1e-12);
  EXPECT_NEAR(score.idf1, 0.75, 1e-12);
}

TEST(TrackingScore, PairsAreKeptWhileTheyAreValid) {
  // two tracks of one object, in turn the nearer one; the first is too far off in the last frame
  const auto frameWith = [](double a, double b) {
    ScoredFrame frame;
    frame.truths.push_back({1, false});
    frame.tracks = {{10, 0.0, false}, {11, 0.0, false}};
    frame.similarity = {{a, b}};
    return frame;
  };
  const ScoredSequences sequences = {
      {frameWith(0.9, 0.7), frameWith(0.7, 0.9), frameWith(0.9, 0.7), frameWith(0.4, 0.9)}};
  EXPECT_EQ(clearMot(sequences, 0.5).switches, 3U);
  const ClearScore kept = clearMot(sequences, 0.5, std::nullopt, Pairing::kKeep);
  EXPECT_EQ(kept.switches, 1U);
  EXPECT_EQ(kept.false_positives, 4U);  // the other track is one too many all the same
}

TEST(TrackingScore, HotaByHand) {
  // similarity 0.8 passes 16 of 19 alphas; at each DetA = 1, AssA = (1 * 1/4 + 3 * 3/4) / 4
  const ScoredSequences sequences = {{frameOf({10}), frameOf({11}), frameOf({11}), frameOf({11})}};
  const double association = (1.0 * 0.25 + 3.0 * 0.75) / 4.0;
  const HotaScore score = hotaScore(sequences);
  EXPECT_NEAR(score.detection, 16.0 / 19.0, 1e-9);
  EXPECT_NEAR(score.association, 16.0 / 19.0 * association, 1e-9);
  EXPECT_NEAR(score.hota, 16.0 / 19.0 * std::sqrt(association), 1e-9);
}

TEST(TrackingScore, OverRecall) {
  // everything found by good tracks, wrong ones have a low score: they can be left out by their score
  std::vector<ScoredFrame> frames;
  for (int i = 0; i < 40; ++i) frames.push_back(frameOf({10, 20}, 1));
  const RecallScore score = overRecall({frames}, 0.5);
  EXPECT_NEAR(score.best.mota(), 1.0, 1e-12);
  EXPECT_EQ(score.recalls_reached, 40U);
  EXPECT_NEAR(score.samota, 1.0, 1e-9);
  EXPECT_EQ(overRecall({{frameOf({0, 0})}}, 0.5).recalls_reached, 0U);
}

}  // namespace
}  // namespace atlas::synthetic
