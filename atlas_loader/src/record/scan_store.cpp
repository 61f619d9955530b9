// SPDX-License-Identifier: MIT
#include "record/scan_store.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <fstream>
#include <map>

#include "record/scan_zip.hpp"
#include "record/text_rows.hpp"

namespace atlas::record {
namespace {
namespace fs = std::filesystem;
class FolderStore : public ScanStore {
 public:
  FolderStore(const fs::path& folder, std::string place) : place_(std::move(place)) {
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      const auto index = scanIndex(it->path().filename().string());
      if (!index) continue;
      const auto [entry, first] = files_.emplace(*index, it->path());
      if (first) continue;
      entry->second = std::min(entry->second, it->path());  // whatever the order of the disk
      ++repeated_;
    }
    for (const auto& [index, path] : files_) indices_.push_back(index);
  }
  [[nodiscard]] const std::vector<std::uint32_t>& indices() const override { return indices_; }
  [[nodiscard]] std::string place() const override { return place_; }
  [[nodiscard]] std::uint64_t repeated() const override { return repeated_; }
  ScanBytes read(std::uint32_t index) override {
    const auto it = files_.find(index);
    if (it == files_.end()) return {"", "scan missing"};
    std::ifstream file(it->second, std::ios::binary | std::ios::ate);
    const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
    if (size < 0 || static_cast<std::uint64_t>(size) > kMaxScan) return {"", "scan unreadable"};
    ScanBytes scan{std::string(static_cast<std::size_t>(size), '\0'), ""};
    file.seekg(0);
    file.read(scan.bytes.data(), size);
    return file.gcount() == size ? scan : ScanBytes{"", "scan unreadable"};
  }

 private:
  std::string place_;
  std::map<std::uint32_t, fs::path> files_;
  std::vector<std::uint32_t> indices_;
  std::uint64_t repeated_ = 0;
};

struct ArchiveClose {
  void operator()(archive* a) const { archive_read_free(a); }
};
using ArchivePtr = std::unique_ptr<archive, ArchiveClose>;

/// An archive without its directory, which is at its end: walks the members forwards (skipping one costs a
/// header) and starts again when an earlier one is wanted.
class CutZipStore : public ScanStore {
 public:
  explicit CutZipStore(fs::path path) : path_(std::move(path)) {
    std::uint32_t member = 0;
    open();
    while (archive_entry* entry = nextEntry()) {
      const char* name = archive_entry_pathname(entry);
      const auto index = name ? scanIndex(name) : std::nullopt;
      if (index && !member_of_.emplace(*index, member).second) ++repeated_;
      ++member;
    }
    listing_error_ = error_;
    for (const auto& [index, place] : member_of_) indices_.push_back(index);
    archive_.reset();
  }
  [[nodiscard]] const std::vector<std::uint32_t>& indices() const override { return indices_; }
  [[nodiscard]] std::string listingError() const override { return listing_error_; }
  [[nodiscard]] std::string place() const override { return "scans.zip"; }
  [[nodiscard]] std::uint64_t repeated() const override { return repeated_; }

  ScanBytes read(std::uint32_t index) override {
    const auto it = member_of_.find(index);
    if (it == member_of_.end()) return {"", "scan missing"};
    if (!archive_ || it->second < next_member_) open();
    archive_entry* entry = nullptr;
    while (next_member_ <= it->second) {
      entry = nextEntry();
      if (!entry) return fail("zip member unreachable", true);
      ++next_member_;
    }
    ScanBytes scan;
    char chunk[1 << 16];
    while (true) {
      const la_ssize_t got = archive_read_data(archive_.get(), chunk, sizeof(chunk));
      if (got == 0) return scan;
      if (got < 0) return fail("zip member damaged", got == ARCHIVE_FATAL);
      scan.bytes.append(chunk, static_cast<std::size_t>(got));
      if (scan.bytes.size() > kMaxScan) return fail("zip member too large", false);
    }
  }

 private:
  void open() {
    archive_.reset(archive_read_new());
    next_member_ = 0;
    error_.clear();
    archive_read_support_format_zip(archive_.get());
    if (archive_read_open_filename(archive_.get(), path_.c_str(), 1 << 16) != ARCHIVE_OK) {
      setError();
      archive_.reset();
    }
  }
  archive_entry* nextEntry() {
    if (!archive_) return nullptr;
    archive_entry* entry = nullptr;
    const int result = archive_read_next_header(archive_.get(), &entry);
    if (result == ARCHIVE_OK || result == ARCHIVE_WARN) return entry;
    if (result != ARCHIVE_EOF) setError();
    return nullptr;
  }
  ScanBytes fail(const std::string& reason, bool fatal) {
    if (fatal) archive_.reset();  // its state is unknown: the next read starts from the beginning
    return {"", reason};
  }
  void setError() {
    const char* text = archive_error_string(archive_.get());
    error_ = text ? text : "cannot be read";
  }

  fs::path path_;
  ArchivePtr archive_;
  std::uint32_t next_member_ = 0;
  std::map<std::uint32_t, std::uint32_t> member_of_;  ///< scan number -> place in the archive
  std::vector<std::uint32_t> indices_;
  std::uint64_t repeated_ = 0;
  std::string error_, listing_error_;
};
}  // namespace

std::optional<std::uint32_t> scanIndex(const std::string& file_name) {
  const std::string name = fs::path(file_name).filename().string();
  if (name.size() < 9 || name.rfind("scan", 0) != 0 || name.substr(name.size() - 4) != ".pcd")
    return std::nullopt;
  const auto value = toUnsigned(std::string_view(name).substr(4, name.size() - 8));
  if (!value || *value > 0x7fffffff) return std::nullopt;
  return static_cast<std::uint32_t>(*value);
}

std::unique_ptr<ScanStore> openScanStore(const fs::path& sensor_folder) {
  std::error_code error;
  for (const char* place : {"", "scans"}) {
    const fs::path folder = *place ? sensor_folder / place : sensor_folder;
    if (!fs::is_directory(folder, error)) continue;
    auto store = std::make_unique<FolderStore>(folder, place);
    if (!store->indices().empty()) return store;
  }
  if (fs::is_regular_file(sensor_folder / "scans.zip", error)) {
    auto store = openScanZip(sensor_folder / "scans.zip");
    return store ? std::move(store) : std::make_unique<CutZipStore>(sensor_folder / "scans.zip");
  }
  return nullptr;
}

}  // namespace atlas::record
