// SPDX-License-Identifier: MIT
// PNG files in memory, fast rather than small: the chunks by libpng, the packing by libdeflate. OpenCV's
// encoder packs with zlib, which took a quarter of the CPU time of a whole run.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace atlas {

/// The bytes of a PNG file of an 8- or 16-bit image with one channel, or 8-bit with three (blue, green, red).
/// Throws std::invalid_argument for an empty image or another kind of pixels.
std::vector<std::uint8_t> encodePng(const cv::Mat& image);

}  // namespace atlas
