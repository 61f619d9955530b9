// SPDX-License-Identifier: MIT
#include "run_summary.hpp"

#include <openssl/evp.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "output_file.hpp"

namespace atlas {
namespace {

namespace fs = std::filesystem;

class Sha256 {
 public:
  Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
    EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr);
  }
  void add(const void* data, std::size_t size) { EVP_DigestUpdate(context_.get(), data, size); }
  void add(const std::string& text) { add(text.data(), text.size()); }
  void addFile(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) throw std::runtime_error("cannot read " + path.string());
    std::vector<char> buffer(1 << 20);
    while (file) {
      file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
      add(buffer.data(), static_cast<std::size_t>(file.gcount()));
    }
  }
  std::string hex() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int size = 0;
    EVP_DigestFinal_ex(context_.get(), digest.data(), &size);
    static const char* const kDigits = "0123456789abcdef";
    std::string text;
    for (unsigned int i = 0; i < size; ++i) {
      text += kDigits[digest[i] >> 4];
      text += kDigits[digest[i] & 15];
    }
    return text;
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
};

constexpr std::uint64_t kHashedWhole = 16u << 20;  // bytes; larger files of a folder count by name and size

RunInput hashFolder(const std::string& path) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(path)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  RunInput input;
  input.path = path;
  input.hashed = "names, sizes and files up to 16 MB";
  Sha256 sha;
  for (const fs::path& file : files) {
    const std::uint64_t size = fs::file_size(file);
    input.bytes += size;
    sha.add(fs::relative(file, path).string() + " " + std::to_string(size) + "\n");
    if (size <= kHashedWhole) sha.addFile(file);
  }
  input.sha256 = sha.hex();
  return input;
}

}  // namespace

std::string suiteVersion() { return "0.1.0"; }

RunInput hashInput(const std::string& path) {
  if (fs::is_directory(path)) return hashFolder(path);
  RunInput input;
  input.path = path;
  input.hashed = "file";
  Sha256 sha;
  sha.addFile(path);
  input.bytes = fs::file_size(path);
  input.sha256 = sha.hex();
  return input;
}

std::string toJson(const RunSummary& summary) {
  nlohmann::ordered_json root;
  root["version"] = suiteVersion();
  root["mode"] = summary.mode;
  root["complete"] = summary.complete;
  if (!summary.failure.empty()) root["failure"] = summary.failure;
  root["inputs"] = nlohmann::ordered_json::array();
  for (const RunInput& input : summary.inputs) {
    root["inputs"].push_back({{"path", fs::path(input.path).filename().string()},
                              {"bytes", input.bytes},
                              {"sha256", input.sha256},
                              {"hashed", input.hashed}});
  }
  root["configuration"] = summary.configuration.empty()
                              ? nlohmann::ordered_json::object()
                              : nlohmann::ordered_json::parse(summary.configuration);
  for (const auto& [topic, count] : summary.streams) root["streams"][topic]["count"] = count;
  for (const auto& [stage, counters] : summary.stages) {
    root["stages"][stage] = nlohmann::ordered_json::object();
    for (const auto& [name, value] : counters) root["stages"][stage][name] = value;
  }
  for (const auto& [name, file] : summary.files) {
    auto& node = root["files"][name];
    node["rows"] = file.rows;
    node["used"] = file.used;
    node["skipped"] = nlohmann::ordered_json::object();
    for (const auto& [reason, count] : file.skipped) node["skipped"][reason] = count;
    if (!file.examples.empty()) node["examples"] = file.examples;
  }
  root["notes"] = summary.notes;
  root["timings"] = {{"data_s", summary.data_s},
                     {"wall_s", summary.wall_s},
                     {"cpu_s", summary.cpu_s},
                     {"peak_rss_mb", summary.peak_rss_mb}};
  return root.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void writeRunSummary(const std::string& out, const RunSummary& summary) {
  OutputFile file(fs::path(out) / "run.json");
  file.write(toJson(summary));
  file.commit();
}

void measureProcess(RunSummary& summary) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  summary.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  summary.peak_rss_mb = static_cast<double>(usage.ru_maxrss) / 1024.0;  // Linux counts kilobytes
}

}  // namespace atlas
