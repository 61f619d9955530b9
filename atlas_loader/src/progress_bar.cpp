// SPDX-License-Identifier: MIT
#include "progress_bar.hpp"

#include <unistd.h>

#include <cstdio>

namespace atlas_loader {

ProgressBar::ProgressBar(std::string what, std::pair<atlas::Stamp, atlas::Stamp> span)
    : what_(std::move(what)), span_(span), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (terminal_ && shown_ >= 0) std::fputc('\n', stderr);
}

void ProgressBar::show(atlas::Stamp stamp) {
  if (span_.second <= span_.first) return;
  const double share = atlas::toSeconds(stamp - span_.first) / atlas::toSeconds(span_.second - span_.first);
  const int percent = static_cast<int>(100.0 * share);
  constexpr int kQuietStep = 20;  // percent, for log files
  if (percent <= shown_ || (!terminal_ && percent < shown_ + kQuietStep)) return;
  shown_ = percent;
  std::fprintf(stderr, terminal_ ? "\r%s %3d %%" : "%s %3d %%\n", what_.c_str(), percent);
}

}  // namespace atlas_loader
