// SPDX-License-Identifier: MIT
// A picture as a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "atlas/output/png.hpp"
#include "files/output_file.hpp"

namespace atlas {

inline void writePng(const std::filesystem::path& path, const cv::Mat& image) {
  const std::vector<std::uint8_t> bytes = encodePng(image);
  OutputFile file(path);
  file.write(bytes.data(), bytes.size());
  file.commit();
}

}  // namespace atlas
