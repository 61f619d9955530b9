// SPDX-License-Identifier: MIT
#include "files/depth_writer.hpp"

#include <cstdio>
#include <stdexcept>
#include <utility>

#include "atlas/output/depth_png.hpp"
#include "files/png_file.hpp"

namespace atlas {
namespace {

constexpr double kPreviewRange = 60.0;  // m, darkest grey of the preview

}  // namespace

DepthWriter::DepthWriter(std::filesystem::path out, int preview_period)
    : out_(std::move(out)), preview_period_(preview_period) {
  if (preview_period < 0) {
    throw std::invalid_argument("depth_writer: preview_period must not be negative, got " +
                                std::to_string(preview_period));
  }
}

void DepthWriter::write(const std::string& camera, std::uint32_t index, const cv::Mat& depth_m) {
  char name[32];
  std::snprintf(name, sizeof name, "%06u.png", index);
  const std::filesystem::path folder = out_ / "depth" / camera;
  writePng(folder / name, depthTo16Bit(depth_m));
  if (preview_period_ > 0 && index % static_cast<std::uint32_t>(preview_period_) == 0) {
    writePng(folder / "preview" / name, depthPreview(depth_m, kPreviewRange));
  }
}

}  // namespace atlas
