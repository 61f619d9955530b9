// SPDX-License-Identifier: MIT
// The thermal dataset: images, YOLO labels, COCO annotations, the detections' own row format, a split by
// blocks of time, 16-bit temperatures, a contact sheet, a card. Only thermal frames that some RGB image chose
// are part of it. Below thermal/: {images,labels,radiometric}/<IR index, 6 digits>.{png,txt,png},
// annotations.json, detections.txt, {train,val,test}.txt, data.yaml, card.json, README.md, contact_sheet.png
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "atlas/sensor/products.hpp"
#include "files/thermal_dataset.hpp"

namespace atlas {

class ThermalWriter {
 public:
  ThermalWriter(const ThermalDatasetParams& params, const std::filesystem::path& out);

  /// Parts of one frame are joined by their equal stamps; each comes in stamp order.
  void add(const TemperatureRange& range);
  void add(const ImagePtr& image);
  void add(const CameraInfo& info);
  void add(const ProjectedDetections& projected);
  /// Completes annotations and lists; nothing happens a second time.
  void close();
  /// What was left out of the dataset, in words.
  [[nodiscard]] const std::map<std::string, std::uint64_t>& dropped() const { return dataset_.dropped(); }
  [[nodiscard]] std::uint64_t frames() const { return dataset_.frames(); }

 private:
  struct Frame {
    std::optional<TemperatureRange> range;
    ImagePtr image;
    std::optional<cv::Size> size;  ///< that its labels were made for
    std::optional<ProjectedDetections> projected;
  };
  void writeComplete();
  void write(const Frame& frame);

  ThermalDataset dataset_;
  std::map<Stamp, Frame> waiting_;
  bool closed_ = false;
};

}  // namespace atlas
