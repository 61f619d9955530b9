// SPDX-License-Identifier: MIT
// Which samples of an IMU can be believed. A sample that cannot is counted under its reason and left out: the
// filter then sees a gap and lets its uncertainty grow; where that is not enough (a blow beyond the range, a
// freeze that was noticed late) the guard says how much the motion is in doubt. Units that are wrong end the
// run in words.
//
//   saturated    a value at the range limit. Without a given range the limit is learned: the largest
//                magnitude so far, three times in a row exactly, where no range ends below (2 g, 1.7 rad/s)
//   frozen       all six values exactly the same for a while, in a signal that used to vary
//   beyond       more than any IMU of a vehicle measures
//   gap          more than five usual periods without a sample: counted, with its length
//   wrong units  mean acceleration of the first seconds in g, without gravity, or pointing down; turn rates
//                in degrees (against the IMU's own orientation, or faster than a vehicle turns)
#pragma once

#include <cmath>
#include <optional>

#include "atlas/base/counters.hpp"
#include "atlas/sensor/sensor.hpp"

namespace atlas {

struct ImuGuardParams {
  double accelerometer_range_mps2 = 0.0;  ///< values at it are saturated; 0: learned
  double gyroscope_range_radps = 0.0;     ///< same
  double frozen_after_s = 0.2;            ///< so long the same values; 0: never
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const ImuGuardParams& params);

class ImuGuard {
 public:
  /// Variances of what nobody measured, per axis.
  struct Doubt {
    double velocity = 0.0;  ///< (m/s)^2
    double turn = 0.0;      ///< rad^2
  };
  /// What is wrong with a sample.
  struct Verdict {
    bool beyond = false, frozen = false, accelerometer_saturated = false, gyroscope_saturated = false;
  };
  /// `counters` must outlive it.
  ImuGuard(const ImuGuardParams& params, Counters& counters);
  /// False: counted, not to be used. Throws std::runtime_error when the units cannot be right. Finite values.
  bool usable(const ImuSample& sample);
  /// What the newest sample adds to the doubt in the motion up to it.
  [[nodiscard]] const Doubt& doubt() const { return doubt_; }
  /// Of the newest sample.
  [[nodiscard]] const Verdict& verdict() const { return verdict_; }

 private:
  /// Three axes that share a range.
  struct Group {
    double range = 0.0;  ///< 0: not known
    bool learned = false;
    double least = 0.0;  ///< no range ends below
    double largest = 0.0;
    int repeats[3] = {0, 0, 0};  ///< samples in a row with the same value
    int clipped = 0;             ///< samples in a row
    /// The k-th clipped sample in a row leaves out about `range` for one more period; sums of the same sign.
    [[nodiscard]] double doubt(double period_s) const {
      return (2 * clipped - 1) * std::pow(range * period_s, 2);
    }
    bool saturated(const Eigen::Vector3d& now, const Eigen::Vector3d& before);
  };
  void watchGap(const ImuSample& sample);
  void judgeRange(const ImuSample& sample, const ImuSample& before, bool& usable);
  [[nodiscard]] bool frozen(const ImuSample& sample);
  void watchUnits(const ImuSample& sample);
  void judgeUnits(double span_s);

  ImuGuardParams params_;
  Counters& counters_;
  Group accel_, gyro_;
  std::optional<ImuSample> before_;
  Doubt doubt_;
  Verdict verdict_;
  double period_s_ = 0.0;
  bool is_frozen_ = false;
  int varied_ = 0, same_ = 0;
  Stamp same_since_ = 0;

  struct Window {
    Stamp begin = 0;
    Eigen::Vector3d force_sum = Eigen::Vector3d::Zero(), turned_rad = Eigen::Vector3d::Zero();
    double turning_rad = 0.0;      ///< sum of the sizes of all turns
    double own_turning_rad = 0.0;  ///< same of the IMU's own orientation
    int samples = 0;
  };
  std::optional<Window> window_;
  bool force_judged_ = false;
};

}  // namespace atlas
