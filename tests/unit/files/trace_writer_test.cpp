// SPDX-License-Identifier: MIT
#include "files/trace_writer.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace atlas {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream stream(file);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(TraceWriter, RowsOfAllInputsInOrderOfStampsAndObjectsThatWereMeasured) {
  const fs::path out = fs::path(testing::TempDir()) / "trace_writer_test";
  fs::remove_all(out);
  {
    TraceWriterStage stage(out);
    stage.push(TraceWriterStage::kDepth, {"camera_ir/depth/image", 3, 20, {{"odometry", 20, {}, {}}}});
    stage.push(TraceWriterStage::kThermal, {"camera_ir/projected_detections", 3, 10, {}});
    auto objects = std::make_shared<Objects>();
    objects->stamp = 15;
    objects->objects.resize(2);
    objects->objects[0].id = 7;  // coasts: nothing was measured
    objects->objects[1].id = 17;
    objects->objects[1].sources.push_back({"obstacles", 14, {}, 2});
    stage.push(objects);
    EXPECT_FALSE(fs::exists(out / "trace/origins.csv")) << "not before it is complete";
    for (std::size_t i = 0; i < stage.inputs(); ++i) stage.finish(i);
    EXPECT_EQ(stage.counters().get("products"), 3U);
  }
  EXPECT_EQ(contentOf(out / "trace/origins.csv"),
            "product,index,stamp_ns,origins\n"
            "camera_ir/projected_detections,3,10,\n"
            "objects/17,0,15,obstacles#/2@-1\n"
            "camera_ir/depth/image,3,20,odometry#@0\n");
}

}  // namespace
}  // namespace atlas
