// SPDX-License-Identifier: MIT
// A thread of a LocalGraph: does what the thread before it hands over, in that order.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace atlas {

class GraphThread {
 public:
  using Work = std::function<void()>;

  /// At most `most_steps` steps wait, with all that was posted before each of them.
  explicit GraphThread(std::size_t most_steps);
  /// Finishes the work it is at and drops the rest.
  ~GraphThread();
  GraphThread(const GraphThread&) = delete;
  GraphThread& operator=(const GraphThread&) = delete;

  // After a work has thrown, all that follows is dropped and each of these throws the same again.
  /// Is done after what was posted before, but not before the next step is posted: one wake-up for all of it.
  void post(Work work);
  /// Blocks while too many steps wait.
  void postStep(Work work);
  /// Blocks until the last step is done.
  void wait();

 private:
  struct Item {
    Work work;
    bool step;
  };
  void run();
  void rethrow() const;

  const std::size_t most_steps_;
  std::mutex mutex_;  ///< guards what follows
  std::condition_variable posted_, done_;
  std::deque<Item> waiting_;
  std::size_t steps_ = 0;  ///< not done yet
  bool stop_ = false;
  std::exception_ptr error_;
  std::thread thread_;  ///< last: begins when the others are there
};

}  // namespace atlas
