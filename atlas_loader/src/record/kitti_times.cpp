// SPDX-License-Identifier: MIT
#include "record/kitti_times.hpp"

#include "record/kitti_rows.hpp"
#include "record/stamp_outlier.hpp"

namespace atlas::record {
namespace {
/// drive_0057, whose Velodyne stamps are known, has its OXTS stamps 11.7 .. 25.0 ms (mean 17.2 ms) after the
/// moment at which the lidar looks forward and the cameras are triggered.
constexpr Duration kOxtsDelay = 17 * kMillisecond;

void dropOutliers(const std::string& name, KittiStamps& stamps, RecordLog& log) {
  std::vector<Stamp> all;
  for (const auto& [index, stamp] : stamps) all.push_back(stamp);
  const auto typical = typicalStamp(std::move(all));
  for (auto it = stamps.begin(); it != stamps.end();) {
    if (!isOutlier(it->second, typical)) {
      ++it;
      continue;
    }
    log.skip(name, kOutlier,
             name + ":" + std::to_string(it->first + 1) + ": field 1 (stamp): far from the others");
    it = stamps.erase(it);
  }
}
}  // namespace

const KittiStamps& KittiTimes::read(const std::string& sensor, const std::string& file) {
  const std::string name = sensor + "/" + file;
  const auto [place, first] = read_.try_emplace(name);
  const std::filesystem::path folder = files_.sensor(sensor);
  std::error_code error;
  if (!first || folder.empty() || !std::filesystem::exists(folder / file, error)) return place->second;
  log_->file(name);
  place->second = readKittiStamps(folder / file, name, *log_);
  dropOutliers(name, place->second, *log_);
  if (place->second.empty()) log_->note(name + ": no usable rows");
  return place->second;
}

KittiTimes::Frames KittiTimes::of(const std::string& sensor, const std::set<std::uint32_t>& indices) {
  const KittiStamps& own = read(sensor);
  if (!own.empty()) {
    leaveToCaller(sensor);
    return {own, sensor + "/timestamps.txt"};
  }
  Frames frames;
  const KittiStamps& velodyne = read("velodyne_points");
  const KittiStamps& oxts = read("oxts");
  for (const std::uint32_t index : indices) {
    const auto forward = velodyne.find(index);
    const auto later = oxts.find(index);
    if (forward != velodyne.end()) {
      frames.stamps[index] = forward->second;
    } else if (later != oxts.end()) {
      frames.stamps[index] = later->second - kOxtsDelay;
    }
  }
  if (!frames.stamps.empty())
    log_->note(sensor + ": no timestamps.txt, times from those of the lidar or of OXTS - 17 ms");
  return frames;
}

void KittiTimes::book() {
  for (const auto& [name, stamps] : read_) {
    if (!stamps.empty() && left_.count(name) == 0) log_->file(name).used = stamps.size();
  }
}

}  // namespace atlas::record
