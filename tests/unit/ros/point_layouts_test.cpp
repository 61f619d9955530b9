// SPDX-License-Identifier: MIT
// The PointCloud2 layouts of the usual lidars and drivers, and clouds of odd shapes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

#include "atlas_ros/point_cloud.hpp"

namespace {

using sensor_msgs::PointField;

constexpr int kColumns = 200;

struct FieldSpec {
  const char* name;
  std::uint8_t type;
  std::uint32_t offset;
};

/// One layout, and how its driver writes the time of a column (0 .. 0.1 s) and orders the points.
struct Layout {
  const char* name;
  int rings;
  std::uint32_t point_step;
  std::vector<FieldSpec> fields;
  const char* ring_field;                 ///< nullptr: none
  const char* time_field;                 ///< nullptr: none
  std::function<double(double)> time_of;  ///< s after the begin of the sweep -> raw value
  double stamp_after_begin_s;             ///< of the message
  bool organized_by_ring;                 ///< height = rings, else one row column by column
  double tolerance_s;
};

constexpr double kBegin_s = 1'500'000'000.25;
constexpr auto F32 = PointField::FLOAT32;
constexpr auto F64 = PointField::FLOAT64;
constexpr auto U8 = PointField::UINT8;
constexpr auto U16 = PointField::UINT16;
constexpr auto U32 = PointField::UINT32;

std::vector<FieldSpec> xyz(std::vector<FieldSpec> more) {
  more.insert(more.begin(), {{"x", F32, 0}, {"y", F32, 4}, {"z", F32, 8}});
  return more;
}

std::vector<Layout> layouts() {
  const auto seconds = [](double t) { return t; };
  const auto before_end = [](double t) { return t - 0.1; };
  const auto ns = [](double t) { return std::round(t * 1e9); };
  const auto unix_s = [](double t) { return kBegin_s + t; };
  const auto unix_ns = [](double t) { return (kBegin_s + t) * 1e9; };
  const auto packed = xyz({{"intensity", F32, 12}, {"ring", U16, 16}, {"time", F32, 18}});
  const auto padded = xyz({{"intensity", F32, 16}, {"ring", U16, 20}, {"time", F32, 24}});
  const auto ouster = xyz({{"intensity", F32, 16},
                           {"t", U32, 20},
                           {"reflectivity", U16, 24},
                           {"ring", U8, 26},
                           {"ambient", U16, 28},
                           {"range", U32, 32}});
  const auto livox = xyz({{"intensity", F32, 12}, {"tag", U8, 16}, {"line", U8, 17}, {"timestamp", F64, 18}});
  const auto offset = xyz({{"offset_time", U32, 12}, {"reflectivity", U8, 16}, {"line", U8, 18}});
  const auto hesai = xyz({{"intensity", F32, 16}, {"timestamp", F64, 24}, {"ring", U16, 32}});
  return {
      {"VLP-16, velodyne_pointcloud", 16, 22, packed, "ring", "time", seconds, 0.0, false, 1e-8},
      {"VLP-16, stamped at the end", 16, 22, packed, "ring", "time", before_end, 0.1, false, 1e-8},
      {"HDL-32E, padded for PCL", 32, 32, padded, "ring", "time", before_end, 0.1, false, 1e-8},
      {"HDL-32E, organized", 32, 32, padded, "ring", "time", before_end, 0.1, true, 1e-8},
      {"HDL-64E, x y z i only", 64, 16, xyz({{"i", F32, 12}}), nullptr, nullptr, nullptr, 0.1, false, 6e-4},
      {"Ouster OS1-64", 64, 48, ouster, "ring", "t", ns, 0.0, true, 1e-8},
      {"Livox, ros driver 2", 4, 26, livox, "line", "timestamp", unix_ns, 0.0, false, 1e-6},
      {"Livox, custom message converted", 4, 20, offset, "line", "offset_time", ns, 0.0, false, 1e-8},
      {"Hesai", 40, 40, hesai, "ring", "timestamp", unix_s, 0.0, false, 1e-6},
  };
}

template <class T>
void store(std::uint8_t* to, double value) {
  const T stored = static_cast<T>(value);
  std::memcpy(to, &stored, sizeof stored);
}

void write(const Layout& layout, const std::string& name, double value, std::uint8_t* point) {
  for (const FieldSpec& field : layout.fields) {
    if (name != field.name) continue;
    std::uint8_t* to = point + field.offset;
    if (field.type == F32) store<float>(to, value);
    if (field.type == F64) store<double>(to, value);
    if (field.type == U8) store<std::uint8_t>(to, value);
    if (field.type == U16) store<std::uint16_t>(to, value);
    if (field.type == U32) store<std::uint32_t>(to, value);
  }
}

double columnTime(int column) { return 0.1 * (column + 0.5) / kColumns; }

/// Clockwise from the front, 10 m away.
void writePoint(const Layout& layout, int column, int ring, std::uint8_t* point) {
  const double azimuth = -2 * M_PI * columnTime(column) / 0.1;
  write(layout, "x", 10 * std::cos(azimuth), point);
  write(layout, "y", 10 * std::sin(azimuth), point);
  write(layout, "z", 0.1 * ring, point);
  if (layout.ring_field != nullptr) write(layout, layout.ring_field, ring, point);
  if (layout.time_field != nullptr)
    write(layout, layout.time_field, layout.time_of(columnTime(column)), point);
}

sensor_msgs::PointCloud2 cloudOf(const Layout& layout) {
  sensor_msgs::PointCloud2 msg;
  msg.header.stamp = ros::Time(kBegin_s + layout.stamp_after_begin_s);
  msg.header.frame_id = "lidar";
  for (const FieldSpec& spec : layout.fields) {
    PointField field;
    field.name = spec.name;
    field.offset = spec.offset;
    field.datatype = spec.type;
    field.count = 1;
    msg.fields.push_back(field);
  }
  const auto points = static_cast<std::uint32_t>(kColumns * layout.rings);
  msg.height = layout.organized_by_ring ? static_cast<std::uint32_t>(layout.rings) : 1;
  msg.width = points / msg.height;
  msg.point_step = layout.point_step;
  msg.row_step = msg.width * msg.point_step + (layout.organized_by_ring ? 12 : 0);  // rows may be padded
  msg.data.assign(static_cast<std::size_t>(msg.row_step) * msg.height, 0xAB);
  for (int column = 0; column < kColumns; ++column) {
    for (int ring = 0; ring < layout.rings; ++ring) {
      const std::size_t at = layout.organized_by_ring
                                 ? static_cast<std::size_t>(ring) * msg.row_step +
                                       static_cast<std::size_t>(column) * msg.point_step
                                 : static_cast<std::size_t>(column * layout.rings + ring) * msg.point_step;
      writePoint(layout, column, ring, &msg.data[at]);
    }
  }
  return msg;
}

TEST(PointLayouts, EveryDriversPointsRingsAndTimesAreRead) {
  for (const Layout& layout : layouts()) {
    SCOPED_TRACE(layout.name);
    const auto sweep = atlas_ros::fromMsg(cloudOf(layout));
    ASSERT_TRUE(sweep);
    ASSERT_EQ((*sweep)->points.size(), static_cast<std::size_t>(kColumns * layout.rings));
    for (int i = 0; i < kColumns * layout.rings; ++i) {
      const int column = layout.organized_by_ring ? i % kColumns : i / layout.rings;
      const int ring = layout.organized_by_ring ? i / kColumns : i % layout.rings;
      const atlas::LidarPoint& p = (*sweep)->points[static_cast<std::size_t>(i)];
      ASSERT_NEAR(std::hypot(p.x, p.y), 10.0, 1e-5);
      ASSERT_NEAR(p.z, 0.1 * ring, 1e-5);
      if (layout.ring_field != nullptr) {
        ASSERT_EQ(p.ring, ring);
      }
      ASSERT_NEAR(p.time, columnTime(column) - layout.stamp_after_begin_s, layout.tolerance_s) << i;
    }
  }
}

TEST(PointLayouts, ExtraFieldsOfAnyCountArePassedOver) {
  Layout layout = layouts().front();
  layout.fields.insert(layout.fields.begin(), {"echo", PointField::INT16, 24});
  layout.point_step = 40;
  sensor_msgs::PointCloud2 msg = cloudOf(layout);
  PointField block;
  block.name = "waveform";
  block.datatype = U8;
  block.offset = 26;
  block.count = 12;
  msg.fields.insert(msg.fields.begin(), block);
  const auto sweep = atlas_ros::fromMsg(msg);
  ASSERT_TRUE(sweep);
  EXPECT_EQ((*sweep)->points[17].ring, 1);
  EXPECT_NEAR((*sweep)->points[17].time, columnTime(1), 1e-8);
}

TEST(PointLayouts, TwoMillionPointsAreRead) {
  sensor_msgs::PointCloud2 msg = cloudOf(layouts().front());
  const std::vector<std::uint8_t> once = msg.data;
  const std::size_t times = 2'000'000 / msg.width;
  msg.width *= static_cast<std::uint32_t>(times);
  msg.row_step = msg.width * msg.point_step;
  msg.data.clear();
  for (std::size_t i = 0; i < times; ++i) msg.data.insert(msg.data.end(), once.begin(), once.end());
  const auto sweep = atlas_ros::fromMsg(msg);
  ASSERT_TRUE(sweep);
  EXPECT_EQ((*sweep)->points.size(), 2'000'000U);
  EXPECT_NEAR((*sweep)->points.back().time, columnTime(kColumns - 1), 1e-8);
}

TEST(PointLayouts, NoColumnsOrNoRowsIsAnEmptySweep) {
  sensor_msgs::PointCloud2 msg = cloudOf(layouts().front());
  msg.width = 0;
  msg.row_step = 0;
  msg.data.clear();
  const auto sweep = atlas_ros::fromMsg(msg);
  ASSERT_TRUE(sweep);
  EXPECT_TRUE((*sweep)->points.empty());
}

TEST(PointLayouts, WithoutCoordinatesThereIsNoSweep) {
  for (const char* name : {"x", "y", "z"}) {
    sensor_msgs::PointCloud2 msg = cloudOf(layouts().front());
    for (auto& field : msg.fields) {
      if (field.name == name) field.name = "range";
    }
    EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kBadLayout);
  }
}

}  // namespace
