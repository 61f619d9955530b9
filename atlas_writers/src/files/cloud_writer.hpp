// SPDX-License-Identifier: MIT
// De-skewed sweeps: deskewed/<lidar>/<scan index, 6 digits>.pcd with the points in `map`, in the order of the
// input scan, NaN where there was no return.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "atlas/sensor/products.hpp"

namespace atlas {

class CloudWriter {
 public:
  /// out: the run's output folder.
  explicit CloudWriter(std::filesystem::path out) : out_(std::move(out)) {}
  /// `index` counts the sweeps of this lidar. A sweep without pose has no place in map: false, and no file.
  bool write(const std::string& lidar, std::uint32_t index, const BatchedSweep& batched);

 private:
  std::filesystem::path out_;
};

}  // namespace atlas
