// SPDX-License-Identifier: MIT
#include "files/thermal_dataset.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "atlas/output/coco_names.hpp"
#include "atlas/output/detections_csv.hpp"
#include "atlas/output/fixed_text.hpp"
#include "atlas/output/label_check.hpp"
#include "atlas/output/radiometric_png.hpp"
#include "atlas/output/yolo.hpp"
#include "files/png_file.hpp"

namespace atlas {
namespace {

namespace fs = std::filesystem;

std::string numbered(std::uint32_t index, const char* ending) {
  char name[32];
  std::snprintf(name, sizeof name, "%06u.%s", index, ending);
  return name;
}

/// What the usual YOLO trainers are pointed at.
std::string dataYaml() {
  std::string text = "# Ultralytics' format: give this file to the trainer.\npath: .\n";
  for (const char* split : kSplitNames) text += std::string(split) + ": " + split + ".txt\n";
  text += "names:\n";
  for (std::size_t i = 0; i < cocoNames().size(); ++i)
    text += "  " + std::to_string(i) + ": " + cocoNames()[i] + "\n";
  return text;
}

}  // namespace

void validate(const ThermalDatasetParams& params) {
  if (!(params.split_block_s >= 1.0 && params.split_block_s <= 86400.0)) {
    throw std::invalid_argument("thermal_writer: split_block_s must be 1 to 86400, got " +
                                fixedText(params.split_block_s, 3));
  }
  if (params.contact_sheet_frames < 1 || params.contact_sheet_frames > 100) {
    throw std::invalid_argument("thermal_writer: contact_sheet_frames must be 1 to 100, got " +
                                std::to_string(params.contact_sheet_frames));
  }
}

ThermalDataset::ThermalDataset(const ThermalDatasetParams& params, fs::path folder)
    : params_(params),
      folder_(std::move(folder)),
      card_(fromSeconds(params.split_block_s)),
      sheet_(params.contact_sheet_frames, static_cast<std::uint64_t>(params.contact_sheet_seed)) {}

void ThermalDataset::open() {
  coco_ = std::make_unique<OutputFile>(folder_ / "annotations.json");
  coco_->write(cocoBegin("Thermal images with labels moved from RGB detections"));
  rows_ = std::make_unique<OutputFile>(folder_ / "detections.txt");
  annotations_ = std::make_unique<TextSpool>(folder_);
  for (std::size_t i = 0; i < lists_.size(); ++i)
    lists_[i] = std::make_unique<OutputFile>(folder_ / (std::string(kSplitNames[i]) + ".txt"));
}

bool ThermalDataset::usable(const cv::Mat& pixels, const Detections& labels) {
  if (pixels.empty()) {
    card_.drop("frame: no picture");
  } else if (pixels.type() != CV_8UC1 && pixels.type() != CV_8UC3) {
    card_.drop("frame: picture is not 8 bit");
  } else if (last_index_ && labels.image_index <= *last_index_) {
    card_.drop("frame: number not after the one before");  // its files would replace those of another frame
  } else {
    return true;
  }
  return false;
}

Detections ThermalDataset::checked(const Detections& labels, const cv::Mat& pixels, Split split) {
  Detections good = labels;
  good.boxes.clear();
  for (const Detection2d& box : labels.boxes) {
    if (const char* why = whyNoLabel(box, pixels.cols, pixels.rows)) {
      card_.drop(std::string("label: ") + why);
      continue;
    }
    const auto shares = normalized(box, pixels.cols, pixels.rows);
    card_.addBox(box.class_id, split, shares->width * pixels.cols, shares->height * pixels.rows);
    good.boxes.push_back(box);
  }
  return good;
}

void ThermalDataset::add(const cv::Mat& pixels, const Detections& labels,
                         const std::optional<TemperatureRange>& range) {
  if (!usable(pixels, labels)) return;
  if (!coco_) open();
  last_index_ = labels.image_index;
  const Split split = splitOf(labels.stamp, fromSeconds(params_.split_block_s));
  const Detections good = checked(labels, pixels, split);
  card_.addFrame(labels.stamp, split, pixels.cols, pixels.rows, !good.boxes.empty());
  const std::string name = numbered(labels.image_index, "png");
  writePng(folder_ / "images" / name, pixels);
  writeFile(folder_ / "labels" / numbered(labels.image_index, "txt"),
            yoloLabels(good, pixels.cols, pixels.rows));
  if (params_.radiometric) writeRadiometric(pixels, name, range);
  rows_->write(detectionRows(good, pixels.cols, pixels.rows));
  lists_[static_cast<std::size_t>(split)]->write("./images/" + name + "\n");  // "./": beside the list
  annotate(
      {labels.image_index, "images/" + name, pixels.cols, pixels.rows, labels.stamp, range, nameOf(split)},
      good);
  if (!good.boxes.empty()) sheet_.offer(pixels, good, name + "  " + nameOf(split));
}

void ThermalDataset::writeRadiometric(const cv::Mat& pixels, const std::string& name,
                                      const std::optional<TemperatureRange>& range) {
  if (!range) {
    card_.drop("temperatures: none for the frame");
    return;
  }
  const auto values = radiometric(pixels, *range);
  if (!values) {
    card_.drop(std::string("temperatures: ") + toString(values.reason()));
    return;
  }
  card_.addTemperatures(*range);
  writePng(folder_ / "radiometric" / name, *values);
}

void ThermalDataset::annotate(const CocoImage& image, const Detections& labels) {
  if (card_.frames() > 1) coco_->write(",\n");
  coco_->write(cocoImage(image));
  for (const Detection2d& box : labels.boxes) {
    const auto annotation = cocoAnnotation(next_annotation_, image, box);
    if (!annotation) continue;
    if (next_annotation_++ > 1) annotations_->append(",\n");
    annotations_->append(*annotation);
  }
}

void ThermalDataset::close() {
  if (!coco_) return;
  rows_->commit();
  for (const auto& list : lists_) list->commit();
  coco_->write(cocoMiddle());
  annotations_->copyTo(*coco_);
  coco_->write(cocoEnd());
  coco_->commit();
  writeFile(folder_ / "data.yaml", dataYaml());
  writeFile(folder_ / "card.json", card_.json());
  writeFile(folder_ / "README.md", card_.markdown());
  const cv::Mat sheet = sheet_.draw();
  if (!sheet.empty()) writePng(folder_ / "contact_sheet.png", sheet);
}

}  // namespace atlas
