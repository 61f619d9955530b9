// SPDX-License-Identifier: MIT
#include "synthetic/scan_files.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace atlas::synthetic {
namespace {

std::string numbered(const char* format, int index) {
  char name[64];
  std::snprintf(name, sizeof name, format, index);
  return name;
}

void check(int result, archive* zip) {
  if (result < ARCHIVE_WARN) throw std::runtime_error(std::string("scans.zip: ") + archive_error_string(zip));
}

}  // namespace

std::string toPcd(const std::vector<LidarReturn>& points) {
  const std::string n = std::to_string(points.size());
  std::string text =
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F "
      "F F F\n"
      "COUNT 1 1 1 1\nWIDTH " +
      n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA binary\n";
  static_assert(sizeof(LidarReturn) == 16, "LidarReturn is written as it lies in memory");
  text.append(reinterpret_cast<const char*>(points.data()), points.size() * sizeof(LidarReturn));
  return text;
}

ScanWriter::ScanWriter(const std::filesystem::path& folder, bool zip) : folder_(folder) {
  std::filesystem::create_directories(folder);
  if (!zip) return;
  zip_ = archive_write_new();
  check(archive_write_set_format_zip(zip_), zip_);
  check(archive_write_set_options(zip_, "compression=deflate,compression-level=1"), zip_);
  check(archive_write_open_filename(zip_, (folder / "scans.zip").c_str()), zip_);
}

ScanWriter::~ScanWriter() {
  if (zip_ != nullptr) archive_write_free(zip_);
}

void ScanWriter::write(int index, const std::vector<LidarReturn>& points) {
  const std::string name = numbered("scan%06d.pcd", index), content = toPcd(points);
  if (zip_ == nullptr) {
    std::ofstream file(folder_ / name, std::ios::binary);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    if (!file) throw std::runtime_error("cannot write " + (folder_ / name).string());
    return;
  }
  archive_entry* entry = archive_entry_new();
  archive_entry_set_pathname(entry, name.c_str());
  archive_entry_set_size(entry, static_cast<la_int64_t>(content.size()));
  archive_entry_set_filetype(entry, AE_IFREG);
  archive_entry_set_perm(entry, 0644);
  archive_entry_set_mtime(entry, 1568186745, 0);  // the day of the record, not of the run
  const int result = archive_write_header(zip_, entry);
  archive_entry_free(entry);
  check(result, zip_);
  if (archive_write_data(zip_, content.data(), content.size()) < 0) check(ARCHIVE_FATAL, zip_);
}

void ScanWriter::close() {
  if (zip_ == nullptr) return;
  check(archive_write_close(zip_), zip_);
  archive_write_free(zip_);
  zip_ = nullptr;
}

void writeTruthPoints(const std::filesystem::path& path, const std::vector<TruthPoint>& points) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream file(path, std::ios::binary);
  static_assert(sizeof(TruthPoint) == 16, "TruthPoint is written as it lies in memory");
  file.write(reinterpret_cast<const char*>(points.data()),
             static_cast<std::streamsize>(points.size() * sizeof(TruthPoint)));
  if (!file) throw std::runtime_error("cannot write " + path.string());
}

std::vector<TruthPoint> readTruthPoints(const std::filesystem::path& path) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(path, error);
  if (error || bytes % sizeof(TruthPoint) != 0) return {};
  std::vector<TruthPoint> points(bytes / sizeof(TruthPoint));
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(points.data()), static_cast<std::streamsize>(bytes));
  return file ? points : std::vector<TruthPoint>{};
}

}  // namespace atlas::synthetic
