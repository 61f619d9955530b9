// SPDX-License-Identifier: MIT
#include "atlas/monitor/camera_check.hpp"

#include <algorithm>
#include <cmath>

namespace atlas {
namespace {
constexpr double kBrightPicture = 40.0;  // mean grey: in the dark everything looks covered
constexpr Duration kCovered = kSecond;
}  // namespace

void CameraCheck::add(const Image& image, const MotionWitness& motion, Findings& findings) {
  const Stamp stamp = image.stamp;
  const auto raster = rasterOf(image.pixels);
  findings.measure(Anomaly::kPictureEmpty, stamp, raster ? 0.0 : 1.0);
  if (!raster) return;
  const double same_s = same_.add(stamp, *raster);
  if (!motion.standing(stamp)) findings.measure(Anomaly::kPictureFrozen, stamp, same_s);
  const PictureStatistics picture = statisticsOf(*raster);
  findings.measure(Anomaly::kBlack, stamp, picture.high);
  findings.measure(Anomaly::kWhite, stamp, picture.low);
  const bool lit = picture.high >= findings.threshold(Anomaly::kBlack) &&
                   picture.low <= findings.threshold(Anomaly::kWhite);
  if (!lit) return;
  findings.measure(Anomaly::kFogged, stamp, picture.high - picture.low);
  findings.measure(Anomaly::kGlare, stamp, picture.glare_share);
  measureOcclusion(picture, image.pixels.channels() == 1, stamp, findings);
  const auto sharpness = sharpnessOf(image.pixels);
  if (sharpness) findings.measure(Anomaly::kBlurred, stamp, *sharpness);
}

void CameraCheck::measureOcclusion(const PictureStatistics& picture, bool grey, Stamp stamp,
                                   Findings& findings) {
  if (grey || picture.mean < kBrightPicture) return;
  const bool dark = picture.dark_share > findings.threshold(Anomaly::kOccluded);
  if (!dark) {
    dark_since_.reset();
  } else if (!dark_since_) {
    dark_since_ = stamp;
  }
  const bool lasting = dark_since_ && stamp - *dark_since_ >= kCovered;
  findings.measure(Anomaly::kOccluded, stamp, lasting ? picture.dark_share : 0.0);
}

void CameraCheck::add(const TemperatureRange& range, Findings& findings) {
  const double low = range.minimum_degc, high = range.maximum_degc;
  const bool finite = std::isfinite(low) && std::isfinite(high);
  findings.measure(Anomaly::kNotFinite, range.stamp, finite ? 0.0 : 1.0);
  if (!finite) return;
  findings.measure(Anomaly::kTemperatureRangeFrozen, range.stamp, same_range_.add(range.stamp, {low, high}));
  const double limit = findings.threshold(Anomaly::kTemperatureRange);
  const double largest = std::max(std::abs(low), std::abs(high));
  findings.judge(Anomaly::kTemperatureRange, range.stamp, largest > limit || high < low, largest, limit);
}

}  // namespace atlas
