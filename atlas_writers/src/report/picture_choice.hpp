// SPDX-License-Identifier: MIT
// Picks, from the many pictures of a run, the ones that show most, and makes them presentable.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

namespace atlas::report {

/// A picture and what it is.
struct Picture {
  cv::Mat pixels;  ///< CV_8UC3
  std::string caption;
};

/// 16-bit depth image (z-depth x 256, 0 = none) in colour: near red, far blue, unknown dark.
cv::Mat colorDepth(const cv::Mat& depth_x256);

/// The depth image with the most known pixels among a few spread over the run; colour cameras before thermal
/// ones.
std::optional<Picture> chooseDepth(const std::filesystem::path& out);
/// The overlay nearest to the middle of the run.
std::optional<Picture> chooseOverlay(const std::filesystem::path& out);
/// The thermal image with the most labels, its boxes drawn.
std::optional<Picture> chooseThermal(const std::filesystem::path& out);

/// The contact sheet of the thermal dataset, as the run drew it.
std::optional<Picture> contactSheet(const std::filesystem::path& out);

/// Sorted files of a folder with this extension; empty when there is no such folder.
std::vector<std::filesystem::path> filesOf(const std::filesystem::path& folder, const std::string& extension);

}  // namespace atlas::report
