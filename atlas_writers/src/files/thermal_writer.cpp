// SPDX-License-Identifier: MIT
#include "files/thermal_writer.hpp"

#include <utility>

namespace atlas {
namespace {

constexpr std::size_t kMostWaiting = 256;  // frames; 30 Hz, so parts may be eight seconds apart

}  // namespace

ThermalWriter::ThermalWriter(const ThermalDatasetParams& params, const std::filesystem::path& out)
    : dataset_(params, out / "thermal") {}

void ThermalWriter::add(const TemperatureRange& range) {
  waiting_[range.stamp].range = range;
  writeComplete();
}
void ThermalWriter::add(const ImagePtr& image) {
  waiting_[image->stamp].image = image;
  writeComplete();
}
void ThermalWriter::add(const CameraInfo& info) {
  if (info.width > 0 && info.height > 0)
    waiting_[info.stamp].size = cv::Size(static_cast<int>(info.width), static_cast<int>(info.height));
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
    write(frame);
  }
}

void ThermalWriter::write(const Frame& frame) {
  if (!frame.projected) {
    if (frame.image) dataset_.drop("frame: no answer of the projection");
    return;
  }
  if (!frame.projected->selected) {
    dataset_.drop("frame: no RGB image near it");
  } else if (!frame.image) {
    dataset_.drop("frame: no picture");
  } else if (frame.size && !frame.image->pixels.empty() && *frame.size != frame.image->pixels.size()) {
    dataset_.drop("frame: picture has another size than its camera_info");  // labels are for the latter
  } else {
    dataset_.add(frame.image->pixels, frame.projected->detections, frame.range);
  }
}

void ThermalWriter::close() {
  if (closed_) return;
  closed_ = true;
  while (!waiting_.empty()) {
    const Frame frame = std::move(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
    write(frame);
  }
  dataset_.close();
}

}  // namespace atlas
