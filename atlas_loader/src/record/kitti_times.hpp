// SPDX-License-Identifier: MIT
// When the frames of a KITTI raw drive were taken: timestamps.txt of the sensor, else that of the Velodyne
// (the moment at which it looks forward, which triggers the cameras), else that of OXTS minus 17 ms.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>

#include "record/kitti_files.hpp"
#include "record/record_log.hpp"

namespace atlas::record {

using KittiStamps = std::map<std::uint32_t, Stamp>;  ///< by frame number

class KittiTimes {
 public:
  KittiTimes(const KittiFiles& files, std::shared_ptr<RecordLog> log) : files_(files), log_(std::move(log)) {}

  struct Frames {
    KittiStamps stamps;
    std::string
        file;  ///< "image_02/timestamps.txt" when they are the sensor's own, whose rows the caller books
  };
  /// Of a sensor whose frames have these numbers.
  Frames of(const std::string& sensor, const std::set<std::uint32_t>& indices);
  /// Stamps of <sensor>/<file>, read once; without those more than a day away. Empty when there is no such
  /// file.
  const KittiStamps& read(const std::string& sensor, const std::string& file = "timestamps.txt");
  /// The rows of <sensor>/timestamps.txt are booked by the caller.
  void leaveToCaller(const std::string& sensor) { left_.insert(sensor + "/timestamps.txt"); }
  /// Books the good rows of all files that were read and not left to the caller as used.
  void book();

 private:
  const KittiFiles& files_;
  std::shared_ptr<RecordLog> log_;
  std::map<std::string, KittiStamps> read_;  ///< by "<sensor>/<file>"
  std::set<std::string> left_;
};

}  // namespace atlas::record
