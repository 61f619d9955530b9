// SPDX-License-Identifier: MIT
#include "atlas/output/radiometric_png.hpp"

#include <cmath>
#include <opencv2/core.hpp>

namespace atlas {
namespace {

constexpr double kZeroCelsius = 273.15;  // kelvin
constexpr double kPerKelvin = 100.0;
constexpr double kMost = 65535.0;

}  // namespace

Outcome<cv::Mat> radiometric(const cv::Mat& grey, const TemperatureRange& range) {
  if (grey.empty() || grey.type() != CV_8UC1) return Reason::kBadLayout;
  const double low = range.minimum_degc, high = range.maximum_degc;
  if (!std::isfinite(low) || !std::isfinite(high) || low < -kZeroCelsius || high < low)
    return Reason::kNotFinite;
  cv::Mat table(1, 256, CV_16UC1), values(grey.size(), CV_16UC1);
  auto* entry = table.ptr<std::uint16_t>();
  for (int level = 0; level < 256; ++level) {
    const double value = std::round(kPerKelvin * (low + (high - low) * level / 255.0 + kZeroCelsius));
    entry[level] = static_cast<std::uint16_t>(value <= kMost ? value : 0.0);
  }
  for (int row = 0; row < grey.rows; ++row) {
    const auto* from = grey.ptr<std::uint8_t>(row);
    auto* to = values.ptr<std::uint16_t>(row);
    for (int column = 0; column < grey.cols; ++column) to[column] = entry[from[column]];
  }
  return values;
}

}  // namespace atlas
