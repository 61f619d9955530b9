// SPDX-License-Identifier: MIT
// Zip archives for tests.
#pragma once

#include <archive.h>
#include <archive_entry.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace atlas::test {

/// Members in the given order, deflated.
inline void writeZip(const std::filesystem::path& file,
                     const std::vector<std::pair<std::string, std::string>>& members) {
  std::filesystem::create_directories(file.parent_path());
  archive* zip = archive_write_new();
  archive_write_set_format_zip(zip);
  if (archive_write_open_filename(zip, file.c_str()) != ARCHIVE_OK)
    throw std::runtime_error("cannot write a zip");
  for (const auto& [name, bytes] : members) {
    archive_entry* entry = archive_entry_new();
    archive_entry_set_pathname(entry, name.c_str());
    archive_entry_set_size(entry, static_cast<la_int64_t>(bytes.size()));
    archive_entry_set_filetype(entry, AE_IFREG);
    archive_entry_set_perm(entry, 0644);
    archive_write_header(zip, entry);
    archive_entry_free(entry);
    archive_write_data(zip, bytes.data(), bytes.size());
  }
  archive_write_close(zip);
  archive_write_free(zip);
}

}  // namespace atlas::test
