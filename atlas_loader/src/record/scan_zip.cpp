// SPDX-License-Identifier: MIT
#include "record/scan_zip.hpp"

#include <libdeflate.h>
#include <zip.h>

#include <map>
#include <new>
#include <utility>

namespace atlas::record {
namespace {

struct CloseZip {
  void operator()(zip_t* zip) const { zip_discard(zip); }
};
struct CloseMember {
  void operator()(zip_file_t* member) const { zip_fclose(member); }
};
struct FreeDecompressor {
  void operator()(libdeflate_decompressor* d) const { libdeflate_free_decompressor(d); }
};
using ZipPtr = std::unique_ptr<zip_t, CloseZip>;

class ScanZip : public ScanStore {
 public:
  explicit ScanZip(ZipPtr zip) : zip_(std::move(zip)), decompressor_(libdeflate_alloc_decompressor()) {
    if (!decompressor_) throw std::bad_alloc();
    const zip_int64_t members = zip_get_num_entries(zip_.get(), 0);
    for (zip_int64_t member = 0; member < members; ++member) {
      const char* name = zip_get_name(zip_.get(), static_cast<zip_uint64_t>(member), 0);
      const auto index = name ? scanIndex(name) : std::nullopt;
      if (index && !member_of_.emplace(*index, member).second) ++repeated_;
    }
    for (const auto& [index, member] : member_of_) indices_.push_back(index);
  }
  [[nodiscard]] const std::vector<std::uint32_t>& indices() const override { return indices_; }
  [[nodiscard]] std::string place() const override { return "scans.zip"; }
  [[nodiscard]] std::uint64_t repeated() const override { return repeated_; }

  ScanBytes read(std::uint32_t index) override {
    const auto it = member_of_.find(index);
    if (it == member_of_.end()) return {"", "scan missing"};
    zip_stat_t about;
    if (zip_stat_index(zip_.get(), it->second, 0, &about) != 0) return {"", "zip member unreachable"};
    if (about.size > kMaxScan || about.comp_size > kMaxScan) return {"", "zip member too large"};
    ScanBytes scan;
    const bool good = about.comp_method == ZIP_CM_DEFLATE && about.encryption_method == ZIP_EM_NONE
                          ? unpack(it->second, about, scan.bytes)
                          : load(it->second, 0, about.size, scan.bytes);
    return good ? scan : ScanBytes{"", "zip member damaged"};
  }

 private:
  /// As libzip gives it: unpacked and checked, or with ZIP_FL_COMPRESSED as it lies in the archive.
  bool load(zip_uint64_t member, zip_flags_t flags, zip_uint64_t size, std::string& bytes) {
    const std::unique_ptr<zip_file_t, CloseMember> file(zip_fopen_index(zip_.get(), member, flags));
    bytes.resize(size);
    return file && zip_fread(file.get(), bytes.data(), size) == static_cast<zip_int64_t>(size);
  }
  bool unpack(zip_uint64_t member, const zip_stat_t& about, std::string& bytes) {
    if (!load(member, ZIP_FL_COMPRESSED, about.comp_size, packed_)) return false;
    bytes.resize(about.size);
    return libdeflate_deflate_decompress(decompressor_.get(), packed_.data(), packed_.size(), bytes.data(),
                                         bytes.size(), nullptr) == LIBDEFLATE_SUCCESS &&
           libdeflate_crc32(0, bytes.data(), bytes.size()) == about.crc;
  }

  ZipPtr zip_;
  std::unique_ptr<libdeflate_decompressor, FreeDecompressor> decompressor_;
  std::string packed_;                               ///< kept for its memory
  std::map<std::uint32_t, zip_uint64_t> member_of_;  ///< scan number -> place in the archive
  std::vector<std::uint32_t> indices_;
  std::uint64_t repeated_ = 0;
};

}  // namespace

std::unique_ptr<ScanStore> openScanZip(const std::filesystem::path& path) {
  ZipPtr zip(zip_open(path.c_str(), ZIP_RDONLY, nullptr));
  if (!zip) return nullptr;
  return std::make_unique<ScanZip>(std::move(zip));
}

}  // namespace atlas::record
