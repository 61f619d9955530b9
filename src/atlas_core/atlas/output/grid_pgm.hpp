// SPDX-License-Identifier: MIT
// Occupancy grids in the files of map_server: a grey image (PGM) and its description (YAML).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "atlas/grid/occupancy_products.hpp"

namespace atlas {

/// Binary PGM, first row = largest y: 255 - 2.55 * percent, so black is occupied and white is free, and 205
/// for unknown, which map_server reads as unknown. Throws std::invalid_argument for a map without cells.
std::vector<std::uint8_t> gridPgm(const OccupancyMap& map);
/// For the PGM of the name `image` beside it.
std::string gridYaml(const OccupancyMap& map, const std::string& image);

}  // namespace atlas
