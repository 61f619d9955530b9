// SPDX-License-Identifier: MIT
// The table of positioning filters and the check of their parameters.
#include "atlas/localization/positioning_filter.hpp"

#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "atlas/localization/eskf_filter.hpp"
#include "atlas/localization/kalman_1d_filter.hpp"

namespace atlas {
namespace {

using Factory = std::unique_ptr<PositioningFilter> (*)(const PositioningParams&, const Eigen::Vector3d&,
                                                       const Geodetic&, Counters&);

template <class Filter>
std::unique_ptr<PositioningFilter> make(const PositioningParams& params, const Eigen::Vector3d& lever_arm_imu,
                                        const Geodetic& anchor, Counters& counters) {
  return std::make_unique<Filter>(params, lever_arm_imu, anchor, counters);
}

struct Registration {
  const char* name;
  Factory factory;
};
constexpr std::array<Registration, 2> kFilters{{
    {"eskf", &make<EskfFilter>},
    {"kalman_1d", &make<Kalman1dFilter>},
}};

struct Bound {
  const char* field;
  double value;
  double minimum;
  bool open;  ///< the value must be greater than, not equal to, the minimum
};

void require(const Bound& bound) {
  const bool inside = bound.open ? bound.value > bound.minimum : bound.value >= bound.minimum;
  if (inside && std::isfinite(bound.value)) return;
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << "positioning: need " << bound.field << (bound.open ? " > " : " >= ") << bound.minimum << ", got "
       << bound.value;
  throw std::invalid_argument(text.str());
}

}  // namespace

void validate(const PositioningParams& p) {
  const std::array<Bound, 36> bounds{{
      {"gnss_horizontal_sigma_m", p.gnss_horizontal_sigma_m, 0, true},
      {"gnss_vertical_sigma_m", p.gnss_vertical_sigma_m, 0, true},
      {"gnss_heading_sigma_rad", p.gnss_heading_sigma_rad, 0, true},
      {"gnss_heading_slow_share", p.gnss_heading_slow_share, 0, false},
      {"gnss_heading_slow_share's rest to 1", 1.0 - p.gnss_heading_slow_share, 0, true},
      {"gnss_heading_slow_time_s", p.gnss_heading_slow_time_s, 0, true},
      {"accelerometer_noise_mps2_sqrt_hz", p.accelerometer_noise_mps2_sqrt_hz, 0, true},
      {"accelerometer_bias_mps2", p.accelerometer_bias_mps2, 0, false},
      {"accelerometer_bias_time_s", p.accelerometer_bias_time_s, 0, true},
      {"gyroscope_noise_radps_sqrt_hz", p.gyroscope_noise_radps_sqrt_hz, 0, true},
      {"gyroscope_bias_radps", p.gyroscope_bias_radps, 0, false},
      {"gyroscope_bias_walk_radps2_sqrt_hz", p.gyroscope_bias_walk_radps2_sqrt_hz, 0, false},
      {"tilt_sigma_rad", p.tilt_sigma_rad, 0, false},
      {"tilt_time_constant_s", p.tilt_time_constant_s, 0, true},
      {"velocity_heading_min_speed_mps", p.velocity_heading_min_speed_mps, 0, true},
      {"velocity_heading_slip_rad", p.velocity_heading_slip_rad, 0, false},
      {"imu_to_rear_axle_sigma_m", p.imu_to_rear_axle_sigma_m, 0, false},
      {"gate_mahalanobis_sq", p.gate_mahalanobis_sq, 0, true},
      {"heading_gate_mahalanobis_sq", p.heading_gate_mahalanobis_sq, 0, true},
      {"max_consecutive_rejections", p.max_consecutive_rejections, 1, false},
      {"max_imu_gap_s", p.max_imu_gap_s, 0, true},
      {"eskf.accelerometer_noise_mps2_sqrt_hz", p.eskf.accelerometer_noise_mps2_sqrt_hz, 0, true},
      {"eskf.gyroscope_noise_radps_sqrt_hz", p.eskf.gyroscope_noise_radps_sqrt_hz, 0, true},
      {"eskf.vibration_share", p.eskf.vibration_share, 0, false},
      {"eskf.accelerometer_bias_mps2", p.eskf.accelerometer_bias_mps2, 0, true},
      {"eskf.gyroscope_bias_radps", p.eskf.gyroscope_bias_radps, 0, true},
      {"eskf.accelerometer_bias_walk_mps3_sqrt_hz", p.eskf.accelerometer_bias_walk_mps3_sqrt_hz, 0, false},
      {"eskf.gyroscope_bias_walk_radps2_sqrt_hz", p.eskf.gyroscope_bias_walk_radps2_sqrt_hz, 0, false},
      {"eskf.mount_sigma_rad", p.eskf.mount_sigma_rad, 0, false},
      {"eskf.lever_arm_sigma_m", p.eskf.lever_arm_sigma_m, 0, false},
      {"eskf.gnss_delay_sigma_s", p.eskf.gnss_delay_sigma_s, 0, false},
      {"eskf.slip_sigma_mps", p.eskf.slip_sigma_mps, 0, true},
      {"eskf.slip_sigma_rad", p.eskf.slip_sigma_rad, 0, false},
      {"eskf.axle_height_m", p.eskf.axle_height_m, 0, false},
      {"eskf.standing_sigma_mps", p.eskf.standing_sigma_mps, 0, true},
      {"eskf.recovery_s", p.eskf.recovery_s, 0, true},
  }};
  for (const Bound& bound : bounds) require(bound);
  require({"imu_to_rear_axle_m", p.imu_to_rear_axle_m, -100.0, false});
}

std::unique_ptr<PositioningFilter> makePositioningFilter(const std::string& name,
                                                         const PositioningParams& params,
                                                         const Eigen::Vector3d& lever_arm_imu,
                                                         const Geodetic& anchor, Counters& counters) {
  validate(params);
  std::string known;
  for (const Registration& registration : kFilters) {
    if (name == registration.name) return registration.factory(params, lever_arm_imu, anchor, counters);
    known += std::string(known.empty() ? "" : ", ") + registration.name;
  }
  throw std::invalid_argument("localization: filter must be one of {" + known + "}, got '" + name + "'");
}

}  // namespace atlas
