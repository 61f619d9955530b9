// SPDX-License-Identifier: MIT
// Images as PNG files, fast rather than small: one filter for all rows, runs and Huffman codes.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace atlas {

/// PNG bytes of a grey image of 8 or 16 bits or of a BGR image of 8. Throws std::invalid_argument for an
/// empty image and for any other layout.
std::vector<std::uint8_t> encodePng(const cv::Mat& image);

}  // namespace atlas
