// SPDX-License-Identifier: MIT
// PointCloud2 <-> points. Ours is x y z intensity time (float32) ring (uint16), 24 bytes a point; foreign
// layouts of the usual drivers are read by field name.
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <string>
#include <vector>

#include "atlas/base/outcome.hpp"
#include "atlas/sensor/products.hpp"

namespace atlas_ros {

sensor_msgs::PointCloud2 toCloud(const std::vector<atlas::LidarPoint>& points, atlas::Stamp stamp,
                                 const std::string& frame);
sensor_msgs::PointCloud2 toMsg(const atlas::Sweep& sweep);

/// x, y, z are required (any type), intensity, ring and time optional; other fields are passed over. Time
/// fields understood: `time`, `t`, `timestamp`, `offset_time`, `time_stamp` of any type and unit
/// (atlas::relativeTimes); without one, time is rebuilt from azimuth or order (atlas::rebuildTimes).
/// kBadLayout for missing or short fields. Big-endian data is turned round.
atlas::Outcome<atlas::SweepPtr> fromMsg(const sensor_msgs::PointCloud2& msg);

}  // namespace atlas_ros
