// SPDX-License-Identifier: MIT
#include "report/map_picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>

#include "report/number_text.hpp"
#include "report/trajectory_plot.hpp"

namespace atlas::report {
namespace {

const cv::Scalar kBackground(24, 19, 16);

struct Frame {
  float x_min = 0, y_min = 0;  ///< m
  float px_per_m = 1;
  cv::Size size;
  [[nodiscard]] cv::Point at(double x_m, double y_m) const {
    return {static_cast<int>((x_m - x_min) * px_per_m),
            size.height - 1 - static_cast<int>((y_m - y_min) * px_per_m)};
  }
};

/// Value below which the given share of the values lies.
float quantile(std::vector<float>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

struct Bounds {
  float low = 0, high = 0;
};

/// All but the outermost thousandths, so that a few stray points do not shrink the picture.
template <class Get>
Bounds bounds(const std::vector<cv::Point3f>& points, Get get, double outside) {
  std::vector<float> values;
  values.reserve(points.size());
  for (const auto& p : points) values.push_back(get(p));
  const float low = quantile(values, outside);
  return {low, quantile(values, 1 - outside)};
}

Frame frameOf(const std::vector<cv::Point3f>& points, const std::vector<TrajectoryPoint>& trajectory,
              int side_px) {
  Bounds x = bounds(
      points, [](const auto& p) { return p.x; }, 0.001);
  Bounds y = bounds(
      points, [](const auto& p) { return p.y; }, 0.001);
  for (const auto& p : trajectory) {
    x = {std::min(x.low, static_cast<float>(p.x_m)), std::max(x.high, static_cast<float>(p.x_m))};
    y = {std::min(y.low, static_cast<float>(p.y_m)), std::max(y.high, static_cast<float>(p.y_m))};
  }
  const float margin = 2.0F;  // m
  const float width = x.high - x.low + 2 * margin, height = y.high - y.low + 2 * margin;
  Frame frame{x.low - margin, y.low - margin, 0, {}};
  frame.px_per_m = std::min(static_cast<float>(side_px) / std::max(width, height), 10.0F);
  frame.size = {std::max(64, static_cast<int>(width * frame.px_per_m)),
                std::max(64, static_cast<int>(height * frame.px_per_m))};
  return frame;
}

cv::Mat highest(const std::vector<cv::Point3f>& points, const Frame& frame) {
  cv::Mat height(frame.size, CV_32FC1, cv::Scalar(-std::numeric_limits<float>::infinity()));
  for (const auto& p : points) {
    const cv::Point at = frame.at(p.x, p.y);
    if (!cv::Rect({}, frame.size).contains(at)) continue;
    float& cell = height.at<float>(at);
    cell = std::max(cell, p.z);
  }
  return height;
}

void drawScaleBar(cv::Mat& picture, const Frame& frame) {
  const double length_m = gridStep(static_cast<double>(frame.size.width) / frame.px_per_m) * 1.0;
  const int length_px = static_cast<int>(length_m * frame.px_per_m);
  const cv::Point left(16, frame.size.height - 16);
  const cv::Scalar white(235, 235, 235);
  cv::line(picture, left, left + cv::Point(length_px, 0), white, 3, cv::LINE_AA);
  cv::putText(picture, valueText(length_m) + " m", left + cv::Point(0, -8), cv::FONT_HERSHEY_SIMPLEX, 0.6,
              white, 1, cv::LINE_AA);
}

void drawTrajectory(cv::Mat& picture, const Frame& frame, const std::vector<TrajectoryPoint>& trajectory) {
  std::vector<cv::Point> line;
  for (const auto& p : trajectory) {
    const cv::Point at = frame.at(p.x_m, p.y_m);
    if (line.empty() || at != line.back()) line.push_back(at);
  }
  if (line.empty()) return;
  cv::polylines(picture, line, false, cv::Scalar(20, 20, 20), 5, cv::LINE_AA);
  cv::polylines(picture, line, false, cv::Scalar(255, 255, 255), 2, cv::LINE_AA);
  cv::circle(picture, line.front(), 7, cv::Scalar(80, 200, 80), cv::FILLED, cv::LINE_AA);
  cv::circle(picture, line.back(), 7, cv::Scalar(70, 70, 230), cv::FILLED, cv::LINE_AA);
}

}  // namespace

cv::Mat drawMap(const std::vector<cv::Point3f>& points, const std::vector<TrajectoryPoint>& trajectory,
                int side_px) {
  if (points.empty()) return {};
  const Frame frame = frameOf(points, trajectory, side_px);
  const cv::Mat height = highest(points, frame);
  const Bounds z = bounds(
      points, [](const auto& p) { return p.z; }, 0.02);
  const cv::Mat known = height > -1e30F;
  cv::Mat scaled, picture;
  height.convertTo(scaled, CV_8UC1, 255.0 / std::max(z.high - z.low, 0.1F),
                   -255.0 * z.low / std::max(z.high - z.low, 0.1F));
  cv::applyColorMap(scaled, picture, cv::COLORMAP_TURBO);
  picture.setTo(kBackground, ~known);
  drawTrajectory(picture, frame, trajectory);
  drawScaleBar(picture, frame);
  return picture;
}

}  // namespace atlas::report
