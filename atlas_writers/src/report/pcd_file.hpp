// SPDX-License-Identifier: MIT
// Reads the x y z of a PCD file (version 0.7, ascii or binary, any other fields skipped).
#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <string>
#include <vector>

namespace atlas::report {

/// Finite points only. Throws std::runtime_error naming the file and what is wrong with it.
std::vector<cv::Point3f> readPcd(const std::filesystem::path& path);

}  // namespace atlas::report
