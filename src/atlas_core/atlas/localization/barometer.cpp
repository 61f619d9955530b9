// SPDX-License-Identifier: MIT
#include "atlas/localization/barometer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace atlas {
namespace {
constexpr double kLeastPressure_pa = 30000.0, kMostPressure_pa = 110000.0;  // 9 km up, 700 m below the sea
constexpr Duration kPeriod = kSecond;
}  // namespace

void validate(const BarometerParams& p) {
  for (const auto& [field, value] : {std::pair("barometer_sigma_m", p.barometer_sigma_m),
                                     std::pair("barometer_error_time_s", p.barometer_error_time_s)}) {
    if (value > 0.0 && std::isfinite(value)) continue;
    throw std::invalid_argument("localization: need " + std::string(field) + " > 0, got " +
                                std::to_string(value));
  }
}

double pressureHeight(double pressure_pa) {
  return 44330.77 * (1.0 - std::pow(pressure_pa / 101325.0, 0.190263));
}

std::optional<Barometer::Height> Barometer::add(const ScalarSample& pressure, std::optional<double> z_map_m,
                                                bool fixed) {
  counters_.add("pressure");
  if (!std::isfinite(pressure.value)) {
    counters_.skip("pressure", Reason::kNotFinite);
    return std::nullopt;
  }
  if (pressure.value < kLeastPressure_pa || pressure.value > kMostPressure_pa) {
    counters_.add("skipped pressure: not between 300 and 1100 hPa; Pa is needed");
    return std::nullopt;
  }
  if (!z_map_m) {
    counters_.skip("pressure", Reason::kNoPoseYet);
    return std::nullopt;
  }
  const double height = pressureHeight(pressure.value);
  const double dt = last_ == kBeginOfTime ? 0.0 : toSeconds(pressure.stamp - last_);
  last_ = pressure.stamp;
  if (!offset_m_) offset_m_ = height - *z_map_m;
  if (fixed) {
    *offset_m_ += std::min(1.0, dt / params_.barometer_error_time_s) * (height - *z_map_m - *offset_m_);
    counters_.add("pressure compared with the fixes");
    given_ = pressure.stamp;
    return std::nullopt;
  }
  if (given_ != kBeginOfTime && pressure.stamp - given_ < kPeriod) {
    counters_.add("skipped pressure: sooner than a second after the one before");
    return std::nullopt;
  }
  given_ = pressure.stamp;
  const double sigma_sq = params_.barometer_sigma_m * params_.barometer_sigma_m;
  return Height{height - *offset_m_,
                sigma_sq * std::max(1.0, 2.0 * params_.barometer_error_time_s / toSeconds(kPeriod))};
}

}  // namespace atlas
