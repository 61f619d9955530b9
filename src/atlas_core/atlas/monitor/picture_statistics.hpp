// SPDX-License-Identifier: MIT
// What a picture looks like in a few numbers, from a coarse raster of its pixels and some of its rows.
#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>

namespace atlas {

/// Grey values of a raster of pixels, row by row; the same for every size of picture.
constexpr int kRasterWidth = 96, kRasterHeight = 64;
using PictureRaster = std::array<std::uint8_t, static_cast<std::size_t>(kRasterWidth) * kRasterHeight>;

/// Grey or, of coloured pictures, green; 16 bits by their upper 8. Nullopt for an empty or another kind of
/// picture, or one smaller than the raster.
std::optional<PictureRaster> rasterOf(const cv::Mat& pixels);

struct PictureStatistics {
  double low = 0, mean = 0, high = 0;  ///< 2nd percentile, mean, 98th percentile of the grey values
  double glare_share = 0;              ///< overexposed part of the lower two thirds
  double dark_share = 0;               ///< of 8 x 8 cells, those that are dark and without texture
};
PictureStatistics statisticsOf(const PictureRaster& raster);

/// Mean over edges of (largest step of a pixel) / (rise over 4 pixels) along some rows: near 1 in a sharp
/// picture, 0.25 on a ramp; nullopt with too few edges.
std::optional<double> sharpnessOf(const cv::Mat& pixels);

}  // namespace atlas
