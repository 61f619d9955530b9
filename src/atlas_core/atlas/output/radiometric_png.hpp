// SPDX-License-Identifier: MIT
// Thermal images as temperatures: 16 bit, value = 100 x kelvin (centikelvin, as FLIR's 16-bit TIFF with
// TLinear on high), 0 = unknown. Degrees Celsius = value / 100 - 273.15.
#pragma once

#include <opencv2/core/mat.hpp>

#include "atlas/base/outcome.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

/// CV_16UC1 of a CV_8UC1 image whose grey 0 and grey 255 have the temperatures of `range`, straight between.
/// The steps of the camera's 8 bits remain: (maximum - minimum) / 255. Temperatures that 16 bits do not hold
/// (above 382.2 deg C) are unknown. Reasons: kBadLayout for another kind of image, kNotFinite for a range
/// that is not finite, below absolute zero, or ends below its beginning.
Outcome<cv::Mat> radiometric(const cv::Mat& grey, const TemperatureRange& range);

}  // namespace atlas
