// SPDX-License-Identifier: MIT
#include "atlas/base/geodesy.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace atlas {
namespace {

constexpr double kDeg = M_PI / 180.0;
const Geodetic kBrno{49.22810527, 16.57547959, 281.368};

/// Geodetic to earth-centred, written down anew from the ellipsoid (WGS84 a and f): independent of
/// GeographicLib.
Eigen::Vector3d earthCentred(const Geodetic& g) {
  const double a = 6378137.0, f = 1.0 / 298.257223563, e2 = f * (2.0 - f);
  const double lat = g.latitude_deg * kDeg, lon = g.longitude_deg * kDeg;
  const double n = a / std::sqrt(1.0 - e2 * std::sin(lat) * std::sin(lat));
  return {(n + g.altitude_m) * std::cos(lat) * std::cos(lon),
          (n + g.altitude_m) * std::cos(lat) * std::sin(lon),
          (n * (1.0 - e2) + g.altitude_m) * std::sin(lat)};
}

TEST(LocalEnu, AnchorIsTheOrigin) { EXPECT_LT(LocalEnu(kBrno).toMap(kBrno).norm(), 1e-9); }

TEST(LocalEnu, AxesPointEastNorthUp) {
  const LocalEnu map(kBrno);
  Geodetic g = kBrno;
  g.longitude_deg += 1e-5;
  EXPECT_GT(map.toMap(g).x(), 0.7);
  g = kBrno;
  g.latitude_deg += 1e-5;
  EXPECT_GT(map.toMap(g).y(), 1.1);
  g = kBrno;
  g.altitude_m += 2.0;
  EXPECT_LT((map.toMap(g) - Eigen::Vector3d(0, 0, 2)).norm(), 1e-9);
}

TEST(LocalEnu, W11_AgreesWithTheEllipsoidToTheTenthOfAMillimetre) {
  // W11: a sphere loses 3.07 m of each kilometre to the east here.
  const LocalEnu map(kBrno);
  const double lat = kBrno.latitude_deg * kDeg, lon = kBrno.longitude_deg * kDeg;
  Eigen::Matrix3d R_enu_ecef;
  R_enu_ecef << -std::sin(lon), std::cos(lon), 0, -std::sin(lat) * std::cos(lon),
      -std::sin(lat) * std::sin(lon), std::cos(lat), std::cos(lat) * std::cos(lon),
      std::cos(lat) * std::sin(lon), std::sin(lat);
  for (const double dlat : {-0.01, 0.0, 0.009}) {
    for (const double dlon : {-0.02, 0.0, 0.0137}) {
      const Geodetic g{kBrno.latitude_deg + dlat, kBrno.longitude_deg + dlon, 300.0};
      const Eigen::Vector3d expected = R_enu_ecef * (earthCentred(g) - earthCentred(kBrno));
      EXPECT_LT((map.toMap(g) - expected).norm(), 1e-4);
    }
  }
}

TEST(LocalEnu, ChordOfAMeridianKilometre) {
  // One kilometre along the meridian by its radius of curvature M = a(1-e^2)/(1-e^2 sin^2)^1.5
  const double e2 = 0.00669437999014, s = std::sin(kBrno.latitude_deg * kDeg);
  const double M = 6378137.0 * (1.0 - e2) / std::pow(1.0 - e2 * s * s, 1.5) + kBrno.altitude_m;
  Geodetic g = kBrno;
  g.latitude_deg += 1000.0 / M / kDeg;
  EXPECT_NEAR(LocalEnu(kBrno).toMap(g).y(), 1000.0, 2e-3);
  EXPECT_NEAR(LocalEnu(kBrno).toMap(g).z(), -1e6 / (2.0 * M), 1e-3);
}

TEST(LocalEnu, RoundTrip) {
  const LocalEnu map(kBrno);
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1234.5, -987.6, 30),
                                   Eigen::Vector3d(-20000, 15000, -100)}) {
    EXPECT_LT((map.toMap(map.toGeodetic(p)) - p).norm(), 1e-6);
  }
}

TEST(LocalEnu, AcrossTheDateLine) {
  const LocalEnu map({10.0, 179.9999, 0.0});
  EXPECT_NEAR(map.toMap({10.0, -179.9999, 0.0}).x(), 0.0002 * kDeg * 6378137.0 * std::cos(10.0 * kDeg), 0.1);
}

TEST(NormalGravity, KnownValues) {
  EXPECT_NEAR(normalGravity(0.0, 0.0), 9.7803253359, 1e-10);
  EXPECT_NEAR(normalGravity(90.0, 0.0), 9.8321849378, 1e-9);
  EXPECT_NEAR(normalGravity(-90.0, 0.0), 9.8321849378, 1e-9);
  EXPECT_NEAR(normalGravity(45.0, 0.0), 9.8061992,
              2e-6);  // GRS80 (Moritz 2000), differs from WGS84 by 1.4e-6
}

TEST(NormalGravity, FallsWithHeight) {
  // free-air gradient 3.086e-6 1/s^2
  EXPECT_NEAR(normalGravity(49.2, 0.0) - normalGravity(49.2, 1000.0), 3.086e-3, 5e-6);
  EXPECT_EQ(normalGravity(49.2, 300.0), normalGravity(-49.2, 300.0));
}

}  // namespace
}  // namespace atlas
