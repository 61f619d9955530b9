// SPDX-License-Identifier: MIT
// Threads that share the rows of a grid. Each gets one run of rows, always the same one, and nothing is
// summed across rows, so that the number of threads cannot change a result.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace atlas {

class RowWorkers {
 public:
  using Work = std::function<void(int first_row, int end_row)>;

  /// `threads` counts the caller's own; at least 1.
  explicit RowWorkers(int threads);
  ~RowWorkers();
  RowWorkers(const RowWorkers&) = delete;
  RowWorkers& operator=(const RowWorkers&) = delete;

  [[nodiscard]] int threads() const { return static_cast<int>(threads_.size()) + 1; }
  /// Calls work(first, end) for runs that together cover [0, rows) and returns when all are done. What one of
  /// them throws is thrown here.
  void run(int rows, const Work& work);

 private:
  void serve(int part);
  void runPart(int part);

  std::mutex mutex_;
  std::condition_variable begin_, done_;
  const Work* work_ = nullptr;
  int rows_ = 0, running_ = 0;
  std::uint64_t round_ = 0;
  bool ending_ = false;
  std::exception_ptr failure_;
  std::vector<std::thread> threads_;
};

}  // namespace atlas
