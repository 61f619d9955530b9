// SPDX-License-Identifier: MIT
// frustums/<camera>.csv: stamp,frame,detection,class,confidence,distance,x,y,z (map). One header line.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "atlas/sensor/products.hpp"
#include "files/output_file.hpp"

namespace atlas {

class FrustumWriter {
 public:
  explicit FrustumWriter(std::filesystem::path out) : out_(std::move(out)) {}
  void write(const Frustums& frustums);
  /// Completes the files; nothing happens a second time.
  void close();

 private:
  std::filesystem::path out_;
  std::map<std::string, std::unique_ptr<OutputFile>> files_;  ///< by camera
};

}  // namespace atlas
