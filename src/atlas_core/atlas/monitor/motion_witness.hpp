// SPDX-License-Identifier: MIT
// Does the vehicle move? What one sensor (a receiver) says, so that others can be judged: a picture may stay
// the same and turn rates must vanish while it stands.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <optional>

#include "atlas/base/time.hpp"

namespace atlas {

class MotionWitness {
 public:
  /// A new position; one that is repeated to the last digit is none.
  void add(Stamp stamp, const Eigen::Vector3d& p_map);
  /// Both false when nobody knows.
  [[nodiscard]] bool standing(Stamp stamp) const;
  [[nodiscard]] bool moving(Stamp stamp) const;

 private:
  [[nodiscard]] std::optional<double> speed(Stamp stamp) const;  ///< m/s over the last second

  struct Place {
    Stamp stamp;
    Eigen::Vector2d p_map;
  };
  std::deque<Place> places_;  ///< of about a second
};

}  // namespace atlas
