// SPDX-License-Identifier: MIT
// What a dataset holds, for those who are to train on it: counts per class and part, sizes of the boxes, gaps
// in time, temperatures, what was left out and why. As JSON for programs and Markdown for people.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "atlas/output/time_split.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

class DatasetCard {
 public:
  explicit DatasetCard(Duration split_block) : split_block_(split_block) {}

  /// Frames in order of time.
  void addFrame(Stamp stamp, Split split, int width, int height, bool labelled);
  /// Size in px, clipped to the image.
  void addBox(std::int32_t class_id, Split split, double width, double height);
  void addTemperatures(const TemperatureRange& range);
  /// Something that is not part of the dataset, in words: "label: unknown class id".
  void drop(const std::string& what) { ++dropped_[what]; }

  [[nodiscard]] const std::map<std::string, std::uint64_t>& dropped() const { return dropped_; }
  [[nodiscard]] std::uint64_t frames() const { return frames_[0] + frames_[1] + frames_[2]; }
  [[nodiscard]] std::string json() const;
  [[nodiscard]] std::string markdown() const;

 private:
  struct ClassCount {
    std::array<std::uint64_t, 3> boxes{};    ///< by split
    std::array<std::uint64_t, 3> sizes{};    ///< small, medium, large as COCO's evaluation
    double smallest_px = 0, largest_px = 0;  ///< shorter side
  };
  Duration split_block_;
  std::array<std::uint64_t, 3> frames_{}, unlabelled_{};
  std::map<std::int32_t, ClassCount> classes_;
  std::set<std::pair<int, int>> image_sizes_;
  std::uint64_t gaps_ = 0;  ///< longer than kGap
  Duration longest_gap_ = 0;
  std::optional<Stamp> first_, last_;
  std::uint64_t with_temperature_ = 0;
  double coldest_degc_ = 0, warmest_degc_ = 0;
  double narrowest_degc_ = 0, widest_degc_ = 0;
  std::map<std::string, std::uint64_t> dropped_;
};

}  // namespace atlas
