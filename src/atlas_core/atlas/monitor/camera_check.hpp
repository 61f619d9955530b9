// SPDX-License-Identifier: MIT
// The pictures of a camera: empty, frozen, black, white, blurred, fogged, glare, occluded; of a thermal
// camera its range of temperatures, too.
#pragma once

#include "atlas/monitor/findings.hpp"
#include "atlas/monitor/motion_witness.hpp"
#include "atlas/monitor/picture_statistics.hpp"
#include "atlas/monitor/same_for.hpp"

namespace atlas {

class CameraCheck {
 public:
  void add(const Image& image, const MotionWitness& motion, Findings& findings);
  void add(const TemperatureRange& range, Findings& findings);

 private:
  void measureOcclusion(const PictureStatistics& picture, bool grey, Stamp stamp, Findings& findings);

  SameFor<PictureRaster> same_;
  std::optional<Stamp> dark_since_;
  SameFor<std::pair<double, double>> same_range_;
};

}  // namespace atlas
