// SPDX-License-Identifier: MIT
// WGS84 <-> local east-north-up (ENU) frame `map`, through GeographicLib (Karney 2011): ellipsoid, not a
// sphere.
#pragma once

#include <Eigen/Core>

namespace atlas {

/// WGS84 geodetic position: degrees, degrees, metres above the ellipsoid.
struct Geodetic {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double altitude_m = 0.0;
};

/// Origin of `map`: p_map = ENU coordinates, m, tangential to the ellipsoid at the anchor.
class LocalEnu {
 public:
  explicit LocalEnu(const Geodetic& anchor);
  [[nodiscard]] Eigen::Vector3d toMap(const Geodetic& position) const;
  [[nodiscard]] Geodetic toGeodetic(const Eigen::Vector3d& p_map) const;
  [[nodiscard]] const Geodetic& anchor() const { return anchor_; }

 private:
  Geodetic anchor_;
};

/// Normal gravity on the WGS84 ellipsoid at a latitude, reduced to a height (Somigliana; NIMA TR8350.2 eq.
/// 4-1, 4-3), m/s^2.
double normalGravity(double latitude_deg, double altitude_m);

}  // namespace atlas
