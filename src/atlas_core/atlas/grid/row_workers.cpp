// SPDX-License-Identifier: MIT
#include "atlas/grid/row_workers.hpp"

#include <stdexcept>
#include <string>

namespace atlas {

RowWorkers::RowWorkers(int threads) {
  if (threads < 1 || threads > 64)
    throw std::invalid_argument("grid: threads must lie in [1, 64], got " + std::to_string(threads));
  for (int part = 1; part < threads; ++part) threads_.emplace_back([this, part] { serve(part); });
}

RowWorkers::~RowWorkers() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  begin_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void RowWorkers::run(int rows, const Work& work) {
  if (threads_.empty()) return work(0, rows);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    work_ = &work;
    rows_ = rows;
    running_ = static_cast<int>(threads_.size());
    failure_ = nullptr;
    ++round_;
  }
  begin_.notify_all();
  runPart(0);
  std::unique_lock<std::mutex> lock(mutex_);
  done_.wait(lock, [this] { return running_ == 0; });
  work_ = nullptr;
  if (failure_) std::rethrow_exception(failure_);
}

void RowWorkers::runPart(int part) {
  const std::int64_t parts = threads();
  const int first = static_cast<int>(rows_ * static_cast<std::int64_t>(part) / parts);
  const int end = static_cast<int>(rows_ * static_cast<std::int64_t>(part + 1) / parts);
  try {
    if (first < end) (*work_)(first, end);
  } catch (...) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!failure_) failure_ = std::current_exception();
  }
}

void RowWorkers::serve(int part) {
  std::uint64_t served = 0;
  for (;;) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      begin_.wait(lock, [&] { return ending_ || round_ != served; });
      if (ending_) return;
      served = round_;
    }
    runPart(part);
    const std::lock_guard<std::mutex> lock(mutex_);
    if (--running_ == 0) done_.notify_one();
  }
}

}  // namespace atlas
