// SPDX-License-Identifier: MIT
#include "atlas/monitor/magnetic_check.hpp"

#include <cmath>

namespace atlas {
namespace {
constexpr double kMemory_s = 60.0;
}

void MagneticCheck::add(const MagneticSample& sample, Findings& findings) {
  const bool finite = sample.field.allFinite();
  findings.measure(Anomaly::kNotFinite, sample.stamp, finite ? 0.0 : 1.0);
  if (!finite) return;
  findings.measure(Anomaly::kMagneticFrozen, sample.stamp, same_.add(sample.stamp, sample.field));
  if (count_ == 0) {
    begin_ = sample.stamp;
    sum_.setZero();
  }
  sum_ += sample.field;
  ++count_;
  if (sample.stamp - begin_ < kSecond) return;
  const double norm = (sum_ / count_).norm();
  if (usual_norm_ == 0.0) usual_norm_ = norm;
  const double change = std::abs(norm / usual_norm_ - 1.0);
  findings.measure(Anomaly::kMagneticNorm, sample.stamp, change);
  usual_norm_ += toSeconds(sample.stamp - begin_) / kMemory_s * (norm - usual_norm_);
  count_ = 0;
}

}  // namespace atlas
