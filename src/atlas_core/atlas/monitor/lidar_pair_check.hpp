// SPDX-License-Identifier: MIT
// Two lidars on one vehicle see the same surfaces: the nearest one in each direction must be as far by one as
// by the other. Motion between the scans moves front and rear in opposite directions and drops out of the
// median.
#pragma once

#include <array>
#include <optional>

#include "atlas/base/geometry.hpp"
#include "atlas/monitor/findings.hpp"

namespace atlas {

/// Horizontal range of the nearest surface in each direction around base_link, m.
class RangeProfile {
 public:
  static constexpr std::size_t kBins = 120;
  RangeProfile() { ranges_m_.fill(0.0F); }
  /// Points between 1 m below and 1 m above base_link: walls and vehicles.
  void add(const Eigen::Vector3f& p_imu);
  /// Median of (this - other) over the directions that both see between 2 and 30 m; nullopt with too few.
  [[nodiscard]] std::optional<double> offset(const RangeProfile& other) const;

 private:
  std::array<float, kBins> ranges_m_;  ///< 0: nothing seen
};

class LidarPairCheck {
 public:
  /// A scan of lidar 0 or 1. The offset is one of both: nobody knows which is wrong.
  void add(std::size_t lidar, Stamp stamp, const RangeProfile& profile, Findings& first, Findings& second);

 private:
  struct Seen {
    Stamp stamp;
    RangeProfile profile;
  };
  std::array<std::optional<Seen>, 2> newest_;
  double sum_m_ = 0.0;
  int count_ = 0;
  Stamp begin_ = kBeginOfTime;
};

}  // namespace atlas
