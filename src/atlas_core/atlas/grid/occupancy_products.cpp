// SPDX-License-Identifier: MIT
#include "atlas/grid/occupancy_products.hpp"

#include <cmath>

namespace atlas {

OccupancyMapPtr occupancyMap(const OccupancyFrame& frame, double unknown_above) {
  auto map = std::make_shared<OccupancyMap>();
  map->stamp = frame.stamp;
  if (!frame.cells) return map;
  const GridGeometry& geometry = frame.geometry;
  const Eigen::Vector2d corner = geometry.corner();
  map->resolution_m = static_cast<float>(geometry.cell_m);
  map->origin = {corner.x(), corner.y(), frame.road_m};
  map->columns = static_cast<std::uint32_t>(geometry.columns);
  map->rows = static_cast<std::uint32_t>(geometry.rows);
  map->percent.resize(geometry.cells(), -1);
  for (std::size_t i = 0; i < map->percent.size(); ++i) {
    if (static_cast<double>(frame.cells->unknown[i]) > unknown_above) continue;
    map->percent[i] = static_cast<std::int8_t>(std::lround(100.0F * frame.cells->occupied[i]));
  }
  return map;
}

}  // namespace atlas
