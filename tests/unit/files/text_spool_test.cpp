// SPDX-License-Identifier: MIT
#include "files/text_spool.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace atlas {
namespace {

namespace fs = std::filesystem;

TEST(TextSpool, everythingInItsOrderHoweverLong) {
  const fs::path folder = fs::path(testing::TempDir()) / "text_spool";
  fs::remove_all(folder);
  for (const int lines : {0, 1, 40000}) {
    std::string expected;
    TextSpool spool(folder);
    for (int i = 0; i < lines; ++i) {
      const std::string line = "line " + std::to_string(i) + "\n";
      expected += line;
      spool.append(line);
    }
    EXPECT_EQ(spool.empty(), lines == 0);
    OutputFile file(folder / "text");
    spool.copyTo(file);
    file.commit();
    std::ostringstream content;
    content << std::ifstream(folder / "text").rdbuf();
    EXPECT_EQ(content.str(), expected);
  }
  fs::remove(folder / "text");
  EXPECT_TRUE(fs::is_empty(folder)) << "the temporary file has no name";
  fs::remove_all(folder);
}

}  // namespace
}  // namespace atlas
