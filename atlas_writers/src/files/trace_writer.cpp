// SPDX-License-Identifier: MIT
#include "files/trace_writer.hpp"

#include <cstdio>

#include "atlas/output/origins_csv.hpp"

namespace atlas {

TraceWriterStage::TraceWriterStage(const std::filesystem::path& out)
    : Stage("trace_writer", {"camera_lidar/origins", "thermal/origins", "depth/origins", "objects"}),
      file_(std::make_unique<OutputFile>(out / "trace" / "origins.csv")) {
  file_->write(originsCsvHeader());
}

TraceWriterStage::~TraceWriterStage() {
  try {
    TraceWriterStage::onEnd();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "trace_writer: %s\n", error.what());
  }
}

void TraceWriterStage::push(std::size_t input, const ProductOrigins& product) {
  enqueue(input, product.stamp, [this, product] { write(product); });
}

void TraceWriterStage::push(const ObjectsPtr& objects) {
  const std::uint32_t update = updates_++;
  enqueue(kObjects, objects->stamp, [this, objects, update] {
    for (const Object& object : objects->objects) {
      if (object.sources.empty()) continue;
      write({"objects/" + std::to_string(object.id), update, objects->stamp, object.sources});
    }
  });
}

void TraceWriterStage::write(const ProductOrigins& product) {
  file_->write(originsCsvRow(product));
  counters_.add("products");
}

void TraceWriterStage::onEnd() {
  if (file_) file_->commit();
  file_.reset();
}

}  // namespace atlas
