// SPDX-License-Identifier: MIT
#include "record/gravity_test.hpp"

#include <algorithm>
#include <vector>

#include "record/bud_rows.hpp"

namespace atlas::record {

GravityVerdict testGravity(const std::filesystem::path& imu_file, std::size_t max_samples) {
  LineReader lines(imu_file);
  RowFields fields("imu/imu.txt", ',');
  std::vector<double> up, along_z;
  while (up.size() + along_z.size() < max_samples) {
    const auto line = lines.next();
    if (!line) break;
    fields.assign(*line);
    const ImuSample sample = parseImu(fields, BudRowOptions{});
    if (!fields.ok()) continue;
    if (sample.orientation) up.push_back((*sample.orientation * sample.linear_acceleration_mps2).z());
    if (!sample.orientation) along_z.push_back(sample.linear_acceleration_mps2.z());
  }
  if (up.empty()) up = std::move(along_z);
  GravityVerdict verdict;
  verdict.samples = up.size();
  if (up.empty()) return verdict;
  const auto middle = up.begin() + static_cast<std::ptrdiff_t>(up.size() / 2);
  std::nth_element(up.begin(), middle, up.end());
  verdict.median_up_mps2 = *middle;
  constexpr double kHalfGravity = 4.9;  // m/s^2
  if (*middle > kHalfGravity) verdict.sign = GravityVerdict::Sign::kUp;
  if (*middle < -kHalfGravity) verdict.sign = GravityVerdict::Sign::kInverted;
  return verdict;
}

std::string describe(const GravityVerdict& verdict) {
  char number[32];
  std::snprintf(number, sizeof(number), "%.3f", verdict.median_up_mps2);
  const std::string facts = std::string(" (median vertical component ") + number + " m/s^2 over " +
                            std::to_string(verdict.samples) + " samples)";
  switch (verdict.sign) {
    case GravityVerdict::Sign::kUp:
      return "imu: acceleration points up at rest, kept as recorded" + facts;
    case GravityVerdict::Sign::kInverted:
      return "imu: acceleration sign inverted, corrected" + facts;
    case GravityVerdict::Sign::kUndecided:
      break;
  }
  return "imu: sign of acceleration undecided, kept as recorded" + facts;
}

}  // namespace atlas::record
