// SPDX-License-Identifier: MIT
#include "atlas/base/graph_thread.hpp"

#include <utility>

namespace atlas {

GraphThread::GraphThread(std::size_t most_steps) : most_steps_(most_steps), thread_([this] { run(); }) {}

GraphThread::~GraphThread() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  posted_.notify_one();
  thread_.join();
}

void GraphThread::rethrow() const {
  if (error_) std::rethrow_exception(error_);
}

void GraphThread::post(Work work) {
  const std::lock_guard<std::mutex> lock(mutex_);
  rethrow();
  waiting_.push_back({std::move(work), false});
}

void GraphThread::postStep(Work work) {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    done_.wait(lock, [this] { return steps_ < most_steps_ || error_; });
    rethrow();
    waiting_.push_back({std::move(work), true});
    ++steps_;
  }
  posted_.notify_one();
}

void GraphThread::wait() {
  std::unique_lock<std::mutex> lock(mutex_);
  done_.wait(lock, [this] { return steps_ == 0 || error_; });
  rethrow();
}

void GraphThread::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    posted_.wait(lock, [this] { return stop_ || (steps_ > 0 && !error_); });
    if (stop_) return;
    Item item = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    std::exception_ptr error;
    try {
      item.work();
    } catch (...) {
      error = std::current_exception();
    }
    item.work = nullptr;  // lets go of what it holds without the lock
    lock.lock();
    if (error) {
      error_ = error;
      waiting_.clear();
    }
    if (item.step) --steps_;
    if (item.step || error) done_.notify_one();
  }
}

}  // namespace atlas
