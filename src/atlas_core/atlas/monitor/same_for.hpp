// SPDX-License-Identifier: MIT
// For how long a value has not changed at all.
#pragma once

#include <optional>
#include <utility>

#include "atlas/base/time.hpp"

namespace atlas {

template <class T>
class SameFor {
 public:
  /// Seconds since the value was first seen in a row.
  double add(Stamp stamp, T value) {
    if (!value_ || !(*value_ == value)) {
      value_ = std::move(value);
      since_ = stamp;
    }
    return toSeconds(stamp - since_);
  }

 private:
  std::optional<T> value_;
  Stamp since_ = 0;
};

}  // namespace atlas
