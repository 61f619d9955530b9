// SPDX-License-Identifier: MIT
#include "atlas/output/ply.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "atlas/output/pcd.hpp"

namespace atlas {
namespace {

TEST(Ply, theWholeHeader) {
  EXPECT_EQ(mapPlyHeader(12),
            "ply\n"
            "format binary_little_endian 1.0\n"
            "comment frame map, east north up, m; count: returns per voxel\n"
            "element vertex 12\n"
            "property float x\n"
            "property float y\n"
            "property float z\n"
            "property float intensity\n"
            "property uint count\n"
            "end_header\n");
}

// What a reader does: the properties in their order must add up to the record that is written, a MapPoint.
TEST(Ply, propertiesDescribeTheRecord) {
  for (const bool coloured : {false, true}) {
    std::istringstream header(mapPlyHeader(1, coloured));
    std::size_t bytes = 0;
    std::vector<std::string> names;
    for (std::string word; header >> word;) {
      if (word != "property") continue;
      std::string type, name;
      header >> type >> name;
      EXPECT_TRUE(type == "float" || type == "uint" || type == "uchar") << type;
      bytes += type == "uchar" ? 1 : 4;
      names.push_back(name);
    }
    EXPECT_EQ(bytes, mapRecords({MapPoint()}, coloured).size());
    std::vector<std::string> expected = {"x", "y", "z", "intensity", "count"};
    if (coloured) expected.insert(expected.end(), {"blue", "green", "red", "alpha"});
    EXPECT_EQ(names, expected);
  }
}

TEST(Ply, noPointsAndVeryMany) {
  EXPECT_NE(mapPlyHeader(0).find("element vertex 0\n"), std::string::npos);
  EXPECT_NE(mapPlyHeader(5'000'000'000).find("element vertex 5000000000\n"), std::string::npos);
}

}  // namespace
}  // namespace atlas
