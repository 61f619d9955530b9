// SPDX-License-Identifier: MIT
// Does the accelerometer point up at rest (REP-145) or down? The Brno Urban Dataset stores it with inverted
// sign
// ("Known bugs" of its README) and nobody says whether all sessions do, so the file's own samples decide.
#pragma once

#include <filesystem>
#include <string>

namespace atlas::record {

struct GravityVerdict {
  enum class Sign { kUp, kInverted, kUndecided };
  Sign sign = Sign::kUndecided;
  double median_up_mps2 = 0;  ///< median of the vertical component (R_enu_imu * a).z
  std::size_t samples = 0;
};

/// Looks at the first `max_samples` good rows of imu/imu.txt (1 min at 400 Hz). Driving averages out in the
/// median: the sign is decided when |median| > g/2. A file without any usable orientation is judged by its z
/// axis, as the IMU is mounted level.
GravityVerdict testGravity(const std::filesystem::path& imu_file, std::size_t max_samples = 24000);

/// For the notes of the reader.
std::string describe(const GravityVerdict& verdict);

}  // namespace atlas::record
