// SPDX-License-Identifier: MIT
#include "atlas/output/contact_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "atlas/output/overlay.hpp"

namespace atlas {
namespace {

constexpr int kTileWidth = 400, kMostHeight = 400, kCaption = 18, kGap = 4;  // px

/// The frame made small, then its labels: lines and letters keep their size.
cv::Mat tileOf(const cv::Mat& picture, const Detections& labels, const std::string& caption) {
  const double scale = std::min(static_cast<double>(kTileWidth) / picture.cols,
                                static_cast<double>(kMostHeight) / picture.rows);
  const cv::Size size(std::max(1, static_cast<int>(std::lround(scale * picture.cols))),
                      std::max(1, static_cast<int>(std::lround(scale * picture.rows))));
  cv::Mat small;
  cv::resize(picture, small, size, 0, 0, cv::INTER_AREA);
  Detections scaled = labels;
  for (Detection2d& box : scaled.boxes) {  // the centre of the first pixel is 0 in both
    for (double* edge : {&box.x_min, &box.y_min, &box.x_max, &box.y_max}) *edge = scale * (*edge + 0.5) - 0.5;
  }
  small = drawDetections(small, scaled);
  cv::Mat tile(size.height + kCaption, kTileWidth, CV_8UC3, cv::Scalar(24, 19, 16));
  small.copyTo(tile(cv::Rect(0, kCaption, size.width, size.height)));
  cv::putText(tile, caption, {3, kCaption - 5}, cv::FONT_HERSHEY_SIMPLEX, 0.4, cv::Scalar(230, 230, 230), 1,
              cv::LINE_AA);
  return tile;
}

}  // namespace

ContactSheet::ContactSheet(int frames, std::uint64_t seed)
    : frames_(static_cast<std::size_t>(std::max(0, frames))), state_(seed) {
  if (frames < 1)
    throw std::invalid_argument("contact sheet: at least one frame, got " + std::to_string(frames));
}

/// splitmix64: the same numbers everywhere, which the distributions of <random> do not promise.
std::uint64_t ContactSheet::random() {
  std::uint64_t z = (state_ += 0x9E3779B97F4A7C15U);
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

void ContactSheet::offer(const cv::Mat& picture, const Detections& labels, const std::string& caption) {
  if (picture.empty() || (picture.type() != CV_8UC1 && picture.type() != CV_8UC3)) return;
  const std::uint64_t offer = offers_++;
  if (tiles_.size() < frames_) {
    tiles_.push_back({offer, tileOf(picture, labels, caption)});
    return;
  }
  const std::uint64_t slot = random() % (offer + 1);
  if (slot < frames_) tiles_[slot] = {offer, tileOf(picture, labels, caption)};
}

cv::Mat ContactSheet::draw() const {
  if (tiles_.empty()) return {};
  std::vector<const Tile*> order;
  for (const Tile& tile : tiles_) order.push_back(&tile);
  std::sort(order.begin(), order.end(), [](const Tile* a, const Tile* b) { return a->offer < b->offer; });
  int height = 0;
  for (const Tile* tile : order) height = std::max(height, tile->picture.rows);
  const int count = static_cast<int>(order.size());
  const int columns = static_cast<int>(std::ceil(std::sqrt(count))), rows = (count + columns - 1) / columns;
  cv::Mat sheet(rows * (height + kGap) - kGap, columns * (kTileWidth + kGap) - kGap, CV_8UC3,
                cv::Scalar(60, 60, 60));
  for (int i = 0; i < count; ++i) {
    const cv::Mat& tile = order[static_cast<std::size_t>(i)]->picture;
    tile.copyTo(sheet(cv::Rect((i % columns) * (kTileWidth + kGap), (i / columns) * (height + kGap),
                               tile.cols, tile.rows)));
  }
  return sheet;
}

}  // namespace atlas
