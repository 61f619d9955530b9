// SPDX-License-Identifier: MIT
// What several stages derive from the same data, made by the first that asks for it.
#pragma once

#include <memory>
#include <mutex>

namespace atlas {

/// A member of the data, which must not change after the first get(). A copy of the data begins without it.
template <class T>
class MadeOnce {
 public:
  MadeOnce() = default;
  ~MadeOnce() = default;
  MadeOnce(const MadeOnce& /*of other data*/) {}
  MadeOnce& operator=(const MadeOnce& other) {
    if (this != &other) made_.reset();
    return *this;
  }

  /// What make() gave, now or earlier; from any thread.
  template <class Make>
  [[nodiscard]] std::shared_ptr<const T> get(Make&& make) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!made_) made_ = make();
    return made_;
  }

 private:
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const T> made_;
};

}  // namespace atlas
