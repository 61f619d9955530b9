// SPDX-License-Identifier: MIT
// Colours for the map: pictures and depth images of the same stamp, with the pose of that stamp. A picture
// waits until the odometry has passed it.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "atlas/base/counters.hpp"
#include "atlas/calibration/rig.hpp"
#include "atlas/camera/point_colours.hpp"
#include "atlas/camera/pose_history.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas {

class MapColours {
 public:
  /// `counters`: of what is used and skipped; must outlive this.
  MapColours(std::size_t cameras, Counters& counters);

  void add(const StaticTransforms& transforms) { rig_.add(transforms); }
  void add(const Odometry& odometry) { poses_.push(odometry, counters_); }
  void add(std::size_t camera, const CameraInfo& info);
  void add(std::size_t camera, const ImagePtr& picture);
  void addDepth(std::size_t camera, const DepthImagePtr& depth);
  void addConfidence(std::size_t camera, const DepthImagePtr& confidence);

  /// Calls visit(what was seen) for every picture whose parts and pose are known, in order of stamps and
  /// cameras. `merged`: every input at or before this has been added.
  void answer(Stamp merged, const std::function<void(const std::vector<ColouredPoint>&)>& visit);

 private:
  static constexpr double kMaxPoseGap_s = 0.5;  // as the depth images
  struct Parts {
    CameraInfo info;  ///< empty: none
    ImagePtr picture;
    DepthImagePtr depth, confidence;
  };
  struct Camera {
    CameraInfo info;
    std::unique_ptr<PixelBearings> bearings;  ///< from its first image on
  };
  [[nodiscard]] Outcome<std::vector<ColouredPoint>> coloured(std::size_t camera, const Parts& parts,
                                                             const Outcome<Pose>& T_map_imu);
  /// Null when the calibration cannot be used.
  PixelBearings* bearingsOf(std::size_t camera, const CameraInfo& info);

  Counters& counters_;
  Rig rig_;
  PoseHistory poses_;
  std::vector<Camera> cameras_;
  std::map<std::pair<Stamp, std::size_t>, Parts> waiting_;  ///< by stamp and camera
};

}  // namespace atlas
