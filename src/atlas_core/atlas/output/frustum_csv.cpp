// SPDX-License-Identifier: MIT
#include "atlas/output/frustum_csv.hpp"

#include "atlas/output/fixed_text.hpp"

namespace atlas {

std::string frustumCsvHeader() { return "stamp,frame,detection,class,confidence,distance,x,y,z\n"; }

std::string frustumCsvRows(const Frustums& frustums) {
  std::string text;
  for (const Frustum& frustum : frustums.frustums) {
    text += std::to_string(frustums.stamp) + "," + std::to_string(frustums.image_index) + "," +
            std::to_string(frustum.detection_index) + "," + std::to_string(frustum.detection.class_id) + "," +
            fixedText(frustum.detection.confidence, 4) + "," + fixedText(frustum.distance_m, 4) + "," +
            fixedText(frustum.position.x(), 4) + "," + fixedText(frustum.position.y(), 4) + "," +
            fixedText(frustum.position.z(), 4) + "\n";
  }
  return text;
}

}  // namespace atlas
