// SPDX-License-Identifier: MIT
#include "atlas/base/event_merge.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <stdexcept>
#include <string>

namespace atlas {
namespace {

/// Merge whose events write "<stream name><stamp>" into a log.
struct Logged {
  EventMerge merge;
  std::vector<std::string> log;
  explicit Logged(std::vector<std::string> names) : merge(std::move(names)) {}
  void push(std::size_t stream, Stamp stamp, const std::string& suffix = {}) {
    merge.push(stream, stamp, [this, stream, stamp, suffix] {
      log.push_back(merge.name(stream) + std::to_string(stamp) + suffix);
    });
  }
};
using Log = std::vector<std::string>;

TEST(EventMerge, WaitsUntilNothingEarlierCanCome) {
  Logged m({"a", "b"});
  m.push(0, 10);
  EXPECT_EQ(m.log, Log{});
  EXPECT_EQ(m.merge.blockingStream(), 1U);
  m.push(1, 20);
  EXPECT_EQ(m.log, Log{"a10"});
  m.push(0, 30);
  EXPECT_EQ(m.log, (Log{"a10", "b20"}));
  EXPECT_EQ(m.merge.queued(), 1U);
}

TEST(EventMerge, EqualStampsGoByStreamIndexThenByArrival) {
  Logged m({"a", "b", "c"});
  m.push(2, 5);
  m.push(1, 5, "first");
  m.push(1, 5, "second");
  m.push(0, 5);
  for (std::size_t i = 0; i < 3; ++i) m.merge.finish(i);
  EXPECT_EQ(m.log, (Log{"a5", "b5first", "b5second", "c5"}));
}

TEST(EventMerge, WatermarkReleasesTiesOnlyToTheRightSide) {
  Logged m({"a", "b"});
  m.push(1, 10);
  m.merge.advance(0, 9);  // stream a could still deliver 10, which goes first
  EXPECT_EQ(m.log, Log{});
  m.merge.advance(0, 10);
  EXPECT_EQ(m.log, Log{"b10"});

  Logged n({"a", "b"});
  n.push(0, 10);
  n.merge.advance(1, 8);  // stream b could still deliver 9
  EXPECT_EQ(n.log, Log{});
  n.merge.advance(1, 9);  // a 10 of b goes after a's anyway
  EXPECT_EQ(n.log, Log{"a10"});
}

TEST(EventMerge, WatermarkNeverGoesBack) {
  Logged m({"a", "b"});
  m.merge.advance(0, 10);
  m.merge.advance(0, 5);
  m.push(0, 7);
  EXPECT_EQ(m.merge.late(0), 1U);
}

TEST(EventMerge, LateEventsAreCountedAndNeverRun) {
  Logged m({"a", "b"});
  m.push(0, 10);
  m.push(1, 10);
  m.push(0, 20);  // releases b10
  EXPECT_EQ(m.log, (Log{"a10", "b10"}));
  m.push(0, 15);  // behind its own stream
  m.push(1, 9);   // behind what was dispatched
  m.merge.advance(1, 12);
  m.push(1, 12);  // at its own watermark
  m.merge.finish(0);
  m.merge.finish(1);
  m.push(1, 99);  // after its own end
  EXPECT_EQ(m.log, (Log{"a10", "b10", "a20"}));
  EXPECT_EQ(m.merge.late(0), 1U);
  EXPECT_EQ(m.merge.late(1), 3U);
  EXPECT_EQ(m.merge.received(0), 3U);
  EXPECT_EQ(m.merge.received(1), 4U);
}

TEST(EventMerge, FinishedStreamsDoNotBlock) {
  Logged m({"a", "b", "c"});
  m.merge.finish(1);
  m.push(0, 1);
  EXPECT_EQ(m.merge.blockingStream(), 2U);
  m.merge.finish(2);
  EXPECT_EQ(m.log, Log{"a1"});
  EXPECT_EQ(m.merge.blockingStream(), m.merge.streams()) << "nothing waits";
  EXPECT_FALSE(m.merge.finished());
  m.merge.finish(0);
  EXPECT_TRUE(m.merge.finished());
}

TEST(EventMerge, WatermarkIsWhatHasBeenDispatched) {
  Logged m({"a", "b"});
  EXPECT_EQ(m.merge.watermark(), kBeginOfTime);
  m.merge.advance(0, 100);
  m.merge.advance(1, 40);
  EXPECT_EQ(m.merge.watermark(), 40);
  m.push(0, 110);
  m.merge.advance(1, 200);
  EXPECT_EQ(m.log, Log{"a110"});
  EXPECT_EQ(m.merge.watermark(), 109) << "a second event of stamp 110 may follow";
  m.push(1, 210);
  EXPECT_EQ(m.merge.watermark(), 109) << "still waiting for a";
  m.merge.finish(0);
  EXPECT_EQ(m.merge.watermark(), 209);
  m.merge.finish(1);
  EXPECT_EQ(m.merge.watermark(), kEndOfTime);
}

TEST(EventMerge, EventsAloneMoveTheWatermark) {
  Logged m({"a"});
  m.push(0, 10);
  EXPECT_EQ(m.log, Log{"a10"});
  EXPECT_EQ(m.merge.watermark(), 9);  // an earlier one would be late
}

TEST(EventMerge, TheRunningEventIsNotDoneYet) {
  EventMerge two({"a", "b"});
  Stamp seen = 0;
  two.push(0, 10, [&] { seen = two.watermark(); });
  two.finish(0);
  two.finish(1);
  EXPECT_EQ(seen, 9);
  EXPECT_TRUE(two.finished());
}

TEST(EventMerge, ActionMayPushIntoItsOwnMerge) {
  Logged m({"a", "b"});
  m.merge.push(0, 10, [&] {
    m.log.push_back("a10");
    m.push(1, 10);  // due at once, runs after this action
    m.push(1, 30);
    m.log.push_back("end of a10");
  });
  m.merge.advance(1, 9);
  m.merge.finish(0);
  EXPECT_EQ(m.log, (Log{"a10", "end of a10", "b10", "b30"}));
}

TEST(EventMerge, AThrowingActionDoesNotStopTheNext) {
  Logged m({"a"});
  EXPECT_THROW(m.merge.push(0, 1, [] { throw std::runtime_error("broken"); }), std::runtime_error);
  m.push(0, 2);
  EXPECT_EQ(m.log, Log{"a2"});
}

TEST(EventMerge, NeedsAStream) { EXPECT_THROW(EventMerge({}), std::logic_error); }

TEST(EventMerge, ArrivalOrderHasNoInfluence) {
  // Four streams with many ties; every interleaving that keeps the order inside each stream, with watermarks
  // thrown in, gives the one order (stamp, stream, sequence).
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    std::vector<std::vector<Stamp>> stamps(4);
    std::vector<std::tuple<Stamp, std::size_t, std::size_t>> expected;
    for (std::size_t s = 0; s < stamps.size(); ++s) {
      Stamp stamp = 0;
      for (std::size_t i = 0; i < random() % 30; ++i)
        stamps[s].push_back(stamp += static_cast<Stamp>(random() % 3));
      for (std::size_t i = 0; i < stamps[s].size(); ++i) expected.emplace_back(stamps[s][i], s, i);
    }
    std::sort(expected.begin(), expected.end());

    EventMerge merge({"a", "b", "c", "d"});
    std::vector<std::tuple<Stamp, std::size_t, std::size_t>> dispatched;
    std::vector<std::size_t> next(4, 0);
    std::vector<bool> ended(4, false);
    while (std::find(ended.begin(), ended.end(), false) != ended.end()) {
      const std::size_t s = random() % 4;
      if (ended[s]) continue;
      if (next[s] == stamps[s].size()) {
        merge.finish(s);
        ended[s] = true;
        continue;
      }
      const std::size_t i = next[s];
      const Stamp stamp = stamps[s][i];
      if (random() % 4 == 0) merge.advance(s, stamp - 1);  // a promise that holds
      merge.push(s, stamp, [&dispatched, stamp, s, i] { dispatched.emplace_back(stamp, s, i); });
      ++next[s];
      ASSERT_TRUE(std::is_sorted(dispatched.begin(), dispatched.end()));
    }
    ASSERT_EQ(dispatched, expected) << "round " << round;
    for (std::size_t s = 0; s < 4; ++s) ASSERT_EQ(merge.late(s), 0U);
  }
}

}  // namespace
}  // namespace atlas
