// SPDX-License-Identifier: MIT
// Point clouds in all three kinds of PCD data, and damaged ones.
#include "record/pcd.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "small_record.hpp"

namespace atlas::record {
namespace {

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string header(const std::string& fields, const std::string& size, const std::string& type,
                   const std::string& count, int points, const std::string& data) {
  return "VERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type + "\nCOUNT " + count +
         "\nWIDTH " + std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
         std::to_string(points) + "\nDATA " + data + "\n";
}

TEST(Pcd, Binary) {
  const PcdCloud cloud = parsePcd(test::pcdText({{1, 2, 3, 4}, {-5, 6, 7, 8}}));
  ASSERT_EQ(cloud.error, "");
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[1].x, -5.0F);
  EXPECT_EQ(cloud.points[1].intensity, 8.0F);
  EXPECT_FALSE(cloud.has_ring);
  EXPECT_TRUE(cloud.time_s.empty());
}

TEST(Pcd, AsciiWithOtherFieldsBetween) {
  const PcdCloud cloud =
      parsePcd(header("x normal y z ring", "4 4 4 4 2", "F F F F U", "1 3 1 1 1", 2, "ascii") +
               "1 9 9 9 2 3 31\r\n\n4 9 9 9 5 nan 0\n");
  ASSERT_EQ(cloud.error, "");
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0].y, 2.0F);
  EXPECT_EQ(cloud.points[0].ring, 31);
  EXPECT_TRUE(cloud.has_ring);
  EXPECT_TRUE(std::isnan(cloud.points[1].z));
}

TEST(Pcd, BinaryCompressedIsStoredFieldByField) {
  std::string columns;
  for (const float v : {1.F, 4.F, 2.F, 5.F, 3.F, 6.F}) append(columns, v);
  std::string packed;  // LZF: runs of at most 32 literal bytes
  append(packed, static_cast<std::uint8_t>(columns.size() - 1));
  packed += columns;
  std::string bytes = header("x y z", "4 4 4", "F F F", "1 1 1", 2, "binary_compressed");
  append(bytes, static_cast<std::uint32_t>(packed.size()));
  append(bytes, static_cast<std::uint32_t>(columns.size()));
  const PcdCloud cloud = parsePcd(bytes + packed);
  ASSERT_EQ(cloud.error, "");
  EXPECT_EQ(cloud.points[0].z, 3.0F);
  EXPECT_EQ(cloud.points[1].x, 4.0F);
  EXPECT_EQ(parsePcd(bytes + packed.substr(0, packed.size() - 1)).error, "PCD data cut or damaged");
}

TEST(Pcd, LzfBackReferences) {
  std::string out;
  // literal "ab", then 4 bytes from 2 back: "abab" -> "ababab"
  EXPECT_TRUE(decompressLzf(std::string("\x01"
                                        "ab"
                                        "\x40\x01",
                                        5),
                            6, out));
  EXPECT_EQ(out, "ababab");
  EXPECT_FALSE(decompressLzf(std::string("\x40\x01", 2), 4, out)) << "reference before the begin";
  EXPECT_FALSE(decompressLzf(std::string("\x01"
                                         "a",
                                         2),
                             2, out))
      << "run beyond the end";
}

TEST(Pcd, TimeFields) {
  std::string bytes = header("x y z t", "4 4 4 4", "F F F U", "1 1 1 1", 2, "binary");
  for (const std::uint32_t t : {0U, 50'000'000U}) {
    for (int i = 0; i < 3; ++i) append(bytes, 1.0F);
    append(bytes, t);
  }
  const PcdCloud offsets = parsePcd(bytes);
  ASSERT_EQ(offsets.time_s.size(), 2U);
  EXPECT_NEAR(offsets.time_s[1], 0.05, 1e-9) << "integers are nanoseconds";
  EXPECT_FALSE(offsets.absolute_time);

  bytes = header("x y z timestamp", "4 4 4 8", "F F F F", "1 1 1 1", 1, "binary");
  for (int i = 0; i < 3; ++i) append(bytes, 1.0F);
  append(bytes, 1568186745.4);
  EXPECT_TRUE(parsePcd(bytes).absolute_time);
}

TEST(Pcd, DamagedFilesSayWhatIsWrong) {
  const std::string good = test::pcdText({{1, 2, 3, 4}, {5, 6, 7, 8}});
  EXPECT_EQ(parsePcd("").error, "no PCD header");
  EXPECT_EQ(parsePcd(std::string(100000, 'x')).error, "no PCD header");
  EXPECT_EQ(parsePcd(good.substr(0, good.size() - 1)).error, "PCD data cut or damaged");
  EXPECT_EQ(parsePcd(header("x y", "4 4", "F F", "1 1", 1, "ascii") + "1 2\n").error,
            "PCD without fields x, y, z");
  EXPECT_EQ(parsePcd(header("x y z", "4 4 4", "F F F", "1 1 1", 1, "ascii") + "1 2\n").error,
            "PCD data cut or damaged");
  EXPECT_EQ(parsePcd(header("x y z", "4 4 4", "F F F", "1 1 1", 1, "zip") + std::string(50, 'x')).error,
            "unknown PCD DATA 'zip'");
  EXPECT_NE(
      parsePcd(header("x y z", "4 4", "F F F", "1 1 1", 1, "ascii")).error.find("bad PCD header line 'SIZE"),
      std::string::npos);
  EXPECT_NE(parsePcd(header("x y z", "4 4 4", "F F F", "1 1 1", 2'000'000'000, "binary")).error.find("WIDTH"),
            std::string::npos)
      << "a size that no lidar has";
}

TEST(Pcd, EmptyCloudIsGood) {
  const PcdCloud cloud = parsePcd(test::pcdText({}));
  EXPECT_EQ(cloud.error, "");
  EXPECT_TRUE(cloud.points.empty());
}

}  // namespace
}  // namespace atlas::record
