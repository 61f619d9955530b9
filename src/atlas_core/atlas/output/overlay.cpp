// SPDX-License-Identifier: MIT
#include "atlas/output/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "atlas/output/coco_names.hpp"
#include "atlas/output/fixed_text.hpp"

namespace atlas {
namespace {

// Colours are chosen once, so that a class has the same one in every picture.
const cv::Scalar& classColor(int class_id) {
  static const std::array<cv::Scalar, 6> colors = {cv::Scalar(60, 220, 60),  cv::Scalar(40, 170, 255),
                                                   cv::Scalar(255, 190, 40), cv::Scalar(220, 80, 220),
                                                   cv::Scalar(80, 230, 230), cv::Scalar(230, 230, 90)};
  return colors[static_cast<std::size_t>(std::abs(class_id % 6))];
}

cv::Mat colorCopy(const cv::Mat& image) {
  cv::Mat copy;
  if (image.channels() == 1) {
    cv::cvtColor(image, copy, cv::COLOR_GRAY2BGR);
  } else {
    copy = image.clone();
  }
  return copy;
}

cv::Point toPixel(double u, double v, const cv::Mat& image) {
  return {static_cast<int>(std::lround(std::clamp(u, -10.0, image.cols + 10.0))),
          static_cast<int>(std::lround(std::clamp(v, -10.0, image.rows + 10.0)))};
}

void drawBox(cv::Mat& image, const Detection2d& box, const std::string& label) {
  for (const double edge : {box.x_min, box.y_min, box.x_max, box.y_max}) {
    if (!std::isfinite(edge)) return;
  }
  const cv::Scalar& color = classColor(box.class_id);
  const double scale = std::max(0.35, image.cols / 2400.0);
  const cv::Point corner = toPixel(box.x_min, box.y_min, image);
  cv::rectangle(image, corner, toPixel(box.x_max, box.y_max, image), color, image.cols > 1000 ? 2 : 1);
  int baseline = 0;
  const cv::Size size = cv::getTextSize(label, cv::FONT_HERSHEY_SIMPLEX, scale, 1, &baseline);
  const int x = std::clamp(corner.x, 0, std::max(0, image.cols - size.width));
  const int y = std::max(corner.y - 3, size.height + 1);
  cv::rectangle(image, {x, y - size.height - 1}, {x + size.width, y + baseline / 2}, cv::Scalar(0, 0, 0),
                cv::FILLED);
  cv::putText(image, label, {x, y}, cv::FONT_HERSHEY_SIMPLEX, scale, color, 1, cv::LINE_AA);
}

}  // namespace

cv::Mat drawDepth(const cv::Mat& image, const cv::Mat& depth_m, double max_depth_m) {
  if (image.size() != depth_m.size())
    throw std::invalid_argument("overlay: depth must have the image's size");
  constexpr double kNear_m = 2.0;  // where the colours begin; equal ratios of depth are equal steps of colour
  constexpr double kShare = 0.55;  // of the dot's colour, the rest is the picture below it
  const cv::Mat below = colorCopy(image);
  cv::Mat picture = below.clone(), scale(256, 1, CV_8UC1), colors;
  for (int i = 0; i < 256; ++i) scale.at<std::uint8_t>(i) = static_cast<std::uint8_t>(255 - i);
  cv::applyColorMap(scale, colors, cv::COLORMAP_TURBO);
  for (int row = 0; row < depth_m.rows; ++row) {
    const float* depth = depth_m.ptr<float>(row);
    for (int column = 0; column < depth_m.cols; ++column) {
      if (!(depth[column] > 0.0F)) continue;
      const double share = std::log(depth[column] / kNear_m) / std::log(max_depth_m / kNear_m);
      const auto& color = colors.at<cv::Vec3b>(static_cast<int>(255.0 * std::clamp(share, 0.0, 1.0)));
      cv::circle(picture, {column, row}, image.cols > 1500 ? 1 : 0, cv::Scalar(color[0], color[1], color[2]),
                 cv::FILLED);
    }
  }
  cv::addWeighted(picture, kShare, below, 1.0 - kShare, 0.0, picture);
  return picture;
}

cv::Mat drawFrustums(const cv::Mat& image, const Frustums& frustums) {
  cv::Mat picture = colorCopy(image);
  for (const Frustum& frustum : frustums.frustums) {
    drawBox(picture, frustum.detection,
            className(frustum.detection.class_id) + " " + fixedText(frustum.distance_m, 1) + " m");
  }
  return picture;
}

cv::Mat drawDetections(const cv::Mat& image, const Detections& detections) {
  cv::Mat picture = colorCopy(image);
  for (const Detection2d& box : detections.boxes) {
    drawBox(picture, box, className(box.class_id) + " " + fixedText(box.confidence, 2));
  }
  return picture;
}

}  // namespace atlas
