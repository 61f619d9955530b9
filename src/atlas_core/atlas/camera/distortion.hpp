// SPDX-License-Identifier: MIT
// Lens distortion of OpenCV's camera models on the plane z = 1, in double (calibration side) and float (loops
// over points). Polynomial (plumb_bob, rational_polynomial; OpenCV calib3d, "Detailed Description"), s = x^2
// + y^2:
//   f(s) = (1 + k1 s + k2 s^2 + k3 s^3) / (1 + k4 s + k5 s^2 + k6 s^3)
//   x_d = x f + 2 p1 x y + p2 (s + 2 x^2),   y_d = y f + p1 (s + 2 y^2) + 2 p2 x y
// Fisheye (equidistant; Kannala and Brandt 2006, "A generic camera model and calibration method", eq. 6), r =
// sqrt(s):
//   theta = atan(r),   f = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8) / r,   x_d = x f,
//   y_d = y f
#pragma once

#include <cmath>
#include <cstddef>

namespace atlas {

enum class DistortionKind { kNone, kPolynomial, kFisheye };

template <class Scalar>
struct Distortion {
  DistortionKind kind = DistortionKind::kNone;
  Scalar k[8] = {0, 0, 0, 0, 0, 0, 0, 0};  ///< k1 k2 p1 p2 k3 k4 k5 k6; fisheye: k1..k4 in the first four

  template <class Other>
  [[nodiscard]] Distortion<Other> cast() const {
    Distortion<Other> result;
    result.kind = kind;
    for (int i = 0; i < 8; ++i) result.k[i] = static_cast<Other>(k[i]);
    return result;
  }

  /// theta_d of a fisheye lens for the angle theta off axis.
  [[nodiscard]] Scalar fisheyeAngle(Scalar theta) const {
    const Scalar t = theta * theta;
    return theta * (1 + t * (k[0] + t * (k[1] + t * (k[2] + t * k[3]))));
  }
  /// d theta_d / d theta.
  [[nodiscard]] Scalar fisheyeSlope(Scalar theta) const {
    const Scalar t = theta * theta;
    return 1 + t * (3 * k[0] + t * (5 * k[1] + t * (7 * k[2] + t * 9 * k[3])));
  }
  [[nodiscard]] Scalar denominator(Scalar s) const { return 1 + s * (k[5] + s * (k[6] + s * k[7])); }
  /// f(s) of the polynomial model.
  [[nodiscard]] Scalar radial(Scalar s) const {
    return (1 + s * (k[0] + s * (k[1] + s * k[4]))) / denominator(s);
  }
  /// df/ds of the polynomial model.
  [[nodiscard]] Scalar radialSlope(Scalar s) const {
    const Scalar below = denominator(s);
    const Scalar above_slope = k[0] + s * (2 * k[1] + s * 3 * k[4]);
    const Scalar below_slope = k[5] + s * (2 * k[6] + s * 3 * k[7]);
    return (above_slope - radial(s) * below_slope) / below;
  }

  /// Distorts (x, y) in place.
  void apply(Scalar& x, Scalar& y) const {
    if (kind == DistortionKind::kNone) return;
    const Scalar s = x * x + y * y;
    if (kind == DistortionKind::kFisheye) {
      const Scalar r = std::sqrt(s);
      if (r <= Scalar(1e-9)) return;  // f -> 1 on the axis
      const Scalar f = fisheyeAngle(std::atan(r)) / r;
      x *= f;
      y *= f;
      return;
    }
    polynomial(x, y);
  }
  /// apply() for many points; the polynomial loop has no branches.
  void applyAll(Scalar* x, Scalar* y, std::size_t count) const {
    if (kind == DistortionKind::kNone) return;
    if (kind == DistortionKind::kPolynomial) {
      const Distortion d = *this;  // by value: the stores cannot change it
      for (std::size_t i = 0; i < count; ++i) d.polynomial(x[i], y[i]);
      return;
    }
    for (std::size_t i = 0; i < count; ++i) apply(x[i], y[i]);
  }

 private:
  void polynomial(Scalar& x, Scalar& y) const {
    const Scalar s = x * x + y * y;
    const Scalar f = radial(s);
    const Scalar xy2 = 2 * x * y;
    const Scalar x_d = x * f + k[2] * xy2 + k[3] * (s + 2 * x * x);
    y = y * f + k[2] * (s + 2 * y * y) + k[3] * xy2;
    x = x_d;
  }
};

}  // namespace atlas
