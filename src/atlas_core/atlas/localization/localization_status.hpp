// SPDX-License-Identifier: MIT
// What the localization says about itself, once a second of event time and whenever its state or receiver
// changes: collected from the filter's innovations and answers.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atlas/localization/positioning_filter.hpp"
#include "atlas/localization/receivers.hpp"

namespace atlas {

/// All measurements of one kind since the start.
struct InnovationStatistics {
  std::string source;  ///< as InnovationRecord::source; "second fix": of the second receiver
  int rows = 0;        ///< degrees of freedom
  std::uint64_t used = 0, rejected = 0;
  double mean_nis = 0.0;  ///< of those used; `rows` when the covariances are right
  double last_nis = 0.0;  ///< y' S^-1 y of the newest one, used or not
};

struct LocalizationStatus {
  enum class State {
    kAligning,  ///< no pose yet
    kRunning,
    kCoasting  ///< no fix was taken for kCoastingAfter_s: the covariance grows
  };
  Stamp stamp = 0;
  State state = State::kAligning;
  std::optional<double> fix_age_s;  ///< since the last fix that was taken
  Receivers::Use receiver = Receivers::Use::kNone;
  bool standing = false;            ///< seen by the filter; kalman_1d does not look
  std::uint64_t reinitialized = 0;  ///< restarts and re-initializations of position or heading
  std::uint64_t jumps = 0;          ///< the position moved by more than kJump_m against its own velocity
  double last_jump_m = 0.0;
  std::optional<ImuBias> bias;
  std::vector<InnovationStatistics> innovations;
};
const char* toString(LocalizationStatus::State state);

class StatusKeeper {
 public:
  static constexpr double kCoastingAfter_s = 2.0, kJump_m = 0.5;

  /// `counters` must outlive it.
  explicit StatusKeeper(Counters& counters) : counters_(counters) {}

  void innovation(const InnovationRecord& record, const char* source);
  void fixTaken(Stamp stamp, Receivers::Use receiver);
  /// Fixes are being taken: not coasting, not aligning.
  [[nodiscard]] bool fixed(Stamp stamp) const {
    return stateAt(stamp) == LocalizationStatus::State::kRunning;
  }
  [[nodiscard]] bool positioned() const { return positioned_; }
  /// The filter's answer to a sample; counts jumps.
  void answer(Stamp stamp, const std::optional<Odometry>& odometry);
  /// True when a status is due after this sample.
  [[nodiscard]] bool due(Stamp stamp) const;
  LocalizationStatus status(Stamp stamp, std::optional<ImuBias> bias);

 private:
  [[nodiscard]] LocalizationStatus::State stateAt(Stamp stamp) const;

  Counters& counters_;
  std::vector<InnovationStatistics> statistics_;
  std::vector<double> nis_sums_;
  std::optional<Stamp> last_fix_;
  Stamp last_standing_ = kBeginOfTime;
  Receivers::Use receiver_ = Receivers::Use::kNone;
  bool positioned_ = false;
  std::optional<Odometry> before_;
  std::uint64_t jumps_ = 0;
  double last_jump_m_ = 0.0;
  std::optional<LocalizationStatus::State> told_state_;
  Receivers::Use told_receiver_ = Receivers::Use::kNone;
  Stamp told_ = kBeginOfTime;
};

}  // namespace atlas
