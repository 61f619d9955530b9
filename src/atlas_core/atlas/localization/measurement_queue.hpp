// SPDX-License-Identifier: MIT
// Fixes, headings and heights that wait for the IMU sample at or after them, in stamp order. A ring of fixed
// size: a filter must not allocate while it runs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <variant>

#include "atlas/base/time.hpp"

namespace atlas {

class MeasurementQueue {
 public:
  struct Fix {
    Eigen::Vector3d p_map_antenna;
    Eigen::Matrix3d R_m2;
  };
  struct Heading {
    double yaw_rad, variance;
  };
  struct Height {
    double z_map_m, variance;
  };
  struct Entry {
    Stamp stamp = 0;
    std::variant<Fix, Heading, Height> measurement;
    [[nodiscard]] bool isFix() const { return std::holds_alternative<Fix>(measurement); }
    [[nodiscard]] bool isHeight() const { return std::holds_alternative<Height>(measurement); }
  };

  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] bool full() const { return count_ == kCapacity; }
  [[nodiscard]] const Entry& front() const { return entries_[first_]; }
  void pop() {
    first_ = (first_ + 1) % kCapacity;
    --count_;
  }
  /// Only when not full.
  void push(const Entry& entry) {
    entries_[(first_ + count_) % kCapacity] = entry;
    ++count_;
  }

 private:
  static constexpr std::size_t kCapacity = 256;  // 6 s of 20 Hz fixes and headings without an IMU sample
  std::array<Entry, kCapacity> entries_;
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace atlas
