// SPDX-License-Identifier: MIT
#include "atlas/output/coco.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "atlas/output/coco_names.hpp"
#include "atlas/output/yolo.hpp"

namespace atlas {
namespace {

using nlohmann::json;

// A thousandth of a pixel: what is behind it is rounding.
double rounded(double pixels) { return std::round(pixels * 1000.0) / 1000.0; }

}  // namespace

std::string cocoBegin(const std::string& description) {
  json categories = json::array();
  for (std::size_t i = 0; i < cocoNames().size(); ++i)
    categories.push_back({{"id", i}, {"name", cocoNames()[i]}});
  return "{\"info\":" + json{{"description", description}}.dump() + ",\n\"categories\":" + categories.dump() +
         ",\n\"images\":[\n";
}

std::string cocoImage(const CocoImage& image) {
  json entry = {{"id", image.id},
                {"file_name", image.file_name},
                {"width", image.width},
                {"height", image.height},
                {"stamp_ns", image.stamp}};
  if (!image.split.empty()) entry["split"] = image.split;
  if (image.temperature) {
    entry["temperature_min_degc"] = image.temperature->minimum_degc;
    entry["temperature_max_degc"] = image.temperature->maximum_degc;
  }
  return entry.dump();
}

std::string cocoMiddle() { return "\n],\n\"annotations\":[\n"; }

std::optional<std::string> cocoAnnotation(std::uint64_t id, const CocoImage& image,
                                          const Detection2d& detection) {
  const auto box = normalized(detection, image.width, image.height);
  if (!box) return std::nullopt;
  // Edges are rounded, not sizes: a box that ends with the image still does.
  const double x = rounded((box->center_x - 0.5 * box->width) * image.width);
  const double y = rounded((box->center_y - 0.5 * box->height) * image.height);
  const double width = rounded(rounded((box->center_x + 0.5 * box->width) * image.width) - x);
  const double height = rounded(rounded((box->center_y + 0.5 * box->height) * image.height) - y);
  const json entry = {{"id", id},
                      {"image_id", image.id},
                      {"category_id", detection.class_id},
                      {"bbox", {x, y, width, height}},
                      {"area", rounded(width * height)},
                      {"iscrowd", 0},
                      {"score", detection.confidence}};
  return entry.dump();
}

std::string cocoEnd() { return "\n]}\n"; }

}  // namespace atlas
