// SPDX-License-Identifier: MIT
#include "atlas/camera/point_colours.hpp"

#include <cmath>
#include <limits>

#include "atlas/base/check.hpp"

namespace atlas {

cv::Vec2f PixelBearings::at(int row, int column) {
  auto& tangent = tangents_.ptr<cv::Vec2f>(row)[column];
  if (tangent[0] == kUnknown) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const auto bearing = model_.bearing({static_cast<double>(column), static_cast<double>(row)});
    tangent = bearing ? cv::Vec2f(static_cast<float>(bearing->x()), static_cast<float>(bearing->y()))
                      : cv::Vec2f(kNone, kNone);
  }
  return tangent;
}

std::vector<ColouredPoint> pointColours(const cv::Mat& bgr, const cv::Mat& depth, const cv::Mat& confidence,
                                        const Pose& T_map_camera, PixelBearings& bearings) {
  const cv::Size size = bearings.size();
  ATLAS_CHECK(bgr.size() == size && depth.size() == size && confidence.size() == size,
              "point colours: images of different sizes");
  ATLAS_CHECK(bgr.type() == CV_8UC3 && depth.type() == CV_32FC1 && confidence.type() == CV_32FC1,
              "point colours: images of other types");
  std::vector<ColouredPoint> result;
  for (int row = 0; row < size.height; ++row) {
    const auto* const colours = bgr.ptr<cv::Vec3b>(row);
    const auto* const depths = depth.ptr<float>(row);
    const auto* const measured = confidence.ptr<float>(row);
    for (int column = 0; column < size.width; ++column) {
      if (measured[column] != 1.0F || !std::isfinite(depths[column])) continue;
      const cv::Vec2f tangent = bearings.at(row, column);
      if (!std::isfinite(tangent[0])) continue;
      const double z = depths[column];
      const Eigen::Vector3f p = (T_map_camera * Eigen::Vector3d(z * static_cast<double>(tangent[0]),
                                                                z * static_cast<double>(tangent[1]), z))
                                    .cast<float>();
      const cv::Vec3b& c = colours[column];
      result.push_back({p.x(), p.y(), p.z(), depths[column], c[2], c[1], c[0]});
    }
  }
  return result;
}

}  // namespace atlas
