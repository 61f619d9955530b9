// SPDX-License-Identifier: MIT
// Everything that the sensor monitor can find, one entry each: name, quantity and unit, parameter with its
// default, what it takes from the score. The parameters, the checks and the table in the README come from it.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace atlas {

enum class Anomaly : std::size_t {
  // every sensor
  kMissing,
  kGap,
  kDuplicate,
  kMisordered,
  kRate,
  kNotFinite,
  kClockJump,
  kClockDrift,
  // inertial sensor, magnetometer, barometer
  kImuFrozen,
  kAccelerometerSaturated,
  kGyroscopeSaturated,
  kImuBeyond,
  kImuUnits,
  kGravity,
  kGyroBias,
  kMagneticFrozen,
  kMagneticNorm,
  kPressureFrozen,
  kPressureStep,
  // receivers
  kNoPosition,
  kFixFrozen,
  kPositionJump,
  kPositionSigma,
  kHeadingLost,
  kHeadingJump,
  // cameras
  kPictureEmpty,
  kPictureFrozen,
  kBlack,
  kWhite,
  kBlurred,
  kFogged,
  kGlare,
  kOccluded,
  kTemperatureRangeFrozen,
  kTemperatureRange,
  // lidars, radar
  kScanEmpty,
  kScanFrozen,
  kFewPoints,
  kDeadBeams,
  kBlocked,
  kRangeOffset,
  kTargetsFrozen,
  kCount
};
constexpr std::size_t kAnomalies = static_cast<std::size_t>(Anomaly::kCount);

struct AnomalyInfo {
  const char* sensors;    ///< who can have it
  const char* name;       ///< in the status; the same thing of two kinds of sensors has the same name
  const char* parameter;  ///< key of the threshold in the configuration
  const char* unit;       ///< of the measured quantity and of its threshold
  enum Side { kAbove, kBelow } side;  ///< of the threshold on which the anomaly lies
  double threshold;                   ///< default
  double severity;                    ///< the score is multiplied by 1 - severity
  const char* explanation;            ///< the quantity
};
/// The entry of an anomaly.
const AnomalyInfo& infoOf(Anomaly anomaly);

/// One threshold per anomaly, by default those of the table.
class AnomalyThresholds {
 public:
  AnomalyThresholds();
  double& operator[](Anomaly anomaly) { return values_[static_cast<std::size_t>(anomaly)]; }
  double operator[](Anomaly anomaly) const { return values_[static_cast<std::size_t>(anomaly)]; }

 private:
  std::array<double, kAnomalies> values_{};
};

/// The table as Markdown, for the README.
std::string anomalyTable();

}  // namespace atlas
