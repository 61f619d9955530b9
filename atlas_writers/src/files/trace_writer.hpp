// SPDX-License-Identifier: MIT
// Stage: trace/origins.csv, what each product was made from (atlas/output/origins_csv.hpp).
#pragma once

#include <filesystem>
#include <memory>

#include "atlas/base/stage.hpp"
#include "atlas/sensor/products.hpp"
#include "files/output_file.hpp"

namespace atlas {

struct TraceWriterParams {};

class TraceWriterStage : public Stage {
 public:
  /// One input for each stage that tells its origins.
  enum Input : std::size_t { kCameraLidar, kThermal, kDepth };
  explicit TraceWriterStage(const std::filesystem::path& out);
  ~TraceWriterStage() override;
  void push(std::size_t input, const ProductOrigins& product);

 private:
  void onEnd() override;
  std::unique_ptr<OutputFile> file_;  ///< null once it is complete
};

}  // namespace atlas
