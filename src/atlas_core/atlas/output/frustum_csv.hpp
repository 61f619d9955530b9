// SPDX-License-Identifier: MIT
// Frustums as CSV: stamp,frame,detection,class,confidence,distance,x,y,z - stamp in ns, frame = index of the
// image, detection = index in the image, distance = z-depth in m, x y z in map.
#pragma once

#include <string>

#include "atlas/sensor/products.hpp"

namespace atlas {

std::string frustumCsvHeader();
/// One row per frustum.
std::string frustumCsvRows(const Frustums& frustums);

}  // namespace atlas
