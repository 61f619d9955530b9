// SPDX-License-Identifier: MIT
// Which part of a dataset a frame belongs to. Neighbouring frames look alike, so whole blocks of time go to
// one part: never one frame to train and the next to val, but at the edge of a block.
#pragma once

#include <array>
#include <cstddef>

#include "atlas/base/time.hpp"

namespace atlas {

enum class Split : std::size_t { kTrain, kVal, kTest };
constexpr std::array<const char*, 3> kSplitNames = {"train", "val", "test"};

/// Of ten blocks in a row two are val and one is test, whatever the recording began with: a piece of it that
/// is played alone is split in the same way.
constexpr Split splitOf(Stamp stamp, Duration block) {
  const std::int64_t turn = (stamp / block) % 10;
  if (turn == 7) return Split::kTest;
  return turn % 5 == 0 ? Split::kVal : Split::kTrain;
}
constexpr const char* nameOf(Split split) { return kSplitNames[static_cast<std::size_t>(split)]; }

}  // namespace atlas
