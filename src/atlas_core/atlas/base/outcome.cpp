// SPDX-License-Identifier: MIT
#include "atlas/base/outcome.hpp"

namespace atlas {

const char* toString(Reason reason) {
  switch (reason) {
    case Reason::kNoPoseYet:
      return "no pose yet";
    case Reason::kPoseNotReached:
      return "after the newest pose";
    case Reason::kPoseGap:
      return "gap between poses";
    case Reason::kNotFinite:
      return "not finite";
    case Reason::kNotNormalized:
      return "quaternion not normalized";
    case Reason::kOutOfOrder:
      return "stamp out of order";
    case Reason::kMissingFrame:
      return "no extrinsic calibration for the frame";
    case Reason::kMissingIntrinsics:
      return "camera_info missing or zero";
    case Reason::kBadLayout:
      return "unexpected layout";
    case Reason::kNoPoints:
      return "no points";
    case Reason::kEmpty:
      return "empty";
    case Reason::kLowQuality:
      return "below the quality limit";
  }
  return "unknown reason";
}

}  // namespace atlas
