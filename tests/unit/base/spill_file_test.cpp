// SPDX-License-Identifier: MIT
#include "atlas/base/spill_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <stdexcept>
#include <string>

namespace atlas {
namespace {

namespace fs = std::filesystem;

fs::path freshFolder(const std::string& name) {
  const fs::path folder = fs::path(::testing::TempDir()) / name;
  fs::remove_all(folder);
  return folder;
}

template <class Call>
std::string refusal(const Call& call) {
  try {
    call();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(SpillFile, GivesBackWhatWasWrittenAnywhere) {
  const fs::path folder = freshFolder("spill_file") / "made" / "too";
  SpillFile file(folder);
  file.write(1000, "later", 5);
  file.write(0, "first", 5);
  file.write(1002, "TE", 2);
  char found[6] = {};
  file.read(1000, found, 5);
  EXPECT_STREQ(found, "laTEr");
  file.read(0, found, 5);
  EXPECT_STREQ(found, "first");
  EXPECT_TRUE(fs::is_empty(folder)) << "a name in the folder would stay after a crash";
}

TEST(SpillFile, NamesTheFolderThatItCannotUse) {
  const fs::path folder = freshFolder("spill_no_folder");
  std::ofstream(folder) << "a file";
  EXPECT_NE(refusal([&] { SpillFile file(folder / "below"); }).find((folder / "below").string()),
            std::string::npos);
}

TEST(SpillFile, WhatIsNotThereCannotBeRead) {
  const fs::path folder = freshFolder("spill_short");
  SpillFile file(folder);
  char byte = 0;
  EXPECT_NE(refusal([&] {
              file.read(7, &byte, 1);
            }).find("cannot read byte 7 of a temporary file in " + folder.string()),
            std::string::npos);
}

TEST(SpillFile, RefusedWritesSayWhereAndWhy) {
  const fs::path folder = freshFolder("spill_full");
  SpillFile file(folder);
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100, before.rlim_max};  // bytes: a file may not grow further, as on a full disk
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::string reason = refusal([&] { file.write(0, std::string(200, 'x').data(), 200); });
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(reason, "cannot write byte 100 of a temporary file in " + folder.string() + ": File too large");
}

}  // namespace
}  // namespace atlas
