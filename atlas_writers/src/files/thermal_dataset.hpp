// SPDX-License-Identifier: MIT
// The files of a dataset of labelled thermal images, frame by frame: what an hour of driving leaves in memory
// is a few numbers and the contact sheet.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "atlas/output/coco.hpp"
#include "atlas/output/contact_sheet.hpp"
#include "atlas/output/dataset_card.hpp"
#include "atlas/sensor/sensor.hpp"
#include "files/output_file.hpp"
#include "files/text_spool.hpp"

namespace atlas {

struct ThermalDatasetParams {
  bool radiometric = true;      ///< also 16-bit images, where the temperatures of a frame are known
  double split_block_s = 10.0;  ///< event time that goes to one part as a whole
  int contact_sheet_frames = 16;
  int contact_sheet_seed = 1;
};
/// Throws std::invalid_argument naming the parameter.
void validate(const ThermalDatasetParams& params);

class ThermalDataset {
 public:
  /// `folder`: .../thermal. No file is made before the first frame.
  ThermalDataset(const ThermalDatasetParams& params, std::filesystem::path folder);

  /// 8-bit pixels and their labels; frames come in order of time and of their image_index. What cannot be
  /// used is counted in dropped(), in words.
  void add(const cv::Mat& pixels, const Detections& labels, const std::optional<TemperatureRange>& range);
  void drop(const std::string& what) { card_.drop(what); }
  /// Completes all files; without any frame there are none. Call once.
  void close();

  [[nodiscard]] const std::map<std::string, std::uint64_t>& dropped() const { return card_.dropped(); }
  [[nodiscard]] std::uint64_t frames() const { return card_.frames(); }

 private:
  void open();
  [[nodiscard]] bool usable(const cv::Mat& pixels, const Detections& labels);
  Detections checked(const Detections& labels, const cv::Mat& pixels, Split split);
  void writeRadiometric(const cv::Mat& pixels, const std::string& name,
                        const std::optional<TemperatureRange>& range);
  void annotate(const CocoImage& image, const Detections& labels);

  ThermalDatasetParams params_;
  std::filesystem::path folder_;
  DatasetCard card_;
  ContactSheet sheet_;
  std::unique_ptr<OutputFile> coco_, rows_;
  std::unique_ptr<TextSpool> annotations_;
  std::array<std::unique_ptr<OutputFile>, 3> lists_;  ///< by split
  std::uint64_t next_annotation_ = 1;
  std::optional<std::uint32_t> last_index_;
};

}  // namespace atlas
