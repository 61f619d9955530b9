// SPDX-License-Identifier: MIT
// One occupancy grid of the run from above, with the objects of the grid and where the vehicle was. North is
// up.
#pragma once

#include <filesystem>
#include <optional>

#include "report/picture_choice.hpp"

namespace atlas::report {

/// The grid during which most objects moved, else the one in the middle of the run; none when the run has no
/// grids. Throws std::runtime_error naming a file that is not what its name says.
std::optional<Picture> chooseGrid(const std::filesystem::path& out);

}  // namespace atlas::report
