// SPDX-License-Identifier: MIT
#include "atlas/base/graph_thread.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace atlas {
namespace {

TEST(GraphThread, DoesAllWorkInOrderInAnotherThread) {
  GraphThread thread(3);
  std::vector<int> done;
  std::thread::id worker;
  for (int i = 0; i < 1000; ++i) {
    const auto work = [&done, &worker, i] {
      done.push_back(i);
      worker = std::this_thread::get_id();
    };
    i % 10 == 9 ? thread.postStep(work) : thread.post(work);
  }
  thread.wait();
  std::vector<int> expected(1000);
  std::iota(expected.begin(), expected.end(), 0);
  EXPECT_EQ(done, expected);
  EXPECT_NE(worker, std::this_thread::get_id());
}

TEST(GraphThread, HoldsBackWhoeverIsTooFarAhead) {
  GraphThread thread(4);
  std::promise<void> begin;
  std::atomic<int> posted{0};
  thread.post([ready = begin.get_future().share()] { ready.wait(); });
  const auto poster = std::async(std::launch::async, [&] {
    for (int i = 0; i < 20; ++i) {
      thread.postStep([] {});
      ++posted;
    }
  });
  EXPECT_EQ(poster.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
  EXPECT_EQ(posted, 4);
  begin.set_value();
  poster.wait();
  thread.wait();
  EXPECT_EQ(posted, 20);
}

TEST(GraphThread, GivesAnErrorBackAndDropsWhatFollows) {
  GraphThread thread(1000);
  std::atomic<int> done{0};
  thread.postStep([&done] { ++done; });
  thread.postStep([] { throw std::runtime_error("disk full"); });
  EXPECT_THROW(
      for (int i = 0; i < 1000; ++i) {
        thread.wait();
        thread.postStep([&done] { ++done; });
      },
      std::runtime_error);
  EXPECT_EQ(done, 1);
  EXPECT_THROW(thread.post([] {}), std::runtime_error);
  EXPECT_THROW(thread.wait(), std::runtime_error) << "every time";
}

TEST(GraphThread, ItsEndDropsWhatIsNotBegun) {
  const auto held = std::make_shared<int>(0);
  std::promise<void> begun, end;
  std::future<void> destroyed;
  {
    auto thread = std::make_unique<GraphThread>(8);
    thread->post([&begun, ended = end.get_future().share()] {
      begun.set_value();
      ended.wait();
    });
    for (int i = 0; i < 3; ++i) thread->postStep([held] { ++*held; });
    begun.get_future().wait();
    destroyed = std::async(std::launch::async, [t = std::move(thread)]() mutable { t.reset(); });
  }
  EXPECT_EQ(destroyed.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout)
      << "it waits for the work that it is at";
  end.set_value();
  destroyed.wait();
  EXPECT_EQ(*held, 0);
  EXPECT_EQ(held.use_count(), 1);
}

}  // namespace
}  // namespace atlas
