// SPDX-License-Identifier: MIT
// One line on stderr that follows the stamps of the data; silent when stderr is not a terminal, but for every tenth.
#pragma once

#include <string>
#include <utility>

#include "atlas/base/time.hpp"

namespace atlas_loader {

class ProgressBar {
 public:
  ProgressBar(std::string what, std::pair<atlas::Stamp, atlas::Stamp> span);
  ~ProgressBar();
  void show(atlas::Stamp stamp);

 private:
  std::string what_;
  std::pair<atlas::Stamp, atlas::Stamp> span_;
  bool terminal_;
  int shown_ = -1;  ///< percent
};

}  // namespace atlas_loader
