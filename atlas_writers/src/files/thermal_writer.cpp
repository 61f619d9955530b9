// SPDX-License-Identifier: MIT
#include "files/thermal_writer.hpp"

#include <cstdio>
#include <utility>

#include "atlas/output/coco.hpp"
#include "atlas/output/depth_png.hpp"
#include "atlas/output/detections_csv.hpp"
#include "atlas/output/yolo.hpp"

namespace atlas {
namespace {

constexpr std::size_t kMostWaiting = 256;  // frames; 30 Hz, so parts may be eight seconds apart
constexpr Duration kSplitBlock =
    10 * kSecond;                      // neighbouring frames look alike: never one in train, the next in val
constexpr std::int64_t kValEvery = 5;  // every fifth block

std::string numbered(std::uint32_t index, const char* ending) {
  char name[32];
  std::snprintf(name, sizeof name, "%06u.%s", index, ending);
  return name;
}

}  // namespace

ThermalWriter::ThermalWriter(std::filesystem::path out) : folder_(std::move(out) / "thermal") {}

void ThermalWriter::add(const TemperatureRange& range) {
  waiting_[range.stamp].range = range;
  writeComplete();
}
void ThermalWriter::add(const ImagePtr& image) {
  waiting_[image->stamp].image = image;
  writeComplete();
}
void ThermalWriter::add(const ProjectedDetections& projected) {
  waiting_[projected.detections.stamp].projected = projected;
  writeComplete();
}

void ThermalWriter::writeComplete() {
  while (!waiting_.empty()) {
    const auto first = waiting_.begin();
    const bool complete = first->second.image != nullptr && first->second.projected.has_value();
    if (!complete && waiting_.size() <= kMostWaiting) return;
    const Frame frame = std::move(first->second);
    waiting_.erase(first);
    if (frame.projected && frame.projected->selected) write(frame);
  }
}

void ThermalWriter::write(const Frame& frame) {
  if (!frame.image || frame.image->pixels.empty()) {
    ++without_image_;
    return;
  }
  const Detections& detections = frame.projected->detections;
  const cv::Mat& pixels = frame.image->pixels;
  const std::string name = numbered(detections.image_index, "png");
  const std::vector<std::uint8_t> png = encodePng(pixels);
  OutputFile image(folder_ / "images" / name);
  image.write(png.data(), png.size());
  image.commit();
  writeFile(folder_ / "labels" / numbered(detections.image_index, "txt"),
            yoloLabels(detections, pixels.cols, pixels.rows));
  if (!rows_) {
    rows_ = std::make_unique<OutputFile>(folder_ / "detections.txt");
    train_ = std::make_unique<OutputFile>(folder_ / "train.txt");
    val_ = std::make_unique<OutputFile>(folder_ / "val.txt");
  }
  rows_->write(detectionRows(detections, pixels.cols, pixels.rows));
  const bool is_val = (detections.stamp / kSplitBlock) % kValEvery == 0;
  (is_val ? val_ : train_)->write("images/" + name + "\n");
  const CocoImage coco{detections.image_index, "images/" + name, pixels.cols, pixels.rows,
                       detections.stamp,       frame.range};
  coco_images_ += (coco_images_.empty() ? "" : ",\n") + cocoImage(coco);
  for (const Detection2d& box : detections.boxes) {
    const auto annotation = cocoAnnotation(next_annotation_, coco, box);
    if (!annotation) continue;
    ++next_annotation_;
    coco_annotations_ += (coco_annotations_.empty() ? "" : ",\n") + *annotation;
  }
}

void ThermalWriter::close() {
  if (closed_) return;
  closed_ = true;
  while (!waiting_.empty()) {
    const Frame frame = std::move(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    if (frame.projected && frame.projected->selected) write(frame);
  }
  if (!rows_) return;  // no frame was chosen: no dataset
  rows_->commit();
  train_->commit();
  val_->commit();
  writeFile(folder_ / "annotations.json", cocoBegin("Thermal images with labels moved from RGB detections") +
                                              coco_images_ + cocoMiddle() + coco_annotations_ + cocoEnd());
}

}  // namespace atlas
