// SPDX-License-Identifier: MIT
#include "object_markers.hpp"

#include <cmath>
#include <string>

#include "atlas/output/coco_names.hpp"
#include "atlas/output/fixed_text.hpp"
#include "class_color.hpp"
#include "marker_shapes.hpp"

namespace atlas_rviz {
namespace {

constexpr double kEdge = 0.08, kTrail = 0.06;                   // m, width of lines
constexpr double kShaft = 0.15, kHead = 0.35, kHeadLong = 0.5;  // m, of arrows
constexpr double kText = 0.6, kTextGap = 0.6;                   // m: letters, and their place above the box

/// RViz refuses a whole marker for one bad number in it.
bool finite(const atlas::Object& o) {
  return o.position.allFinite() && o.size.allFinite() && o.velocity_mps.allFinite() &&
         std::isfinite(o.yaw_rad);
}

std::string label(const atlas::Object& o) {
  const std::string what = o.class_id >= 0 ? atlas::className(o.class_id) + " " : "";
  const std::string speed =
      o.is_static ? "" : ", " + atlas::fixedText(o.velocity_mps.head<2>().norm(), 1) + " m/s";
  return what + std::to_string(o.id) + speed;
}

}  // namespace

MarkerArray objectMarkers(const atlas::Objects& objects) {
  const MarkerOrigin origin{objects.stamp};
  MarkerArray array = emptyArray(origin);
  Marker edges = marker(origin, "edges", 0, Marker::LINE_LIST),
         trails = marker(origin, "trails", 0, Marker::LINE_LIST);
  edges.scale.x = kEdge;
  trails.scale.x = kTrail;
  edges.color = trails.color = color(1, 1, 1);
  for (const atlas::Object& o : objects.objects) {
    if (!finite(o)) continue;
    const int id = static_cast<int>(o.id);
    std_msgs::ColorRGBA shade = groupColor(classGroup(o.class_id));
    if (o.is_static) shade.a = 0.4F;
    const Eigen::Quaterniond R_map_box(Eigen::AngleAxisd(o.yaw_rad, Eigen::Vector3d::UnitZ()));
    addEdges(edges, boxCorners({R_map_box, o.position}, o.size), shade);
    const Eigen::Vector3d above = o.position + Eigen::Vector3d(0, 0, 0.5 * o.size.z() + kTextGap);
    array.markers.push_back(textMarker(origin, id, above, label(o), kText, color(1, 1, 1)));
    for (std::size_t i = 1; i < o.history.size(); ++i) {
      const Eigen::Vector3d &from = o.history[i - 1].position, &to = o.history[i].position;
      if (!from.allFinite() || !to.allFinite()) continue;
      trails.points.push_back(point(from));
      trails.points.push_back(point(to));
      trails.colors.insert(trails.colors.end(), 2, shade);
    }
    if (o.is_static) continue;
    Marker arrow = marker(origin, "velocities", id, Marker::ARROW);
    arrow.scale.x = kShaft;
    arrow.scale.y = kHead;
    arrow.scale.z = kHeadLong;
    arrow.color = shade;
    arrow.points = {point(o.position), point(o.position + o.velocity_mps)};
    array.markers.push_back(arrow);
  }
  if (!edges.points.empty()) array.markers.push_back(edges);
  if (!trails.points.empty()) array.markers.push_back(trails);
  return array;
}

}  // namespace atlas_rviz
