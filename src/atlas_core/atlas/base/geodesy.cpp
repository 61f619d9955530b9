// SPDX-License-Identifier: MIT
#include "atlas/base/geodesy.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <cmath>

namespace atlas {

LocalEnu::LocalEnu(const Geodetic& anchor) : anchor_(anchor) {}

Eigen::Vector3d LocalEnu::toMap(const Geodetic& position) const {
  const GeographicLib::LocalCartesian enu(anchor_.latitude_deg, anchor_.longitude_deg, anchor_.altitude_m);
  Eigen::Vector3d p_map;
  enu.Forward(position.latitude_deg, position.longitude_deg, position.altitude_m, p_map.x(), p_map.y(),
              p_map.z());
  return p_map;
}

Geodetic LocalEnu::toGeodetic(const Eigen::Vector3d& p_map) const {
  const GeographicLib::LocalCartesian enu(anchor_.latitude_deg, anchor_.longitude_deg, anchor_.altitude_m);
  Geodetic position;
  enu.Reverse(p_map.x(), p_map.y(), p_map.z(), position.latitude_deg, position.longitude_deg,
              position.altitude_m);
  return position;
}

double normalGravity(double latitude_deg, double altitude_m) {
  // WGS84 constants: NIMA TR8350.2, table 3.1 and 3.4
  constexpr double kEquator = 9.7803253359;  // m/s^2
  constexpr double kSomigliana = 0.00193185265241;
  constexpr double kEccentricitySq = 0.00669437999014;
  constexpr double kSemiMajor = 6378137.0;  // m
  constexpr double kFlattening = 1.0 / 298.257223563;
  constexpr double kM = 0.00344978650684;  // omega^2 a^2 b / GM
  const double sin_sq = std::pow(std::sin(latitude_deg * M_PI / 180.0), 2);
  const double on_ellipsoid =
      kEquator * (1.0 + kSomigliana * sin_sq) / std::sqrt(1.0 - kEccentricitySq * sin_sq);
  return on_ellipsoid *
         (1.0 - 2.0 / kSemiMajor * (1.0 + kFlattening + kM - 2.0 * kFlattening * sin_sq) * altitude_m +
          3.0 * altitude_m * altitude_m / (kSemiMajor * kSemiMajor));
}

}  // namespace atlas
