// SPDX-License-Identifier: MIT
// The files of a sensor of a KITTI raw drive, one a frame, and what becomes of each.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "record/frame_table.hpp"
#include "record/kitti_times.hpp"

namespace atlas::record {

class KittiFrames {
 public:
  /// Files of `folder`/data with one of the extensions. Reports go to "<sensor>/data".
  KittiFrames(const std::string& sensor, const std::filesystem::path& folder,
              const std::vector<std::string>& extensions, std::shared_ptr<RecordLog> log);

  [[nodiscard]] const std::set<std::uint32_t>& indices() const { return indices_; }
  /// Path of a frame's file; nullptr when it is missing.
  [[nodiscard]] const std::filesystem::path* find(std::uint32_t index) const;
  /// Books the files that no row of `stamps` asks for.
  void bookStampless(const KittiStamps& stamps) const;
  /// Books the frames of `table` outside of `span`.
  void bookOutside(const FrameTable& table, const TimeSpan& span) const;
  /// Books a frame and reads its file; nullopt, and booked why, when it is missing or unreadable.
  [[nodiscard]] std::optional<std::string> read(std::uint32_t index) const;
  void bookUsed() const { ++log_->file(name_).used; }
  void bookSkipped(std::uint32_t index, const std::string& reason, const std::string& detail) const;
  [[nodiscard]] const std::string& sensor() const { return sensor_; }

 private:
  std::string sensor_, name_;
  std::shared_ptr<RecordLog> log_;
  std::map<std::uint32_t, std::filesystem::path> files_;
  std::set<std::uint32_t> indices_;
  std::uint64_t repeated_ = 0;
};

}  // namespace atlas::record
