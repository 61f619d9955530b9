// SPDX-License-Identifier: MIT
// yolo/camera_<name>.txt in its three layouts. Rows are indexed by frame when the file is opened (they need
// not be in order) and read from the file when their frame is due: memory is 16 bytes a row.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "record/frame_table.hpp"

namespace atlas::record {

enum class DetectionLayout {
  kTopLeft,  ///< A: frame, x, y, w, h, det_conf, class_conf, class; normalized, (x, y) = top-left corner
  kCenter,   ///< B: frame, x, y, w, h, conf, class; normalized, (x, y) = centre
  kCorners   ///< C: frame, x1, y1, x2, y2, conf, class; pixels
};

struct ImageSize {
  std::uint32_t width = 0, height = 0;  ///< px; 0 = unknown
};

class DetectionFile {
 public:
  DetectionFile(const std::filesystem::path& path, std::string name, ImageSize size,
                std::shared_ptr<RecordLog> log);
  /// Books every row: used when its frame is in `table` and inside `span`.
  void account(const FrameTable& table, const TimeSpan& span);
  /// Boxes of a frame in the order of the file, pixels.
  std::vector<Detection2d> boxes(std::uint32_t frame);
  [[nodiscard]] DetectionLayout layout() const { return layout_; }

 private:
  struct Entry {
    std::uint64_t offset;
    std::uint32_t frame;
    std::uint32_t line;
  };
  DetectionLayout findLayout(const std::filesystem::path& path);
  void index();

  LineReader lines_;
  RowFields fields_;
  std::string name_;
  ImageSize size_;
  std::shared_ptr<RecordLog> log_;
  DetectionLayout layout_ = DetectionLayout::kCenter;
  std::vector<Entry> entries_;  ///< by (frame, offset)
};

/// One row in a known layout; confidence of layout A is det_conf * class_conf (YOLOv3: P(object) * P(class |
/// object)).
Detection2d parseDetection(RowFields& fields, DetectionLayout layout, const ImageSize& size);

}  // namespace atlas::record
