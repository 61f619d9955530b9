// SPDX-License-Identifier: MIT
#include "atlas/localization/localization_status.hpp"

#include <algorithm>

namespace atlas {
namespace {
constexpr Duration kPeriod = kSecond;
constexpr Duration kStandingLasts = kSecond / 2;  // standing is looked for five times a second
constexpr double kJumpWithin_s = 2.0;             // after a longer silence there is nothing to compare with
}  // namespace

const char* toString(LocalizationStatus::State state) {
  switch (state) {
    case LocalizationStatus::State::kAligning:
      return "aligning";
    case LocalizationStatus::State::kRunning:
      return "running";
    case LocalizationStatus::State::kCoasting:
      break;
  }
  return "coasting";
}

void StatusKeeper::innovation(const InnovationRecord& record, const char* source) {
  const auto found = std::find_if(statistics_.begin(), statistics_.end(),
                                  [&](const InnovationStatistics& s) { return s.source == source; });
  const auto at = static_cast<std::size_t>(found - statistics_.begin());
  if (found == statistics_.end()) {
    statistics_.push_back({source, record.rows});
    nis_sums_.push_back(0.0);
  }
  InnovationStatistics& s = statistics_[at];
  s.last_nis = record.mahalanobis_sq;
  if (record.used) {
    ++s.used;
    nis_sums_[at] += record.mahalanobis_sq;
    s.mean_nis = nis_sums_[at] / static_cast<double>(s.used);
    if (s.source == "standing") last_standing_ = record.stamp;
  } else {
    ++s.rejected;
  }
}

void StatusKeeper::fixTaken(Stamp stamp, Receivers::Use receiver) {
  last_fix_ = stamp;
  receiver_ = receiver;
}

void StatusKeeper::answer(Stamp stamp, const std::optional<Odometry>& odometry) {
  positioned_ = odometry.has_value();
  if (!odometry) return;
  if (before_) {
    const double dt = toSeconds(stamp - before_->stamp);
    const auto velocity = [](const Odometry& o) { return o.T_map_imu.rotation * o.velocity_imu_mps; };
    const Eigen::Vector3d moved = odometry->T_map_imu.translation - before_->T_map_imu.translation;
    const Eigen::Vector3d before = moved - dt * velocity(*before_), after = moved - dt * velocity(*odometry);
    // The velocity may be corrected as well: only what neither of the two explains is a jump.
    const double jump = std::min(before.norm(), after.norm());
    if (dt < kJumpWithin_s && jump > kJump_m) {
      counters_.add("position jumped by more than 0.5 m");
      ++jumps_;
      last_jump_m_ = jump;
    }
  }
  before_ = odometry;
}

LocalizationStatus::State StatusKeeper::stateAt(Stamp stamp) const {
  if (!positioned_ || !last_fix_) return LocalizationStatus::State::kAligning;
  return toSeconds(stamp - *last_fix_) > kCoastingAfter_s ? LocalizationStatus::State::kCoasting
                                                          : LocalizationStatus::State::kRunning;
}

bool StatusKeeper::due(Stamp stamp) const {
  return told_ == kBeginOfTime || stamp / kPeriod != told_ / kPeriod || receiver_ != told_receiver_ ||
         stateAt(stamp) != *told_state_;
}

LocalizationStatus StatusKeeper::status(Stamp stamp, std::optional<ImuBias> bias) {
  LocalizationStatus status;
  status.stamp = stamp;
  status.state = stateAt(stamp);
  if (last_fix_) status.fix_age_s = toSeconds(stamp - *last_fix_);
  status.receiver = receiver_;
  status.standing = last_standing_ != kBeginOfTime && stamp - last_standing_ <= kStandingLasts;
  for (const auto& [name, count] : counters_.all()) {
    if (name.rfind("restarted: ", 0) == 0 || name.find("re-initialized") != std::string::npos)
      status.reinitialized += count;
  }
  status.jumps = jumps_;
  status.last_jump_m = last_jump_m_;
  status.bias = std::move(bias);
  status.innovations = statistics_;
  told_ = stamp;
  told_state_ = status.state;
  told_receiver_ = receiver_;
  return status;
}

}  // namespace atlas
