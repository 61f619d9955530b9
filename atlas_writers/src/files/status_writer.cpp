// SPDX-License-Identifier: MIT
#include "files/status_writer.hpp"

#include <cstdio>

#include "atlas/output/status_csv.hpp"

namespace atlas {

StatusWriterStage::StatusWriterStage(const std::filesystem::path& out)
    : Stage("status_writer", {"sensor_status"}),
      file_(std::make_unique<OutputFile>(out / "sensors" / "status.csv")) {
  file_->write(statusCsvHeader());
}

StatusWriterStage::~StatusWriterStage() {
  try {
    StatusWriterStage::onEnd();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "status_writer: %s\n", error.what());
  }
}

void StatusWriterStage::push(const SensorStatus& status) {
  enqueue(0, status.stamp, [this, status] {
    file_->write(statusCsvRow(status));
    counters_.add("status");
  });
}

void StatusWriterStage::onEnd() {
  if (file_) file_->commit();
  file_.reset();
}

}  // namespace atlas
