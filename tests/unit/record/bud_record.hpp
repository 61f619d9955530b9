// SPDX-License-Identifier: MIT
// A small record of the Brno Urban Dataset on disk for each test.
#pragma once

#include <gtest/gtest.h>

#include "drained.hpp"
#include "small_video.hpp"

namespace atlas::record {

class BudRecord : public ::testing::Test {
 protected:
  void SetUp() override { test::writeSmallRecord(folder_); }
  [[nodiscard]] std::string lines(const std::string& name) const { return folder_.read(name); }
  test::TemporaryFolder folder_;
};

}  // namespace atlas::record
