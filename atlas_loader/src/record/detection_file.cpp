// SPDX-License-Identifier: MIT
#include "record/detection_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace atlas::record {
namespace {
constexpr std::int64_t kMaxFrame = std::numeric_limits<std::int32_t>::max();
constexpr double kLargestNormalized =
    1.5;  // boxes cut by the border reach a little over 1, pixels are mostly far above

bool looksLikePixels(RowFields& fields) {
  for (std::size_t i = 1; i <= 4; ++i) {
    if (std::abs(fields.number(i, "box")) > kLargestNormalized) return true;
  }
  return false;
}
}  // namespace

Detection2d parseDetection(RowFields& fields, DetectionLayout layout, const ImageSize& size) {
  Detection2d box;
  const bool top_left = layout == DetectionLayout::kTopLeft;
  if (!fields.expect(top_left ? 8 : 7)) return box;
  const bool corners = layout == DetectionLayout::kCorners;
  const double a = fields.number(1, corners ? "x1" : "x");
  const double b = fields.number(2, corners ? "y1" : "y");
  const double c = fields.number(3, corners ? "x2" : "w");
  const double d = fields.number(4, corners ? "y2" : "h");
  const double confidence =
      fields.number(5, "confidence") * (top_left ? fields.number(6, "class confidence") : 1.0);
  box.class_id = static_cast<std::int32_t>(fields.integer(top_left ? 7 : 6, "class", 0, 100'000));
  if (fields.ok() && (confidence < 0.0 || confidence > 1.0)) {
    fields.fail("confidence out of range", "field 6 (confidence): " + std::to_string(confidence));
  }
  box.confidence = confidence;
  if (!corners && fields.ok()) {
    for (const double v : {a, b, c, d}) {
      if (std::abs(v) > kLargestNormalized)
        fields.fail("box out of range",
                    "fields 2..5: " + std::to_string(v) + " in a file of normalized boxes");
    }
  }
  const double w = size.width, h = size.height;
  if (corners) {
    box.x_min = a, box.y_min = b, box.x_max = c, box.y_max = d;
  } else {
    const double x = top_left ? a : a - c / 2, y = top_left ? b : b - d / 2;
    // The left edge of the image, 0 here, is pixel -1/2: the centre of the first pixel is pixel 0.
    box.x_min = x * w - 0.5, box.y_min = y * h - 0.5;
    box.x_max = (x + c) * w - 0.5, box.y_max = (y + d) * h - 0.5;
  }
  if (fields.ok() && (box.x_max < box.x_min || box.y_max < box.y_min)) {
    fields.fail("box with a negative side", "fields 2..5: width or height below 0");
  }
  return box;
}

/// The layout that most rows have.
DetectionLayout DetectionFile::findLayout(const std::filesystem::path& path) {
  std::uint64_t eight = 0, seven = 0, pixels = 0;
  LineReader lines(path);
  while (const auto line = lines.next()) {
    if (isBlank(line->text)) continue;
    fields_.assign(*line);
    eight += fields_.size() == 8 ? 1 : 0;
    if (fields_.size() != 7) continue;
    ++seven;
    pixels += looksLikePixels(fields_) ? 1 : 0;
  }
  if (eight + seven == 0) return DetectionLayout::kCenter;
  if (eight > seven) {
    log_->note(name_ + ": layout of 8 columns, boxes by their top-left corner");
    return DetectionLayout::kTopLeft;
  }
  const bool corners = 2 * pixels > seven;
  log_->note(name_ + (corners ? ": layout of 7 columns in pixels, boxes by two corners"
                              : ": layout of 7 columns, boxes by their centre"));
  return corners ? DetectionLayout::kCorners : DetectionLayout::kCenter;
}

DetectionFile::DetectionFile(const std::filesystem::path& path, std::string name, ImageSize size,
                             std::shared_ptr<RecordLog> log)
    : lines_(path), fields_(name, ','), name_(std::move(name)), size_(size), log_(std::move(log)) {
  layout_ = findLayout(path);
  index();
}

void DetectionFile::index() {
  log_->file(name_);
  if (!lines_.opened()) log_->note(name_ + ": cannot be opened");
  bool sorted = true;
  const bool size_known = layout_ == DetectionLayout::kCorners || (size_.width > 0 && size_.height > 0);
  if (!size_known) log_->note(name_ + ": image size unknown, normalized boxes cannot be converted to pixels");
  while (const auto line = lines_.next()) {
    if (isBlank(line->text)) continue;
    ++log_->file(name_).rows;
    fields_.assign(*line);
    const auto frame = static_cast<std::uint32_t>(fields_.integer(0, "frame", 0, kMaxFrame));
    parseDetection(fields_, layout_, size_);
    if (fields_.ok() && !size_known) fields_.fail("image size unknown", "box is normalized");
    if (!fields_.ok()) {
      log_->skip(name_, fields_.reason(), fields_.example());
      continue;
    }
    sorted = sorted && (entries_.empty() || entries_.back().frame <= frame);
    entries_.push_back({line->offset, frame, static_cast<std::uint32_t>(line->number)});
  }
  if (!sorted) log_->note(name_ + ": rows not in order of frames, sorted");
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return std::make_pair(a.frame, a.offset) < std::make_pair(b.frame, b.offset);
  });
}

void DetectionFile::account(const FrameTable& table, const TimeSpan& span) {
  for (const Entry& entry : entries_) {
    const FrameRow* row = table.find(entry.frame);
    if (!row) {
      log_->skip(name_, "frame without a row in timestamps.txt or without a picture",
                 name_ + ":" + std::to_string(entry.line) + ": field 1 (frame): no such frame: '" +
                     std::to_string(entry.frame) + "'");
    } else if (!span.contains(row->stamp)) {
      log_->skip(name_, kOutsideSpan);
    } else {
      ++log_->file(name_).used;
    }
  }
}

std::vector<Detection2d> DetectionFile::boxes(std::uint32_t frame) {
  std::vector<Detection2d> boxes;
  auto it = std::lower_bound(entries_.begin(), entries_.end(), frame,
                             [](const Entry& entry, std::uint32_t wanted) { return entry.frame < wanted; });
  for (; it != entries_.end() && it->frame == frame; ++it) {
    lines_.seek(it->offset, it->line);
    const auto line = lines_.next();
    if (!line) break;
    fields_.assign(*line);
    const Detection2d box = parseDetection(fields_, layout_, size_);
    if (fields_.ok()) boxes.push_back(box);
  }
  return boxes;
}

}  // namespace atlas::record
