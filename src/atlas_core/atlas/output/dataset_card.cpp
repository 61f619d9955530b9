// SPDX-License-Identifier: MIT
#include "atlas/output/dataset_card.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "atlas/output/coco_names.hpp"
#include "atlas/output/fixed_text.hpp"

namespace atlas {
namespace {

using Json = nlohmann::ordered_json;

constexpr Duration kGap = kSecond;  // between two frames; what is longer is told
constexpr double kSmall_px2 = 32.0 * 32.0, kMedium_px2 = 96.0 * 96.0;  // limits of COCO's evaluation
constexpr std::array<const char*, 3> kSizeNames = {"small", "medium", "large"};

Json bySplit(const std::array<std::uint64_t, 3>& counts) {
  Json object;
  for (std::size_t i = 0; i < counts.size(); ++i) object[kSplitNames[i]] = counts[i];
  return object;
}
std::uint64_t sum(const std::array<std::uint64_t, 3>& counts) { return counts[0] + counts[1] + counts[2]; }
double hundredths(double value) { return std::round(100.0 * value) / 100.0; }
std::string cell(std::uint64_t value) { return " " + std::to_string(value) + " |"; }

}  // namespace

void DatasetCard::addFrame(Stamp stamp, Split split, int width, int height, bool labelled) {
  ++frames_[static_cast<std::size_t>(split)];
  if (!labelled) ++unlabelled_[static_cast<std::size_t>(split)];
  image_sizes_.insert({width, height});
  if (last_) {
    longest_gap_ = std::max(longest_gap_, stamp - *last_);
    if (stamp - *last_ > kGap) ++gaps_;
  }
  if (!first_) first_ = stamp;
  last_ = stamp;
}

void DatasetCard::addBox(std::int32_t class_id, Split split, double width, double height) {
  ClassCount& count = classes_[class_id];
  const double side = std::min(width, height), area = width * height;
  const bool first = sum(count.boxes) == 0;
  count.smallest_px = first ? side : std::min(count.smallest_px, side);
  count.largest_px = std::max(count.largest_px, side);
  ++count.boxes[static_cast<std::size_t>(split)];
  ++count.sizes[area < kSmall_px2 ? 0 : area < kMedium_px2 ? 1 : 2];
}

void DatasetCard::addTemperatures(const TemperatureRange& range) {
  const double width = range.maximum_degc - range.minimum_degc;
  const bool first = with_temperature_++ == 0;
  coldest_degc_ = first ? range.minimum_degc : std::min(coldest_degc_, range.minimum_degc);
  warmest_degc_ = first ? range.maximum_degc : std::max(warmest_degc_, range.maximum_degc);
  narrowest_degc_ = first ? width : std::min(narrowest_degc_, width);
  widest_degc_ = first ? width : std::max(widest_degc_, width);
}

std::string DatasetCard::json() const {
  Json card;
  card["frames"] = bySplit(frames_);
  card["frames_without_labels"] = bySplit(unlabelled_);
  card["split_block_s"] = toSeconds(split_block_);
  card["image_sizes"] = Json::array();
  for (const auto& [width, height] : image_sizes_) card["image_sizes"].push_back({width, height});
  card["first_stamp_ns"] = first_ ? Json(*first_) : Json();
  card["last_stamp_ns"] = last_ ? Json(*last_) : Json();
  card["gaps_over_1_s"] = gaps_;
  card["longest_gap_s"] = hundredths(toSeconds(longest_gap_));
  card["classes"] = Json::object();
  for (const auto& [id, count] : classes_) {
    Json& entry = card["classes"][className(id)];
    entry = {{"id", id}, {"boxes", bySplit(count.boxes)}};
    for (std::size_t i = 0; i < 3; ++i) entry["sizes"][kSizeNames[i]] = count.sizes[i];
    entry["shorter_side_px"] = {hundredths(count.smallest_px), hundredths(count.largest_px)};
  }
  card["frames_with_temperatures"] = with_temperature_;
  if (with_temperature_ > 0) {
    card["temperature_degc"] = {hundredths(coldest_degc_), hundredths(warmest_degc_)};
    card["temperature_span_degc"] = {hundredths(narrowest_degc_), hundredths(widest_degc_)};
  }
  card["dropped"] = dropped_;
  return card.dump(1) + "\n";
}

std::string DatasetCard::markdown() const {
  std::string text =
      "# Thermal dataset\n\nLabels were carried over from detections in colour images; nobody has checked "
      "them.\n\n";
  text += "| part | frames | without labels |\n|---|---|---|\n";
  for (std::size_t i = 0; i < 3; ++i)
    text += "| " + std::string(kSplitNames[i]) + " |" + cell(frames_[i]) + cell(unlabelled_[i]) + "\n";
  text += "\nParts are whole blocks of " + fixedText(toSeconds(split_block_), 1) +
          " s. Of ten blocks seven are train, two val, one test.\n\n";
  text +=
      "| class | id | train | val | test | small | medium | large | shorter side, px |\n"
      "|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [id, count] : classes_) {
    text += "| " + className(id) + " | " + std::to_string(id) + " |";
    for (const std::uint64_t n : count.boxes) text += cell(n);
    for (const std::uint64_t n : count.sizes) text += cell(n);
    text += " " + fixedText(count.smallest_px, 1) + " to " + fixedText(count.largest_px, 1) + " |\n";
  }
  text += "\nSmall is below 32 x 32 px, large from 96 x 96 px on.\n\n";
  for (const auto& [width, height] : image_sizes_)
    text += "- Image size: " + std::to_string(width) + " x " + std::to_string(height) + " px\n";
  if (first_)
    text += "- Time: " + fixedText(toSeconds(*last_ - *first_), 1) + " s from " + std::to_string(*first_) +
            " ns\n";
  text += "- Gaps over 1 s: " + std::to_string(gaps_) + ", longest " + fixedText(toSeconds(longest_gap_), 2) +
          " s\n";
  text += "- Frames with temperatures: " + std::to_string(with_temperature_) + "\n";
  if (with_temperature_ > 0) {
    text += "- Temperatures: " + fixedText(coldest_degc_, 1) + " to " + fixedText(warmest_degc_, 1) +
            " deg C; within a frame " + fixedText(narrowest_degc_, 1) + " to " + fixedText(widest_degc_, 1) +
            " K\n";
  }
  text += "- `radiometric/`: 16 bit, value = 100 x kelvin, 0 = unknown\n\n| left out | count |\n|---|---|\n";
  for (const auto& [what, count] : dropped_) text += "| " + what + " |" + cell(count) + "\n";
  return text;
}

}  // namespace atlas
