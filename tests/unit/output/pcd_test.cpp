// SPDX-License-Identifier: MIT
#include "atlas/output/pcd.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

namespace atlas {
namespace {

LidarPoint somePoint() {
  LidarPoint p;
  p.x = 1.5F;
  p.y = -2.25F;
  p.z = 0.125F;
  p.intensity = 37.0F;
  p.time = -0.0625F;
  p.ring = 31;
  return p;
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

TEST(Pcd, headerAndRecordByHand) {
  const std::string bytes = encodePcd({somePoint()});
  std::string expected =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity time ring\n"
      "SIZE 4 4 4 4 4 2\nTYPE F F F F F U\nCOUNT 1 1 1 1 1 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
      "POINTS 1\nDATA binary\n";
  for (const float value : {1.5F, -2.25F, 0.125F, 37.0F, -0.0625F}) append(expected, value);
  append(expected, std::uint16_t{31});
  EXPECT_EQ(bytes, expected);
}

TEST(Pcd, whatIsWrittenIsReadBitByBit) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> value(-100.0F, 100.0F);
  std::vector<LidarPoint> points(1000);
  for (LidarPoint& p : points) {
    p.x = value(random);
    p.y = value(random);
    p.z = value(random);
    p.intensity = value(random);
    p.time = value(random);
    p.ring = static_cast<std::uint16_t>(random());
  }
  points[17].x = points[17].y = points[17].z = std::numeric_limits<float>::quiet_NaN();
  const auto read = decodePcd(encodePcd(points));
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), points.size());
  EXPECT_EQ(std::memcmp(read->data(), points.data(), points.size() * sizeof(LidarPoint)), 0);
  EXPECT_TRUE(decodePcd(encodePcd({}))->empty());
}

TEST(Pcd, otherFieldsInAnotherOrder) {
  std::string bytes =
      "VERSION .7\nFIELDS normal z rgb y x ring\nSIZE 4 4 4 4 4 1\nTYPE F F U F F U\nCOUNT 3 1 1 1 1 "
      "1\nWIDTH 1\n"
      "HEIGHT 1\nPOINTS 1\nDATA binary\n";
  for (const float value : {9.0F, 9.0F, 9.0F, 3.0F}) append(bytes, value);
  append(bytes, std::uint32_t{77});
  append(bytes, 2.0F);
  append(bytes, 1.0F);
  append(bytes, std::uint8_t{4});
  const auto read = decodePcd(bytes);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->size(), 1U);
  EXPECT_EQ(read->front().x, 1.0F);
  EXPECT_EQ(read->front().y, 2.0F);
  EXPECT_EQ(read->front().z, 3.0F);
  EXPECT_EQ(read->front().ring, 0) << "a ring of one byte is not the ring of this format";
}

TEST(Pcd, whatIsNoSuchFileIsRefused) {
  const std::string good = encodePcd({somePoint(), somePoint()});
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string bytes = good;
    bytes.replace(bytes.find(from), from.size(), to);
    return decodePcd(bytes);
  };
  EXPECT_TRUE(decodePcd(good));
  for (const std::string& bytes :
       {std::string(), std::string("not a cloud"), good.substr(0, 60), good.substr(0, good.size() - 1)}) {
    EXPECT_EQ(decodePcd(bytes).reason(), Reason::kBadLayout) << bytes.size();
  }
  EXPECT_FALSE(changed("DATA binary", "DATA ascii"));
  EXPECT_FALSE(changed("FIELDS x", "FIELDS a"));
  EXPECT_FALSE(changed("SIZE 4 4 4 4 4 2", "SIZE 8 4 4 4 4 2"));
  EXPECT_FALSE(changed("SIZE 4 4 4 4 4 2", "SIZE 4 4 4 4 4"));
  EXPECT_FALSE(changed("TYPE F", "TYPE U"));
  EXPECT_FALSE(changed("POINTS 2", "POINTS 3"));
  EXPECT_FALSE(changed("POINTS 2", "POINTS x"));
  EXPECT_FALSE(changed("POINTS 2", "POINTS 18446744073709551615"));
  EXPECT_FALSE(changed("COUNT 1 1 1 1 1 1", "COUNT 0 0 0 0 0 0"));
}

TEST(Pcd, mapHeaderDescribesTheRecord) {
  std::vector<MapPoint> points;
  for (int i = 0; i < 3; ++i)
    points.push_back({1.0F * static_cast<float>(i), 2.0F, 3.0F, 4.0F, 5, 0xFF102030U});
  for (const bool coloured : {false, true}) {
    const std::string header = mapPcdHeader(3, coloured);
    EXPECT_NE(header.find(coloured ? "FIELDS x y z intensity count rgb\nSIZE 4 4 4 4 4 4\nTYPE F F F F U F\n"
                                   : "FIELDS x y z intensity count\nSIZE 4 4 4 4 4\nTYPE F F F F U\n"),
              std::string::npos);
    EXPECT_NE(header.find("WIDTH 3\n"), std::string::npos);
    const std::string bytes = header + mapRecords(points, coloured);
    const auto read = decodePcd(bytes);
    ASSERT_TRUE(read);
    ASSERT_EQ(read->size(), 3U);
    EXPECT_EQ((*read)[2].x, 2.0F);
    EXPECT_EQ((*read)[2].intensity, 4.0F);
    if (coloured)
      EXPECT_EQ(bytes.substr(bytes.size() - 4), "\x30\x20\x10\xFF") << "little endian ARGB, as PCL";
  }
}

}  // namespace
}  // namespace atlas
