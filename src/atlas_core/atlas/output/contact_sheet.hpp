// SPDX-License-Identifier: MIT
// A picture of pictures: some labelled frames of a dataset, chosen at random, side by side. What a person
// looks at before training on it.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "atlas/sensor/sensor.hpp"

namespace atlas {

class ContactSheet {
 public:
  /// Every frame that is offered has the same chance (reservoir sampling); the same frames and seed give the
  /// same sheet. Holds `frames` small pictures, however many are offered. Throws std::invalid_argument for
  /// less than one frame.
  explicit ContactSheet(int frames = 16, std::uint64_t seed = 1);

  /// 8-bit grey or BGR; other pictures cannot be chosen.
  void offer(const cv::Mat& picture, const Detections& labels, const std::string& caption);
  /// CV_8UC3, in the order of the offers; empty when there were none.
  [[nodiscard]] cv::Mat draw() const;

 private:
  struct Tile {
    std::uint64_t offer = 0;
    cv::Mat picture;
  };
  std::uint64_t random();

  std::size_t frames_;
  std::uint64_t state_;
  std::uint64_t offers_ = 0;
  std::vector<Tile> tiles_;
};

}  // namespace atlas
