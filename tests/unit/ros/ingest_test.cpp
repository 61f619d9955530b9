// SPDX-License-Identifier: MIT
// Messages that arrive in any order leave in the order of their stamps; what is too late is counted; a loop
// begins anew.
#include "ingest.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace {

using atlas_loader::Ingest;
using Item = Ingest::Item;
constexpr atlas::Stamp kBegin = 1'000'000'000'000;
constexpr atlas::Duration kStep = 10 * atlas::kMillisecond;

std::vector<atlas::StreamInfo> streams() {
  return {{"tf_static", atlas::StreamKind::kStaticTransforms, 0},
          {"imu/data", atlas::StreamKind::kImu, 0},
          {"gnss/fix", atlas::StreamKind::kGnssFix, 0}};
}
atlas::Payload imu(atlas::Stamp stamp) {
  atlas::ImuSample sample;
  sample.stamp = stamp;
  return sample;
}

std::vector<std::pair<std::size_t, atlas::Stamp>> drain(Ingest& ingest) {
  std::vector<std::pair<std::size_t, atlas::Stamp>> order;
  while (true) {
    const auto item = ingest.pop();
    if (!item || item->kind == Item::Kind::kEndOfRun) return order;
    if (item->kind == Item::Kind::kEvent) order.emplace_back(item->event->stream, item->event->stamp);
  }
}

TEST(Ingest, ArrivalOrderOfStreamsHasNoInfluence) {
  std::vector<std::pair<std::size_t, atlas::Stamp>> expected;
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::deque<atlas::Stamp>> left(3);
    for (int i = 0; i < 100; ++i) left[1].push_back(kBegin + i * kStep);
    for (int i = 0; i < 20; ++i) left[2].push_back(kBegin + 5 * i * kStep);
    Ingest ingest(streams(), 2 * atlas::kSecond);
    while (!left[1].empty() || !left[2].empty()) {
      std::size_t stream = 1 + random() % 2;
      if (left[stream].empty()) stream = 3 - stream;
      ingest.push(stream, left[stream].front(), imu(left[stream].front()));
      left[stream].pop_front();
    }
    ingest.finish();
    const auto order = drain(ingest);
    EXPECT_EQ(ingest.late(), 0U);
    if (seed == 0) {
      expected = order;
      EXPECT_EQ(order.size(), 120U);
      EXPECT_TRUE(std::is_sorted(order.begin(), order.end(), [](const auto& a, const auto& b) {
        return std::make_pair(a.second, a.first) < std::make_pair(b.second, b.first);
      }));
    } else {
      EXPECT_EQ(order, expected) << "seed " << seed;
    }
  }
}

TEST(Ingest, StaticTransformsComeFirst) {
  Ingest ingest(streams(), atlas::kSecond);
  ingest.push(1, kBegin, imu(kBegin));
  ingest.push(0, kBegin + 5, atlas::StaticTransforms{});
  ingest.finish();
  const auto order = drain(ingest);
  ASSERT_EQ(order.size(), 2U);
  EXPECT_EQ(order[0].first, 0U);
}

TEST(Ingest, ASilentStreamDelaysButDoesNotBlock) {
  Ingest ingest(streams(), atlas::kSecond);
  for (int i = 0; i <= 200; ++i) ingest.push(1, kBegin + i * kStep, imu(0));
  for (int i = 0; i < 100; ++i) ASSERT_EQ(ingest.pop()->event->stamp, kBegin + i * kStep);
}

TEST(Ingest, TooLateIsCountedNotDelivered) {
  Ingest ingest(streams(), atlas::kSecond);
  for (int i = 0; i <= 300; ++i) ingest.push(1, kBegin + i * kStep, imu(0));
  ingest.push(2, kBegin, imu(0));  // 3 s behind the newest
  ingest.finish();
  const auto order = drain(ingest);
  EXPECT_EQ(order.size(), 301U);
  EXPECT_EQ(ingest.late(), 1U);
}

TEST(Ingest, TimeThatJumpsBackEndsTheEpoch) {
  Ingest ingest(streams(), atlas::kSecond);
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i <= 300; ++i) ingest.push(1, kBegin + i * kStep, imu(0));
  }
  ingest.finish();
  std::size_t events = 0, epochs = 0;
  while (true) {
    const auto item = ingest.pop();
    if (item->kind == Item::Kind::kEndOfRun) break;
    if (item->kind == Item::Kind::kEndOfEpoch) ++epochs;
    if (item->kind == Item::Kind::kEvent) ++events;
  }
  EXPECT_EQ(events, 602U);
  EXPECT_EQ(epochs, 1U);
  EXPECT_EQ(ingest.late(), 0U);
}

/// Events of each epoch; the last one has the rest.
std::vector<std::size_t> eventsOfEpochs(Ingest& ingest) {
  std::vector<std::size_t> events(1, 0);
  for (auto item = ingest.pop(); item->kind != Item::Kind::kEndOfRun; item = ingest.pop()) {
    if (item->kind == Item::Kind::kEndOfEpoch) events.push_back(0);
    if (item->kind == Item::Kind::kEvent) ++events.back();
  }
  return events;
}

TEST(Ingest, StreamsGetIntoTheNextEpochOneByOne) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::vector<std::deque<atlas::Stamp>> left(3);
    for (int round = 0; round < 3; ++round) {
      for (int i = 0; i <= 500; ++i) left[1].push_back(kBegin + i * kStep);
      for (int i = 0; i <= 100; ++i) left[2].push_back(kBegin + 5 * i * kStep);
    }
    Ingest ingest(streams(), 2 * atlas::kSecond);
    while (!left[1].empty() || !left[2].empty()) {  // either stream up to 30 messages of the imu ahead
      const double imu_share = static_cast<double>(left[1].size()) / 501.0;
      const double fix_share = static_cast<double>(left[2].size()) / 101.0;
      std::size_t stream = 1 + random() % 2;
      if (imu_share < fix_share - 0.06) stream = 2;
      if (fix_share < imu_share - 0.06) stream = 1;
      if (left[stream].empty()) stream = 3 - stream;
      ingest.push(stream, left[stream].front(), imu(left[stream].front()));
      left[stream].pop_front();
    }
    ingest.finish();
    EXPECT_EQ(eventsOfEpochs(ingest), (std::vector<std::size_t>{602, 602, 602})) << "seed " << seed;
    EXPECT_EQ(ingest.late(), 0U) << "seed " << seed;
  }
}

TEST(Ingest, AStreamThatEndedEarlyDoesNotKeepTheNextEpochBack) {
  Ingest ingest(streams(), atlas::kSecond);
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i <= 500; ++i) {
      ingest.push(1, kBegin + i * kStep, imu(0));
      if (i == 0) ingest.push(2, kBegin, imu(0));  // alone no jump back, but 5 s late for the first round
    }
  }
  ingest.finish();
  EXPECT_EQ(eventsOfEpochs(ingest), (std::vector<std::size_t>{502, 502}));
  EXPECT_EQ(ingest.late(), 0U);
}

TEST(Ingest, AStreamThatStaysInTheEpochBeforeIsCountedAsLate) {
  Ingest ingest(streams(), atlas::kSecond);
  for (int i = 0; i <= 500; ++i) {
    ingest.push(1, kBegin + i * kStep, imu(0));
    if (i == 400) ingest.push(2, kBegin + i * kStep, imu(0));
  }
  for (int i = 0; i <= 200; ++i) ingest.push(1, kBegin + i * kStep, imu(0));
  ingest.push(2, kBegin + 450 * kStep, imu(0));  // 4.5 s, while the second round is at 2 s
  ingest.finish();
  EXPECT_EQ(eventsOfEpochs(ingest), (std::vector<std::size_t>{502, 201}));
  EXPECT_EQ(ingest.late(), 1U);
}

TEST(Ingest, ALoopKeepsItsStaticTransformsWhetherItRepeatsThemOrNot) {
  for (const bool repeated : {false, true}) {
    Ingest ingest(streams(), atlas::kSecond);
    const auto play = [&](bool with_transforms) {
      if (with_transforms) ingest.push(0, kBegin, atlas::StaticTransforms{});
      for (int i = 0; i <= 300; ++i) ingest.push(1, kBegin + i * kStep, imu(0));
    };
    play(true);
    play(repeated);
    ingest.finish();
    std::vector<int> transforms(1, 0);
    for (auto item = ingest.pop(); item->kind != Item::Kind::kEndOfRun; item = ingest.pop()) {
      if (item->kind == Item::Kind::kEndOfEpoch) transforms.push_back(0);
      if (item->event && item->event->stream == 0) ++transforms.back();
    }
    EXPECT_EQ(transforms, (std::vector<int>{1, 1})) << "repeated: " << repeated;
    EXPECT_EQ(ingest.late(), 0U);
  }
}

TEST(Ingest, StopWakesTheReader) {
  Ingest ingest(streams(), atlas::kSecond);
  ingest.stop();
  EXPECT_FALSE(ingest.pop().has_value());
}

TEST(TopicNames, KindsByEnding) {
  EXPECT_EQ(atlas_loader::kindOfTopicName("lidar_left/points"), atlas::StreamKind::kPoints);
  EXPECT_EQ(atlas_loader::kindOfTopicName("gnss/heading"), atlas::StreamKind::kGnssHeading);
  EXPECT_EQ(atlas_loader::kindOfTopicName("imu/gnss/fix"), atlas::StreamKind::kGnssFix);
  EXPECT_EQ(atlas_loader::kindOfTopicName("camera_ir/image_raw/compressed"),
            atlas::StreamKind::kCompressedImage);
  EXPECT_EQ(atlas_loader::kindOfTopicName("something/else"), std::nullopt);
}

}  // namespace
