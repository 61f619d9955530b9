// SPDX-License-Identifier: MIT
// The thermal dataset: images, YOLO labels, COCO annotations, the detections' own row format, a split by
// blocks of time. Only thermal frames that some RGB image chose are part of it. thermal/{images,labels}/<IR
// index, 6 digits>.{png,txt}, thermal/annotations.json, thermal/detections.txt, thermal/train.txt,
// thermal/val.txt
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "atlas/sensor/products.hpp"
#include "files/output_file.hpp"

namespace atlas {

class ThermalWriter {
 public:
  explicit ThermalWriter(std::filesystem::path out);

  /// Parts of one frame are joined by their equal stamps; each comes in stamp order.
  void add(const TemperatureRange& range);
  void add(const ImagePtr& image);
  void add(const ProjectedDetections& projected);
  /// Completes annotations and lists; nothing happens a second time.
  void close();
  /// Chosen frames whose picture never came.
  [[nodiscard]] std::uint64_t withoutImage() const { return without_image_; }

 private:
  struct Frame {
    std::optional<TemperatureRange> range;
    ImagePtr image;
    std::optional<ProjectedDetections> projected;
  };
  void writeComplete();
  void write(const Frame& frame);

  std::filesystem::path folder_;
  std::map<Stamp, Frame> waiting_;
  std::unique_ptr<OutputFile> rows_;
  std::unique_ptr<OutputFile> train_, val_;
  std::string coco_images_, coco_annotations_;  ///< about 150 bytes a label: 10 MB an hour
  std::uint64_t next_annotation_ = 1;
  std::uint64_t without_image_ = 0;
  bool closed_ = false;
};

}  // namespace atlas
