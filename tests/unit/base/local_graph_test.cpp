// SPDX-License-Identifier: MIT
#include "atlas/base/local_graph.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <random>
#include <stdexcept>

namespace atlas {
namespace {

struct Number {
  Stamp stamp = 0;
  int value = 0;
};

/// Emits the sum of all it has taken, once for each number taken, `delay` later than it could.
class SumStage : public Stage {
 public:
  SumStage(std::size_t inputs, Duration delay)
      : Stage("sum", std::vector<std::string>(inputs, "number")), delay_(delay) {}
  void push(std::size_t input, const Number& number) {
    enqueue(input, number.stamp, [this, number] {
      sum_ = (3 * sum_ + number.value) % 1'000'003;  // the order counts
      owed_.push_back({number.stamp, sum_});
    });
  }
  std::function<void(const Number&)> on_sum;
  int ends = 0;

 protected:
  [[nodiscard]] Stamp heldBackFrom() const override {
    return owed_.empty() ? kEndOfTime : owed_.front().stamp;
  }
  void onProgress() override {
    while (!owed_.empty() && owed_.front().stamp + delay_ <= merge().watermark()) emitFirst();
  }
  void onEnd() override {
    ++ends;
    while (!owed_.empty()) emitFirst();
  }

 private:
  void emitFirst() {
    const Number number = owed_.front();
    owed_.pop_front();
    if (on_sum) on_sum(number);
  }
  Duration delay_;
  int sum_ = 0;
  std::deque<Number> owed_;
};

LocalGraph::Bind sumOf(const std::vector<std::string>& topics, const std::string& result, Duration delay = 0,
                       std::size_t more_inputs = 0) {
  return [=](LocalGraph::Bus& bus) -> StageFactory {
    for (std::size_t i = 0; i < topics.size(); ++i) {
      bus.input<SumStage, Number>(i, topics[i], [i](SumStage& s, const Number& n) { s.push(i, n); });
    }
    const auto emit = bus.output<Number>(result);
    const std::size_t inputs = topics.size() + more_inputs;
    return [=] {
      auto stage = std::make_unique<SumStage>(inputs, delay);
      stage->on_sum = emit;
      return stage;
    };
  };
}

/// Remembers what a topic carried.
class LogStage : public Stage {
 public:
  explicit LogStage(std::vector<Number>* log) : Stage("log", {"number"}), log_(log) {}
  void push(const Number& number) {
    enqueue(0, number.stamp, [this, number] { log_->push_back(number); });
  }

 private:
  std::vector<Number>* log_;
};
LocalGraph::Bind logOf(const std::string& topic, std::vector<Number>* log) {
  return [=](LocalGraph::Bus& bus) -> StageFactory {
    bus.input<LogStage, Number>(0, topic, [](LogStage& s, const Number& n) { s.push(n); });
    return [log] { return std::make_unique<LogStage>(log); };
  };
}

std::vector<int> values(const std::vector<Number>& log) {
  std::vector<int> result;
  for (const Number& n : log) result.push_back(n.value);
  return result;
}

TEST(LocalGraph, CarriesValuesAndProgressFromStageToStage) {
  LocalGraph graph;
  std::vector<Number> log;
  graph.add(sumOf({"a", "b"}, "first"));
  graph.add(sumOf({"first"}, "second"));
  graph.add(logOf("second", &log));
  graph.publish("a", Number{10, 1});
  graph.publish("b", Number{20, 2});
  EXPECT_TRUE(log.empty()) << "b could still send a number before 20";
  graph.advance(15);
  EXPECT_EQ(values(log), std::vector<int>{1}) << "through both stages";
  graph.advance(20);
  EXPECT_EQ(values(log), (std::vector<int>{1, 8})) << "3 * 1 + (3 * 1 + 2)";
  graph.finish();
  for (const Stage* stage : graph.stages()) EXPECT_EQ(stage->progress(), kEndOfTime) << stage->name();
}

TEST(LocalGraph, AStageThatIsBehindHoldsTheNextBack) {
  LocalGraph graph;
  std::vector<Number> log;
  graph.add(sumOf({"a"}, "late", 100));
  graph.add(sumOf({"late", "a"}, "both"));
  graph.add(logOf("both", &log));
  graph.publish("a", Number{10, 1});
  graph.advance(50);
  EXPECT_TRUE(log.empty()) << "the first stage owes the number of stamp 10, which goes before a's own";
  graph.advance(110);
  EXPECT_EQ(log.size(), 2U);
  EXPECT_LT(graph.stages()[0]->progress(), kEndOfTime);
}

TEST(LocalGraph, EndFlushesEveryStageOnceInTheirOrder) {
  LocalGraph graph;
  std::vector<Number> log;
  graph.add(sumOf({"a"}, "first", 1000));
  graph.add(sumOf({"first"}, "second", 1000));
  graph.add(logOf("second", &log));
  for (int i = 1; i <= 3; ++i) graph.publish("a", Number{i, i});
  graph.finish();
  EXPECT_EQ(log.size(), 3U);
  graph.finish();
  EXPECT_EQ(log.size(), 3U);
  EXPECT_EQ(static_cast<const SumStage*>(graph.stages()[0])->ends, 1);
}

TEST(LocalGraph, InputsWithoutTopicHaveEnded) {
  LocalGraph graph;
  std::vector<Number> log;
  graph.add(sumOf({"a"}, "first", 0, 2));
  graph.add(logOf("first", &log));
  graph.publish("a", Number{10, 1});
  graph.advance(10);
  EXPECT_EQ(log.size(), 1U) << "the two other inputs hold nothing up";
}

TEST(LocalGraph, KnowsWhatItWantsAndIgnoresTheRest) {
  LocalGraph graph;
  graph.add(sumOf({"a"}, "first"));
  EXPECT_TRUE(graph.wants("a"));
  EXPECT_FALSE(graph.wants("nobody_listens"));
  EXPECT_FALSE(graph.wants("first")) << "an output without a listener";
  EXPECT_NO_THROW(graph.publish("nobody_listens", Number{1, 1}));
}

TEST(LocalGraph, RefusesWiringThatCannotBeRight) {
  LocalGraph graph;
  graph.add(sumOf({"a"}, "first"));
  EXPECT_THROW(graph.publish("a", 3.5), std::logic_error) << "another type";
  EXPECT_THROW(graph.add(sumOf({"b"}, "first")), std::logic_error) << "two producers of one topic";
  EXPECT_THROW(graph.add(sumOf({"first"}, "a")), std::logic_error)
      << "a is read by a stage that was added before its producer";
}

// Sources may be published in any order between two watermarks.
TEST(LocalGraph, ArrivalOrderHasNoInfluence) {
  std::mt19937 random(3);
  std::vector<int> expected;
  for (int run = 0; run < 30; ++run) {
    LocalGraph graph;
    std::vector<Number> log;
    graph.add(sumOf({"a", "b", "c"}, "first", 7));
    graph.add(sumOf({"first", "b"}, "second"));
    graph.add(logOf("second", &log));
    for (Stamp begin = 0; begin < 100; begin += 20) {
      std::vector<std::size_t> turns;
      for (std::size_t source = 0; source < 3; ++source) turns.insert(turns.end(), 5, source);
      if (run > 0) std::shuffle(turns.begin(), turns.end(), random);
      std::vector<int> sent(3, 0);
      for (const std::size_t source : turns) {
        const Stamp stamp = begin + 1 + 4 * sent[source];  // ties between the sources
        const int value = static_cast<int>(source) + static_cast<int>(stamp % 3);
        graph.publish(std::string(1, static_cast<char>('a' + source)), Number{stamp, value % 2});
        ++sent[source];
        if (run % 2 == 1 && source == 0) graph.advance(begin);
      }
      graph.advance(begin + 19);
    }
    graph.finish();
    if (run == 0) expected = values(log);
    EXPECT_EQ(values(log), expected) << "run " << run;
    EXPECT_EQ(log.size(), 100U);
  }
}

/// Remembers every call: what was pushed and how far the inputs had come.
class TraceStage : public Stage {
 public:
  explicit TraceStage(std::size_t inputs) : Stage("trace", std::vector<std::string>(inputs, "number")) {}
  void push(std::size_t input, const Number& number) {
    calls.push_back({static_cast<Stamp>(input), number.stamp, number.value});
    enqueue(input, number.stamp, [this, number] {
      if (on_number) on_number({number.stamp, number.value + 1});
    });
  }
  std::function<void(const Number&)> on_number;
  std::vector<std::array<Stamp, 3>> calls;

 protected:
  void onProgress() override { calls.push_back({-1, merge().watermark(), progress()}); }
};
LocalGraph::Bind traceOf(const std::vector<std::string>& topics, const std::string& result) {
  return [=](LocalGraph::Bus& bus) -> StageFactory {
    for (std::size_t i = 0; i < topics.size(); ++i)
      bus.input<TraceStage, Number>(i, topics[i], [i](TraceStage& s, const Number& n) { s.push(i, n); });
    const auto emit = bus.output<Number>(result);
    return [=] {
      auto stage = std::make_unique<TraceStage>(topics.size());
      stage->on_number = emit;
      return stage;
    };
  };
}

TEST(LocalGraph, EveryStageSeesTheSameCallsWithSeveralThreads) {
  const auto run = [](LocalGraph::Threads threads) {
    LocalGraph graph(threads);
    graph.add(traceOf({"a", "b"}, "callers_own"));
    graph.beginThread();
    graph.add(traceOf({"callers_own", "b"}, "first"));
    graph.add(traceOf({"first", "a"}, "second"));
    graph.beginThread();
    graph.add(traceOf({"a", "first", "second"}, "third"));
    graph.beginThread();
    graph.add(traceOf({"b", "callers_own", "third", "first"}, "fourth"));
    graph.add(traceOf({"fourth", "second"}, "fifth"));
    std::mt19937 random(11);
    for (int i = 1; i <= 3000; ++i) {
      graph.publish(random() % 2 == 0 ? "a" : "b", Number{i, static_cast<int>(random() % 100)});
      if (random() % 3 == 0) graph.advance(i);
    }
    graph.finish();
    std::vector<std::vector<std::array<Stamp, 3>>> calls;
    for (const Stage* stage : graph.stages()) calls.push_back(static_cast<const TraceStage*>(stage)->calls);
    return calls;
  };
  const auto expected = run(LocalGraph::Threads::kOne);
  ASSERT_EQ(expected.size(), 6U);
  EXPECT_GT(expected.back().size(), 3000U);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(run(LocalGraph::Threads::kSeveral), expected);
}

TEST(LocalGraph, WhatAStageOfAnotherThreadThrowsReachesTheCaller) {
  const auto graph = std::make_unique<LocalGraph>(LocalGraph::Threads::kSeveral);
  graph->add(traceOf({"a"}, "first"));
  graph->beginThread();
  graph->add(traceOf({"first"}, "second"));
  graph->beginThread();
  graph->add([](LocalGraph::Bus& bus) -> StageFactory {
    bus.input<TraceStage, Number>(0, "second", [](TraceStage& s, const Number& n) {
      if (n.value == 7 + 2) throw std::runtime_error("disk full at " + std::to_string(n.stamp));
      s.push(0, n);
    });
    return [] { return std::make_unique<TraceStage>(1); };
  });
  try {
    for (int i = 1; i <= 100'000; ++i) {
      graph->publish("a", Number{i, i});
      graph->advance(i);
    }
    graph->finish();
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "disk full at 7");
  }
}

}  // namespace
}  // namespace atlas
