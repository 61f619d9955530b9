// SPDX-License-Identifier: MIT
// A camera sends the same intrinsics with every image: the model (whose limits are searched for) is made
// once.
#pragma once

#include <optional>

#include "atlas/camera/camera_model.hpp"
#include "atlas/camera/projector.hpp"
#include "atlas/sensor/same_calibration.hpp"

namespace atlas {

struct Intrinsics {
  CameraModel model;
  Projector projector;
};

class IntrinsicsCache {
 public:
  IntrinsicsCache(double min_depth_m, double max_depth_m)
      : min_depth_m_(min_depth_m), max_depth_m_(max_depth_m) {}

  /// The model of `info`, made anew only when the calibration differs from the last one.
  const Outcome<Intrinsics>& of(const CameraInfo& info) {
    if (!last_ || !sameCalibration(*last_, info)) {
      const Outcome<CameraModel> model = CameraModel::fromInfo(info);
      last_ = info;
      intrinsics_ =
          model ? Outcome<Intrinsics>(Intrinsics{*model, Projector(*model, min_depth_m_, max_depth_m_)})
                : Outcome<Intrinsics>(model.reason());
    }
    return intrinsics_;
  }

 private:
  double min_depth_m_, max_depth_m_;
  std::optional<CameraInfo> last_;
  Outcome<Intrinsics> intrinsics_ = Reason::kMissingIntrinsics;
};

}  // namespace atlas
