// SPDX-License-Identifier: MIT
#include "atlas/output/grid_pgm.hpp"

#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace atlas {
namespace {
constexpr std::uint8_t kUnknownGrey = 205;
// map_saver's: grey 205 lies between them, and so does what is neither clearly occupied nor clearly free.
constexpr const char* kThresholds = "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}  // namespace

std::vector<std::uint8_t> gridPgm(const OccupancyMap& map) {
  if (map.percent.empty()) throw std::invalid_argument("PGM: the map must have cells, got none");
  cv::Mat image(static_cast<int>(map.rows), static_cast<int>(map.columns), CV_8UC1);
  for (std::uint32_t row = 0; row < map.rows; ++row) {
    const std::int8_t* percent = map.percent.data() + static_cast<std::size_t>(row) * map.columns;
    std::uint8_t* grey = image.ptr<std::uint8_t>(static_cast<int>(map.rows - 1 - row));
    for (std::uint32_t column = 0; column < map.columns; ++column) {
      grey[column] = percent[column] < 0
                         ? kUnknownGrey
                         : static_cast<std::uint8_t>(std::lround(255.0 - 2.55 * percent[column]));
    }
  }
  std::vector<std::uint8_t> bytes;
  cv::imencode(".pgm", image, bytes);
  return bytes;
}

std::string gridYaml(const OccupancyMap& map, const std::string& image) {
  char numbers[128];
  std::snprintf(numbers, sizeof numbers, "resolution: %.6g\norigin: [%.6f, %.6f, 0.0]\n",
                static_cast<double>(map.resolution_m), map.origin.x(), map.origin.y());
  return "image: " + image + "\n" + numbers + kThresholds;
}

}  // namespace atlas
