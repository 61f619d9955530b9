// SPDX-License-Identifier: MIT
// A receiver: positions that are none, frozen or jump, its own standard deviation, headings lost or jumping.
#pragma once

#include <deque>
#include <optional>

#include "atlas/base/geodesy.hpp"
#include "atlas/monitor/findings.hpp"
#include "atlas/monitor/motion_witness.hpp"
#include "atlas/monitor/same_for.hpp"

namespace atlas {

class GnssCheck {
 public:
  void add(const GnssFix& fix, Findings& findings);
  void add(const GnssHeading& heading, Findings& findings);
  [[nodiscard]] const MotionWitness& motion() const { return motion_; }

 private:
  struct Place {
    Stamp stamp;
    Eigen::Vector3d p_map;
  };
  void measureJump(const GnssFix& fix, Findings& findings);

  std::optional<LocalEnu> map_;  ///< anchored at the first fix
  SameFor<Eigen::Vector3d> same_;
  std::deque<Place> places_;  ///< newest ones, up to a second
  MotionWitness motion_;
  std::optional<GnssHeading> heading_;  ///< newest
};

}  // namespace atlas
