// SPDX-License-Identifier: MIT
#include "record/kitti_frames.hpp"

#include <algorithm>

#include "record/kitti_files.hpp"

namespace atlas::record {

KittiFrames::KittiFrames(const std::string& sensor, const std::filesystem::path& folder,
                         const std::vector<std::string>& extensions, std::shared_ptr<RecordLog> log)
    : sensor_(sensor), name_(sensor + "/data"), log_(std::move(log)) {
  for (auto& [index, paths] : kittiFrameFiles(folder / "data", extensions)) {
    files_[index] = paths.front();
    indices_.insert(index);
    repeated_ += paths.size() - 1;
  }
}

const std::filesystem::path* KittiFrames::find(std::uint32_t index) const {
  const auto it = files_.find(index);
  return it == files_.end() ? nullptr : &it->second;
}

void KittiFrames::bookSkipped(std::uint32_t index, const std::string& reason,
                              const std::string& detail) const {
  const std::filesystem::path* path = find(index);
  const std::string file = path ? path->filename().string() : kittiFileName(index, "");
  log_->skip(name_, reason, name_ + "/" + file + ": " + detail);
}

void KittiFrames::bookStampless(const KittiStamps& stamps) const {
  log_->file(name_).rows += repeated_;
  log_->skip(name_, "frame is there twice", "", repeated_);
  for (const auto& [index, path] : files_) {
    if (stamps.count(index) > 0) continue;
    ++log_->file(name_).rows;
    bookSkipped(index, "no stamp for this frame", "no stamp");
  }
}

void KittiFrames::bookOutside(const FrameTable& table, const TimeSpan& span) const {
  for (const FrameRow& row : table.rows()) {
    if (span.contains(row.stamp)) continue;
    ++log_->file(name_).rows;
    log_->skip(name_, kOutsideSpan);
  }
}

std::optional<std::string> KittiFrames::read(std::uint32_t index) const {
  ++log_->file(name_).rows;
  const std::filesystem::path* path = find(index);
  auto bytes = path ? readWholeFile(*path) : std::nullopt;
  if (!bytes) bookSkipped(index, path ? "file unreadable" : "file missing", path ? "unreadable" : "missing");
  return bytes;
}

}  // namespace atlas::record
