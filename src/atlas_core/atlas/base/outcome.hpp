// SPDX-License-Identifier: MIT
// A value, or the reason why there is none. Unknown is unknown: never identity, zero or the last value.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace atlas {

/// Why there is no value. toString() gives the text under which a skip is counted in diagnostics and
/// run.json.
enum class Reason {
  kNoPoseYet,          ///< asked for a time before the first pose
  kPoseNotReached,     ///< asked for a time after the newest pose
  kPoseGap,            ///< the two poses around the time are too far apart to interpolate
  kNotFinite,          ///< NaN or infinite field
  kNotNormalized,      ///< quaternion whose norm is not 1
  kOutOfOrder,         ///< stamp not after the previous one of the stream
  kMissingFrame,       ///< no extrinsic calibration for the frame
  kMissingIntrinsics,  ///< camera_info absent or zero
  kBadLayout,          ///< message or file whose fields are not the expected ones
  kNoPoints,           ///< nothing measured where it was needed
  kEmpty,              ///< nothing inside
  kLowQuality          ///< gated out by a quality limit
};

const char* toString(Reason reason);

/// Minimal expected<T, Reason>.
template <class T>
class Outcome {
 public:
  Outcome(T value) : value_(std::move(value)) {}  // NOLINT: implicit by intent
  Outcome(Reason reason) : reason_(reason) {}     // NOLINT: implicit by intent
  explicit operator bool() const { return value_.has_value(); }
  /// Throws std::logic_error when there is no value.
  const T& value() const {
    if (!value_) throw std::logic_error(std::string("Outcome has no value: ") + toString(reason_));
    return *value_;
  }
  const T& operator*() const { return value(); }
  const T* operator->() const { return &value(); }
  /// Meaningful only without a value.
  [[nodiscard]] Reason reason() const { return reason_; }

 private:
  std::optional<T> value_;
  Reason reason_ = Reason::kEmpty;
};

}  // namespace atlas
