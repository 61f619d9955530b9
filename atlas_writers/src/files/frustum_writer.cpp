// SPDX-License-Identifier: MIT
#include "files/frustum_writer.hpp"

#include "atlas/output/frustum_csv.hpp"

namespace atlas {

void FrustumWriter::write(const Frustums& frustums) {
  auto& file = files_[frustums.camera];
  if (!file) {
    file = std::make_unique<OutputFile>(out_ / "frustums" / (frustums.camera + ".csv"));
    file->write(frustumCsvHeader());
  }
  file->write(frustumCsvRows(frustums));
}

void FrustumWriter::close() {
  for (auto& [camera, file] : files_) file->commit();
  files_.clear();
}

}  // namespace atlas
