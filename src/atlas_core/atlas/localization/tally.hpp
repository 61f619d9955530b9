// SPDX-License-Identifier: MIT
// A count that ends in Counters under its name, without building the name each time.
#pragma once

#include "atlas/base/counters.hpp"

namespace atlas {

class Tally {
 public:
  constexpr explicit Tally(const char* key) : key_(key) {}
  /// Appears in `counters` with the first count; always the same object.
  void add(Counters& counters) {
    if (cell_ == nullptr) cell_ = &counters.cell(key_);
    ++*cell_;
  }

 private:
  const char* key_;
  std::uint64_t* cell_ = nullptr;
};

}  // namespace atlas
