// SPDX-License-Identifier: MIT
#include "atlas/camera/detector_output.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>
#include <tuple>

#include "atlas/camera/box_overlap.hpp"

namespace atlas {
namespace {

constexpr double kGrey = 114.0;

/// The output as rows of boxes, whichever way round the network has it.
struct Rows {
  const float* data = nullptr;
  int count = 0, fields = 0;
  int row_step = 0, field_step = 0;
  bool objectness = false;
  [[nodiscard]] float at(int row, int field) const {
    return data[static_cast<std::ptrdiff_t>(row) * row_step +
                static_cast<std::ptrdiff_t>(field) * field_step];
  }
};

std::string shapeText(const cv::Mat& output) {
  std::string text;
  for (int i = 0; i < output.dims; ++i) text += (i > 0 ? " x " : "") + std::to_string(output.size[i]);
  return text;
}

Rows rowsOf(const cv::Mat& output, int classes) {
  const bool known = output.type() == CV_32F && output.isContinuous() &&
                     (output.dims == 2 || (output.dims == 3 && output.size[0] == 1));
  if (!known) throw std::runtime_error("detector: output is not one table of floats: " + shapeText(output));
  const int a = output.size[output.dims - 2], b = output.size[output.dims - 1];
  const bool fits_v5 = classes > 0 ? b == 5 + classes : b < a;
  const bool fits_v8 = classes > 0 ? a == 4 + classes : a < b;
  Rows rows;
  rows.data = output.ptr<float>();
  if (fits_v5 && b > 5) {
    rows.count = a, rows.fields = b, rows.row_step = b, rows.field_step = 1, rows.objectness = true;
  } else if (fits_v8 && a > 4) {
    rows.count = b, rows.fields = a, rows.row_step = 1, rows.field_step = b;
  } else {
    throw std::runtime_error("detector: output of shape " + shapeText(output) +
                             " is neither 1 x N x (5 + classes) nor 1 x (4 + classes) x N" +
                             (classes > 0 ? " of " + std::to_string(classes) + " classes" : ""));
  }
  return rows;
}

/// The box of a row if it is sure enough; false for what is no box.
bool boxOf(const Rows& rows, int row, double least, Detection2d& box) {
  const int first = rows.objectness ? 5 : 4;
  const double objectness = rows.objectness ? rows.at(row, 4) : 1.0;
  if (!(objectness >= least)) return false;
  int best = first;
  for (int field = first + 1; field < rows.fields; ++field)
    if (rows.at(row, field) > rows.at(row, best)) best = field;
  const double score = objectness * rows.at(row, best);
  if (!(score >= least)) return false;  // also when it is not a number
  box.confidence = std::min(1.0, score);
  box.class_id = best - first;
  const double x = rows.at(row, 0), y = rows.at(row, 1), w = rows.at(row, 2), h = rows.at(row, 3);
  if (!(w > 0.0) || !(h > 0.0) || !std::isfinite(x + y + w + h)) return false;
  box.x_min = x - 0.5 * w, box.x_max = x + 0.5 * w, box.y_min = y - 0.5 * h, box.y_max = y + 0.5 * h;
  return true;
}

/// Greedy: the strongest stays, what overlaps it and has its class goes.
std::vector<Detection2d> strongest(std::vector<Detection2d> boxes, const DetectionLimits& limits) {
  std::sort(boxes.begin(), boxes.end(), [](const Detection2d& a, const Detection2d& b) {
    return std::make_tuple(-a.confidence, a.class_id, a.x_min, a.y_min, a.x_max, a.y_max) <
           std::make_tuple(-b.confidence, b.class_id, b.x_min, b.y_min, b.x_max, b.y_max);
  });
  std::vector<Detection2d> kept;
  for (const Detection2d& box : boxes) {
    const bool same = std::any_of(kept.begin(), kept.end(), [&](const Detection2d& better) {
      return better.class_id == box.class_id && overlapOf(better, box) > limits.overlap;
    });
    if (!same) kept.push_back(box);
    if (kept.size() >= static_cast<std::size_t>(limits.most)) break;
  }
  return kept;
}

}  // namespace

void validate(const DetectionLimits& limits) {
  const auto share = [](const char* name, double value) {
    if (!(value > 0.0 && value < 1.0))
      throw std::invalid_argument(std::string(name) + " must be between 0 and 1, got " +
                                  std::to_string(value));
  };
  share("min_confidence", limits.confidence);
  share("max_overlap", limits.overlap);
  if (limits.most < 1)
    throw std::invalid_argument("max_detections must be at least 1, got " + std::to_string(limits.most));
}

Letterbox letterboxOf(const cv::Size& image, int side_px) {
  Letterbox box;
  box.scale = static_cast<double>(side_px) / std::max(image.width, image.height);
  box.left = std::floor(0.5 * (side_px - std::round(box.scale * image.width)));
  box.top = std::floor(0.5 * (side_px - std::round(box.scale * image.height)));
  return box;
}

cv::Mat networkInput(const cv::Mat& image, int side_px) {
  const Letterbox box = letterboxOf(image.size(), side_px);
  const cv::Size size(std::max(1, static_cast<int>(std::round(box.scale * image.cols))),
                      std::max(1, static_cast<int>(std::round(box.scale * image.rows))));
  cv::Mat small, color;
  cv::resize(image, small, size, 0, 0, cv::INTER_LINEAR);
  cv::cvtColor(small, color, image.channels() == 1 ? cv::COLOR_GRAY2RGB : cv::COLOR_BGR2RGB);
  cv::Mat square(side_px, side_px, CV_8UC3, cv::Scalar::all(kGrey));
  color.copyTo(
      square(cv::Rect(static_cast<int>(box.left), static_cast<int>(box.top), size.width, size.height)));
  const std::array<int, 4> shape = {1, 3, side_px, side_px};
  cv::Mat blob(4, shape.data(), CV_32F);
  const auto plane = static_cast<std::size_t>(side_px) * static_cast<std::size_t>(side_px);
  float* values = blob.ptr<float>();
  for (std::size_t i = 0; i < plane; ++i) {
    const std::uint8_t* pixel = square.data + 3 * i;
    for (std::size_t channel = 0; channel < 3; ++channel)
      values[channel * plane + i] = static_cast<float>(pixel[channel]) / 255.0F;
  }
  return blob;
}

std::vector<Detection2d> detectionsOf(const cv::Mat& output, const cv::Size& image, int side_px,
                                      const DetectionLimits& limits, int classes) {
  const Rows rows = rowsOf(output, classes);
  const Letterbox letterbox = letterboxOf(image, side_px);
  // Networks count from the edge of the first pixel, images here from its centre.
  const auto u = [&](double x) { return (x - letterbox.left) / letterbox.scale - 0.5; };
  const auto v = [&](double y) { return (y - letterbox.top) / letterbox.scale - 0.5; };
  std::vector<Detection2d> boxes;
  for (int row = 0; row < rows.count; ++row) {
    Detection2d box;
    if (!boxOf(rows, row, limits.confidence, box)) continue;
    box.x_min = u(box.x_min), box.x_max = u(box.x_max), box.y_min = v(box.y_min), box.y_max = v(box.y_max);
    boxes.push_back(box);
  }
  return strongest(std::move(boxes), limits);
}

}  // namespace atlas
