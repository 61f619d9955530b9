// SPDX-License-Identifier: MIT
#include "synthetic/boxes2d.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace atlas::synthetic {
namespace {

constexpr int kFewestPixels = 4;
constexpr double kSmallest = 8.0;    // px
constexpr double kMostHidden = 0.7;  // of the object

struct Extent {
  int u1 = 1 << 20, v1 = 1 << 20, u2 = -1, v2 = -1, pixels = 0;
  float depth = kSight, range = 4.0F * kSight;
};

}  // namespace

std::vector<TruthBox2d> visibleBoxes(const View& view, const CameraView& camera, const Scene& scene) {
  std::map<int, Extent> extents;
  const int width = camera.camera().width;
  for (int pixel = 0; pixel < static_cast<int>(view.hit.size()); ++pixel) {
    const int hit = view.hit[pixel];
    if (hit < 0 || view.snapshot.primitives[hit].object == 0) continue;
    Extent& extent = extents[view.snapshot.primitives[hit].object];
    const int u = pixel % width, v = pixel / width;
    extent.u1 = std::min(extent.u1, u);
    extent.v1 = std::min(extent.v1, v);
    extent.u2 = std::max(extent.u2, u);
    extent.v2 = std::max(extent.v2, v);
    ++extent.pixels;
    const Eigen::Vector2f tangent = camera.tangent(pixel);
    extent.depth = std::min(extent.depth, view.depth[pixel]);
    extent.range = std::min(extent.range, view.depth[pixel] * std::sqrt(1.0F + tangent.squaredNorm()));
  }
  std::vector<int> objects;
  for (const auto& [object, extent] : extents) {
    if (extent.pixels >= kFewestPixels) objects.push_back(object);
  }
  std::vector<TruthBox2d> boxes;
  for (const CameraView::Outline& outline : camera.outlines(view, objects)) {
    const Extent& extent = extents[outline.object];
    TruthBox2d box;
    box.object = outline.object;
    box.class_id = static_cast<int>(scene.find(outline.object)->object_class);
    box.x1 = extent.u1 - 0.5;
    box.y1 = extent.v1 - 0.5;
    box.x2 = extent.u2 + 0.5;
    box.y2 = extent.v2 + 0.5;
    box.visible_fraction = static_cast<double>(extent.pixels) / outline.pixels;
    box.depth_m = static_cast<double>(extent.depth);
    box.range_m = static_cast<double>(extent.range);
    boxes.push_back(box);
  }
  return boxes;
}

std::vector<FakeDetection> detect(const std::vector<TruthBox2d>& boxes, const Camera& camera,
                                  const NoiseOptions& noise, Random& random) {
  std::vector<FakeDetection> detections;
  for (const TruthBox2d& box : boxes) {
    double sides[4] = {box.x1, box.y1, box.x2, box.y2};
    const double size = std::min(box.x2 - box.x1, box.y2 - box.y1);
    for (double& side : sides) side += std::min(noise.detection_px, 0.05 * size) * random.normal();
    const bool missed = random.chance(noise.detection_missed_fraction);
    const double luck = random.uniform();
    const double confidence =
        std::clamp(0.97 - 0.35 * (1.0 - box.visible_fraction) - 2.0 / size - 0.1 * luck, 0.26, 0.99);
    if (missed || box.visible_fraction < 1.0 - kMostHidden || size < kSmallest) continue;
    for (int k = 0; k < 4; ++k)
      sides[k] = std::clamp(sides[k], -0.5, (k % 2 == 0 ? camera.width : camera.height) - 0.5);
    if (sides[2] - sides[0] < 2.0 || sides[3] - sides[1] < 2.0) continue;
    detections.push_back({sides[0], sides[1], sides[2], sides[3], confidence, box.class_id});
    if (box.class_id ==
        static_cast<int>(ObjectClass::kBicycle)) {  // feet on the pedals, 20 cm above the road
      const double feet = sides[1] + 0.87 * (sides[3] - sides[1]);
      detections.push_back(
          {sides[0], sides[1], sides[2], feet, 0.95 * confidence, static_cast<int>(ObjectClass::kPerson)});
    }
  }
  return detections;
}

}  // namespace atlas::synthetic
