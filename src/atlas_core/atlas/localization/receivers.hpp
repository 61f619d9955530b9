// SPDX-License-Identifier: MIT
// Two GNSS receivers, one position. The first one is used while the filter takes its fixes. When it has given
// none that was taken for `fallback_after_s`, the second one is used until the first is back. Both are
// compared with each other all the time: a first receiver that leaves the prediction and the second one,
// which still agree, has jumped and is not used, so that it cannot talk the filter into its new place.
//
// The error of a plain receiver wanders slowly (sigma, correlation time T). Fixes dt apart are therefore no
// independent measurements; as white noise of the same density they have the variance sigma^2 2 T / dt.
#pragma once

#include <optional>
#include <string>

#include "atlas/base/counters.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

struct ReceiverParams {
  bool second_receiver = false;                 ///< listen to imu/gnss/fix, too
  std::string second_gnss_antenna_frame;        ///< "" = the frame that the fix itself names
  double fallback_after_s = 10.0;               ///< without a fix of the first receiver that was taken
  double second_gnss_horizontal_sigma_m = 3.0;  ///< for fixes without covariance
  double second_gnss_vertical_sigma_m = 6.0;    ///< same
  double second_gnss_error_time_s = 60.0;       ///< correlation time T of its error
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const ReceiverParams& params);

class Receivers {
 public:
  enum class Use { kNone, kPrimary, kSecondary };
  /// A fix in map with the lever arm of its antenna.
  struct Fix {
    Stamp stamp = 0;
    Eigen::Vector3d p_map_antenna, lever_arm_imu;
    Eigen::Matrix3d R_m2;
  };

  /// `counters` must outlive it.
  Receivers(const ReceiverParams& params, Counters& counters) : params_(params), counters_(counters) {}

  /// The filter's newest answer: what the fixes are compared with.
  void predicted(const Odometry& odometry) { odometry_ = odometry; }
  [[nodiscard]] const std::optional<Odometry>& prediction() const { return odometry_; }

  /// Time of the first event: from here on the first receiver is waited for.
  void begin(Stamp stamp);
  /// The filter took (or, while it starts, was given) a fix of the first or of the second receiver.
  void taken(Stamp stamp, Use receiver);

  /// True when a fix of the first receiver must not be used: it jumped.
  [[nodiscard]] bool jumped(const Fix& first);
  /// The filter has no answer of late.
  [[nodiscard]] bool starting(Stamp now) const;
  /// No fix of the first receiver was taken for long enough: the second one is needed.
  [[nodiscard]] bool firstIsSilent(Stamp now) const;
  /// Compares, counts; the fix with the covariance to be used when the second receiver is needed.
  std::optional<Fix> second(const Fix& fix);

  [[nodiscard]] Use inUse() const { return in_use_; }

 private:
  struct Misfit {
    double mahalanobis_sq;     ///< horizontal: 2 degrees of freedom
    Eigen::Vector2d offset_m;  ///< from the prediction
  };
  [[nodiscard]] std::optional<Misfit> misfit(const Fix& fix) const;

  ReceiverParams params_;
  Counters& counters_;
  std::optional<Odometry> odometry_;
  Stamp begin_ = kBeginOfTime, first_taken_ = kBeginOfTime;
  Stamp second_given_ = kBeginOfTime;
  Use in_use_ = Use::kNone;
  struct Second {
    Stamp stamp;
    double variance_m2;
    Misfit misfit;
  };
  std::optional<Second> second_;  ///< its newest fix
};

const char* toString(Receivers::Use use);

}  // namespace atlas
