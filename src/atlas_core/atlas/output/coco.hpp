// SPDX-License-Identifier: MIT
// COCO object detection format (cocodataset.org, "Data format") as pieces of text, so that an hour of images
// can be written without being kept in memory: cocoBegin, images, cocoMiddle, annotations, cocoEnd; ","
// between neighbours of a list. category_id is the class number of the label files (0..79); annotation ids
// start at 1, as evaluation tools take 0 for none.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct CocoImage {
  std::uint64_t id = 0;
  std::string file_name;
  int width = 0, height = 0;
  Stamp stamp = 0;
  std::optional<TemperatureRange> temperature;  ///< of grey 0 and grey 255
  std::string split;                            ///< "train", "val", "test"; may be empty
};

/// `{"categories":[...],"info":{...},"images":[`
std::string cocoBegin(const std::string& description);
std::string cocoImage(const CocoImage& image);
/// `],"annotations":[`
std::string cocoMiddle();
/// bbox is [x, y, width, height] in px from the upper left corner of the image (half a pixel before the
/// centre of its first one), clipped to the image; nullopt when nothing of the box is inside.
std::optional<std::string> cocoAnnotation(std::uint64_t id, const CocoImage& image,
                                          const Detection2d& detection);
/// `]}`
std::string cocoEnd();

}  // namespace atlas
