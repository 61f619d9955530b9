// SPDX-License-Identifier: MIT
#include "record/scan_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace atlas::record {
namespace {

/// Lowest and highest elevation seen at one place.
struct Elevations {
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  std::size_t count = 0;
  void add(double elevation) {
    lowest = std::min(lowest, elevation);
    highest = std::max(highest, elevation);
    ++count;
  }
  [[nodiscard]] double middle() const { return 0.5 * (lowest + highest); }
};
using Places = std::array<Elevations, kLasersHdl32>;

constexpr std::size_t kColumnsLookedAt = 64;  // spread over the revolution
constexpr std::size_t kEnough = 4;            // returns of a laser
constexpr double kOneLaser_rad = 0.0116;      // half of the 1.333 deg between neighbouring lasers

/// Elevations by place; index(column, place) is where the point lies.
template <class Index>
Places look(const std::vector<LidarPoint>& points, Index index) {
  Places places;
  const std::size_t columns = points.size() / kLasersHdl32;
  const std::size_t step = std::max<std::size_t>(1, columns / kColumnsLookedAt);
  for (std::size_t column = 0; column < columns; column += step) {
    for (std::size_t place = 0; place < kLasersHdl32; ++place) {
      const LidarPoint& p = points[index(column, place)];
      const double flat = std::hypot(static_cast<double>(p.x), static_cast<double>(p.y));
      if (!std::isfinite(flat) || !std::isfinite(p.z) || flat < 0.1) continue;  // no return, or on the axis
      places[place].add(std::atan2(static_cast<double>(p.z), flat));
    }
  }
  return places;
}

/// Of the places with enough returns, how many are of one laser each: all (almost) or not.
bool areLasers(const Places& places) {
  std::size_t judged = 0, good = 0;
  for (const Elevations& place : places) {
    if (place.count < kEnough) continue;
    ++judged;
    good += place.highest - place.lowest < kOneLaser_rad ? 1 : 0;
  }
  return 10 * good >= 9 * judged;
}

bool isJudged(const Places& places) {
  return std::count_if(places.begin(), places.end(),
                       [](const Elevations& p) { return p.count >= kEnough; }) >= 4;
}

/// Ranks the places by elevation; those without returns keep their place when the others rise already, else
/// they come last.
std::array<std::uint16_t, kLasersHdl32> rings(const Places& places) {
  std::array<std::uint16_t, kLasersHdl32> order{}, ring{};
  std::iota(order.begin(), order.end(), std::uint16_t{0});
  bool rising = true;
  double before = -std::numeric_limits<double>::infinity();
  for (const Elevations& place : places) {
    if (place.count == 0) continue;
    rising = rising && place.middle() > before;
    before = place.middle();
  }
  if (!rising) {
    std::stable_sort(order.begin(), order.end(), [&](std::uint16_t a, std::uint16_t b) {
      const auto key = [&](std::uint16_t i) { return places[i].count > 0 ? places[i].middle() : 10.0; };
      return key(a) < key(b);
    });
  }
  for (std::uint16_t rank = 0; rank < kLasersHdl32; ++rank) ring[order[rank]] = rank;
  return ring;
}
}  // namespace

ScanLayout findScanLayout(const std::vector<LidarPoint>& points) {
  ScanLayout layout;
  if (points.size() % kLasersHdl32 != 0) return layout;
  const std::size_t columns = points.size() / kLasersHdl32;
  const Places by_column =
      look(points, [](std::size_t c, std::size_t place) { return c * kLasersHdl32 + place; });
  if (!isJudged(by_column) || areLasers(by_column)) {
    layout.order = ScanLayout::Order::kColumns;
    layout.ring = rings(by_column);
    return layout;
  }
  const Places by_row =
      look(points, [columns](std::size_t c, std::size_t place) { return place * columns + c; });
  if (isJudged(by_row) && areLasers(by_row)) {
    layout.order = ScanLayout::Order::kRows;
    layout.ring = rings(by_row);
  }
  return layout;
}

}  // namespace atlas::record
