// SPDX-License-Identifier: MIT
#include "atlas_ros/point_cloud.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <limits>
#include <memory>

#include "atlas/lidar/point_time.hpp"
#include "atlas_ros/conversions.hpp"

namespace atlas_ros {
namespace {

using sensor_msgs::PointField;

PointField field(const char* name, std::uint32_t offset, std::uint8_t type) {
  PointField f;
  f.name = name;
  f.offset = offset;
  f.datatype = type;
  f.count = 1;
  return f;
}

std::uint32_t sizeOf(std::uint8_t type) {
  switch (type) {
    case PointField::INT8:
    case PointField::UINT8:
      return 1;
    case PointField::INT16:
    case PointField::UINT16:
      return 2;
    case PointField::INT32:
    case PointField::UINT32:
    case PointField::FLOAT32:
      return 4;
    case PointField::FLOAT64:
      return 8;
    default:
      return 0;
  }
}

const PointField* find(const sensor_msgs::PointCloud2& msg, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    for (const PointField& f : msg.fields) {
      if (f.name == name && sizeOf(f.datatype) > 0 && f.offset + sizeOf(f.datatype) <= msg.point_step)
        return &f;
    }
  }
  return nullptr;
}

/// The suite's machines are little-endian.
template <class T>
double load(const std::uint8_t* data, bool big_endian) {
  std::uint8_t bytes[sizeof(T)];
  std::copy_n(data, sizeof(T), bytes);
  if (big_endian) std::reverse(std::begin(bytes), std::end(bytes));
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

double read(const PointField& f, const std::uint8_t* point, bool big_endian) {
  const std::uint8_t* data = point + f.offset;
  switch (f.datatype) {
    case PointField::INT8:
      return load<std::int8_t>(data, big_endian);
    case PointField::UINT8:
      return load<std::uint8_t>(data, big_endian);
    case PointField::INT16:
      return load<std::int16_t>(data, big_endian);
    case PointField::UINT16:
      return load<std::uint16_t>(data, big_endian);
    case PointField::INT32:
      return load<std::int32_t>(data, big_endian);
    case PointField::UINT32:
      return load<std::uint32_t>(data, big_endian);
    case PointField::FLOAT32:
      return load<float>(data, big_endian);
    default:
      return load<double>(data, big_endian);
  }
}

bool isWhole(const PointField& f) {
  return f.datatype != PointField::FLOAT32 && f.datatype != PointField::FLOAT64;
}

bool isOurLayout(const sensor_msgs::PointCloud2& msg) {
  static const char* const kNames[] = {"x", "y", "z", "intensity", "time", "ring"};
  if (msg.point_step != sizeof(atlas::LidarPoint) || msg.fields.size() != 6) return false;
  for (std::size_t i = 0; i < 6; ++i) {
    const PointField& f = msg.fields[i];
    const std::uint8_t type = i < 5 ? PointField::FLOAT32 : PointField::UINT16;
    if (f.name != kNames[i] || f.offset != 4 * i || f.datatype != type) return false;
  }
  return true;
}

/// Where the point with index i begins.
const std::uint8_t* pointAt(const sensor_msgs::PointCloud2& msg, std::size_t i) {
  return msg.data.data() + i / msg.width * msg.row_step + i % msg.width * msg.point_step;
}

void readTimes(const sensor_msgs::PointCloud2& msg, atlas::Sweep& sweep) {
  const PointField* time = find(msg, {"time", "t", "timestamp", "offset_time", "time_stamp"});
  if (time == nullptr) {
    atlas::rebuildTimes(sweep.points, atlas::kAssumedSweep_s);
    return;
  }
  std::vector<double> raw(sweep.points.size());
  for (std::size_t i = 0; i < raw.size(); ++i) raw[i] = read(*time, pointAt(msg, i), msg.is_bigendian != 0);
  const std::vector<float> times = atlas::relativeTimes(raw, isWhole(*time), sweep.stamp);
  for (std::size_t i = 0; i < raw.size(); ++i) sweep.points[i].time = times[i];
}

void readForeign(const sensor_msgs::PointCloud2& msg, const PointField& x, const PointField& y,
                 const PointField& z, atlas::Sweep& sweep) {
  const PointField* intensity = find(msg, {"intensity", "reflectivity", "i"});
  const PointField* ring = find(msg, {"ring", "channel", "line"});
  const bool big = msg.is_bigendian != 0;
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const std::uint8_t* data = pointAt(msg, i);
    atlas::LidarPoint& p = sweep.points[i];
    p.x = static_cast<float>(read(x, data, big));
    p.y = static_cast<float>(read(y, data, big));
    p.z = static_cast<float>(read(z, data, big));
    if (p.x == 0 && p.y == 0 && p.z == 0) p.x = p.y = p.z = std::numeric_limits<float>::quiet_NaN();
    if (intensity != nullptr) p.intensity = static_cast<float>(read(*intensity, data, big));
    if (ring != nullptr) p.ring = static_cast<std::uint16_t>(read(*ring, data, big));
  }
  readTimes(msg, sweep);
}

}  // namespace

sensor_msgs::PointCloud2 toCloud(const std::vector<atlas::LidarPoint>& points, atlas::Stamp stamp,
                                 const std::string& frame) {
  sensor_msgs::PointCloud2 msg;
  msg.header.stamp = toTime(stamp);
  msg.header.frame_id = frame;
  msg.height = 1;
  msg.width = static_cast<std::uint32_t>(points.size());
  msg.fields = {field("x", 0, PointField::FLOAT32),     field("y", 4, PointField::FLOAT32),
                field("z", 8, PointField::FLOAT32),     field("intensity", 12, PointField::FLOAT32),
                field("time", 16, PointField::FLOAT32), field("ring", 20, PointField::UINT16)};
  msg.is_bigendian = false;
  msg.point_step = sizeof(atlas::LidarPoint);
  msg.row_step = msg.point_step * msg.width;
  msg.is_dense = false;
  msg.data.resize(static_cast<std::size_t>(msg.row_step));
  if (!points.empty()) std::memcpy(msg.data.data(), points.data(), msg.data.size());
  return msg;
}

sensor_msgs::PointCloud2 toMsg(const atlas::Sweep& sweep) {
  return toCloud(sweep.points, sweep.stamp, sweep.frame);
}

atlas::Outcome<atlas::SweepPtr> fromMsg(const sensor_msgs::PointCloud2& msg) {
  auto sweep = std::make_shared<atlas::Sweep>();
  sweep->stamp = fromTime(msg.header.stamp);
  sweep->frame = msg.header.frame_id;
  const std::size_t count = static_cast<std::size_t>(msg.width) * msg.height;
  if (count == 0) return atlas::SweepPtr(sweep);
  const std::size_t row_bytes = static_cast<std::size_t>(msg.width) * msg.point_step;
  const bool short_data =
      msg.row_step < row_bytes ||
      msg.data.size() < static_cast<std::size_t>(msg.height - 1) * msg.row_step + row_bytes;
  if (short_data) return atlas::Reason::kBadLayout;
  sweep->points.resize(count);
  if (isOurLayout(msg) && !msg.is_bigendian && msg.row_step == row_bytes) {
    std::memcpy(sweep->points.data(), msg.data.data(), count * sizeof(atlas::LidarPoint));
    return atlas::SweepPtr(sweep);
  }
  const PointField* x = find(msg, {"x"});
  const PointField* y = find(msg, {"y"});
  const PointField* z = find(msg, {"z"});
  if (x == nullptr || y == nullptr || z == nullptr) return atlas::Reason::kBadLayout;
  readForeign(msg, *x, *y, *z, *sweep);
  return atlas::SweepPtr(sweep);
}

}  // namespace atlas_ros
