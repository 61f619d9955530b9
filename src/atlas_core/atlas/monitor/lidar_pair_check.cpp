// SPDX-License-Identifier: MIT
#include "atlas/monitor/lidar_pair_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace atlas {
namespace {
constexpr float kHalfBand_m = 1.0F;
constexpr float kNearest_m = 2.0F, kFarthest_m = 30.0F;
constexpr float kSameSurface_m = 5.0F;  // farther apart they are two things
constexpr std::size_t kLeastBins = 15;
constexpr Duration kApart = 60 * kMillisecond;
constexpr int kLeastPairs = 5;
}  // namespace

void RangeProfile::add(const Eigen::Vector3f& p_imu) {
  if (std::abs(p_imu.z()) > kHalfBand_m) return;
  const float range_m = std::hypot(p_imu.x(), p_imu.y());
  if (range_m < kNearest_m || range_m > kFarthest_m) return;
  constexpr auto kHalfTurn = static_cast<float>(M_PI);
  const float turn = (std::atan2(p_imu.y(), p_imu.x()) + kHalfTurn) / (2.0F * kHalfTurn);
  float& nearest = ranges_m_[static_cast<std::size_t>(turn * static_cast<float>(kBins)) % kBins];
  if (nearest == 0.0F || range_m < nearest) nearest = range_m;
}

std::optional<double> RangeProfile::offset(const RangeProfile& other) const {
  std::array<float, kBins> differences;
  std::size_t count = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    if (ranges_m_[i] == 0.0F || other.ranges_m_[i] == 0.0F) continue;
    const float difference = ranges_m_[i] - other.ranges_m_[i];
    if (std::abs(difference) < kSameSurface_m) differences[count++] = difference;
  }
  if (count < kLeastBins) return std::nullopt;
  auto* const middle = differences.data() + count / 2;
  std::nth_element(differences.data(), middle, differences.data() + count);
  return *middle;
}

void LidarPairCheck::add(std::size_t lidar, Stamp stamp, const RangeProfile& profile, Findings& first,
                         Findings& second) {
  newest_.at(lidar) = Seen{stamp, profile};
  const auto& other = newest_[1 - lidar];
  if (!other || stamp - other->stamp > kApart) return;
  const auto offset = newest_[0]->profile.offset(newest_[1]->profile);
  if (!offset) return;
  if (count_ == 0) begin_ = stamp;
  sum_m_ += *offset;
  ++count_;
  if (stamp - begin_ < kSecond) return;
  if (count_ >= kLeastPairs) {
    const double mean_m = std::abs(sum_m_ / count_);
    first.measure(Anomaly::kRangeOffset, stamp, mean_m);
    second.measure(Anomaly::kRangeOffset, stamp, mean_m);
  }
  count_ = 0;
  sum_m_ = 0.0;
}

}  // namespace atlas
