// SPDX-License-Identifier: MIT
// One line on stderr that follows the stamps of the data; silent when stderr is not a terminal, but for every
// fifth.
#pragma once

#include <string>
#include <utility>

#include "atlas/base/time.hpp"
#include "open_input.hpp"

namespace atlas_loader {

class ProgressBar {
 public:
  ProgressBar(std::string what, std::pair<atlas::Stamp, atlas::Stamp> span);
  ~ProgressBar();
  void show(atlas::Stamp stamp);
  /// 100 %, when everything is done before the last stamp.
  void finish() { show(span_.second); }

 private:
  std::string what_;
  std::pair<atlas::Stamp, atlas::Stamp> span_;
  bool terminal_;
  int shown_ = -1;  ///< percent
};

/// The part of a record's span that start and duration ask for.
std::pair<atlas::Stamp, atlas::Stamp> requestedSpan(std::pair<atlas::Stamp, atlas::Stamp> whole,
                                                    const InputOptions& options);

}  // namespace atlas_loader
