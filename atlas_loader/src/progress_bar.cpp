// SPDX-License-Identifier: MIT
#include "progress_bar.hpp"

#include <unistd.h>

#include <algorithm>
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
  const int percent = static_cast<int>(100.0 * std::min(share, 1.0));
  constexpr int kQuietStep = 20;  // percent, for log files
  if (percent <= shown_ || (!terminal_ && percent < shown_ + kQuietStep)) return;
  shown_ = percent;
  std::fprintf(stderr, terminal_ ? "\r%s %3d %%" : "%s %3d %%\n", what_.c_str(), percent);
}

std::pair<atlas::Stamp, atlas::Stamp> requestedSpan(std::pair<atlas::Stamp, atlas::Stamp> whole,
                                                    const InputOptions& options) {
  whole.first = std::min(whole.second, whole.first + atlas::fromSeconds(options.start_s));
  if (options.duration_s >= 0)
    whole.second = std::min(whole.second, whole.first + atlas::fromSeconds(options.duration_s));
  return whole;
}

}  // namespace atlas_loader
