// SPDX-License-Identifier: MIT
// Stage: sensors/status.csv, one row per status of the sensor monitor (atlas/output/status_csv.hpp).
#pragma once

#include <filesystem>
#include <memory>

#include "atlas/base/stage.hpp"
#include "atlas/sensor/products.hpp"
#include "files/output_file.hpp"

namespace atlas {

struct StatusWriterParams {};

class StatusWriterStage : public Stage {
 public:
  explicit StatusWriterStage(const std::filesystem::path& out);
  ~StatusWriterStage() override;
  void push(const SensorStatus& status);

 private:
  void onEnd() override;
  std::unique_ptr<OutputFile> file_;  ///< null once it is complete
};

}  // namespace atlas
