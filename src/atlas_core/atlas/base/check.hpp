// SPDX-License-Identifier: MIT
// A broken invariant is our own bug: it throws in every build type and fails the run, it never aborts the
// manager.
#pragma once

#include <stdexcept>
#include <string>

#define ATLAS_CHECK(condition, message)                                                                \
  do {                                                                                                 \
    if (!(condition)) {                                                                                \
      throw std::logic_error(std::string(__FILE__ ":") + std::to_string(__LINE__) + ": " + (message)); \
    }                                                                                                  \
  } while (false)
