// SPDX-License-Identifier: MIT
// Stage: trace/origins.csv, what each product was made from (atlas/output/origins_csv.hpp). An object is the
// product objects/<id>, with a row for each update in which something was measured.
#pragma once

#include <filesystem>
#include <memory>

#include "atlas/base/stage.hpp"
#include "atlas/sensor/object.hpp"
#include "atlas/sensor/products.hpp"
#include "files/output_file.hpp"

namespace atlas {

struct TraceWriterParams {};

class TraceWriterStage : public Stage {
 public:
  /// One input for each stage that tells its origins.
  enum Input : std::size_t { kCameraLidar, kThermal, kDepth, kObjects };
  explicit TraceWriterStage(const std::filesystem::path& out);
  ~TraceWriterStage() override;
  void push(std::size_t input, const ProductOrigins& product);
  void push(const ObjectsPtr& objects);

 private:
  void onEnd() override;
  void write(const ProductOrigins& product);
  std::unique_ptr<OutputFile> file_;  ///< null once it is complete
  std::uint32_t updates_ = 0;         ///< of the objects
};

}  // namespace atlas
