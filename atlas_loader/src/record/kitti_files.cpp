// SPDX-License-Identifier: MIT
#include "record/kitti_files.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "record/text_rows.hpp"

namespace atlas::record {
namespace {
namespace fs = std::filesystem;
constexpr int kDepth = 4;  // date/drive_sync below a folder that groups them

bool hasCalibration(const fs::path& folder) {
  std::error_code error;
  for (const char* name : {"calib_cam_to_cam.txt", "calib_velo_to_cam.txt", "calib_imu_to_velo.txt"}) {
    if (fs::exists(folder / name, error)) return true;
  }
  return false;
}

void search(const fs::path& folder, int depth, KittiFiles& found) {
  if (found.calibration.empty() && hasCalibration(folder)) found.calibration = folder;
  if (depth == 0) return;
  std::error_code error;
  std::vector<fs::path> below;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->is_directory(error)) below.push_back(it->path());
  }
  std::sort(below.begin(), below.end());
  for (const fs::path& path : below) {
    const std::string name = path.filename().string();
    const bool sensor =
        name == "oxts" || name == "velodyne_points" || name == "image_02" || name == "image_03";
    if (name == "data" || name == "proj_depth") continue;
    if (sensor && fs::is_directory(path / "data", error)) {
      const auto [it, first] = found.sensors.emplace(name, path);
      if (!first) {
        throw std::invalid_argument("record: " + name + " is there twice, name one drive: '" +
                                    it->second.string() + "' and '" + path.string() + "'");
      }
    } else if (name == "image_00" || name == "image_01") {
      found.notes.push_back(name + ": grey camera, not read");
    } else {
      search(path, depth - 1, found);
    }
  }
}

bool startsWith(const std::string& bytes, std::string_view magic) {
  return bytes.compare(0, magic.size(), magic) == 0;
}
}  // namespace

fs::path KittiFiles::sensor(const std::string& name) const {
  const auto it = sensors.find(name);
  return it == sensors.end() ? fs::path() : it->second;
}

KittiFiles findKittiFiles(const fs::path& folder, const std::string& calibration_dir) {
  KittiFiles found;
  search(folder, kDepth, found);
  std::error_code error;
  const fs::path absolute = fs::absolute(folder / ".", error).lexically_normal().parent_path();
  const fs::path parent = absolute.parent_path(), grandparent = parent.parent_path();
  for (const fs::path& place :
       {parent, parent / "calib", grandparent, grandparent / "calib", fs::path(calibration_dir)}) {
    if (found.calibration.empty() && !place.empty() && hasCalibration(place)) found.calibration = place;
  }
  return found;
}

std::map<std::uint32_t, std::vector<fs::path>> kittiFrameFiles(const fs::path& folder,
                                                               const std::vector<std::string>& extensions) {
  std::map<std::uint32_t, std::vector<fs::path>> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const fs::path& path = it->path();
    if (std::find(extensions.begin(), extensions.end(), path.extension().string()) == extensions.end())
      continue;
    const auto index = toUnsigned(path.stem().string());
    if (!index || *index > 0x7fffffff) continue;
    files[static_cast<std::uint32_t>(*index)].push_back(path);
  }
  for (auto& [index, paths] : files) std::sort(paths.begin(), paths.end());  // whatever the disk's order
  return files;
}

std::string kittiFileName(std::uint32_t index, const std::string& extension) {
  char digits[16];
  std::snprintf(digits, sizeof(digits), "%010u", index);
  return digits + extension;
}

std::optional<std::string> readWholeFile(const fs::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : -1;
  constexpr std::streamoff kMax = 256 << 20;  // bytes; a frame has a few MB
  if (size < 0 || size > kMax) return std::nullopt;
  std::string bytes(static_cast<std::size_t>(size), '\0');
  file.seekg(0);
  file.read(bytes.data(), size);
  if (file.gcount() != size) return std::nullopt;
  return bytes;
}

std::shared_ptr<Image> kittiImage(const std::string& bytes, bool decode) {
  const bool png = startsWith(bytes, "\x89PNG\r\n\x1a\n");
  const bool jpeg = startsWith(bytes, "\xff\xd8\xff");
  // A cut file lacks its end: the IEND chunk, or the end-of-image marker (some writers pad behind it).
  const std::string tail = bytes.substr(bytes.size() - std::min<std::size_t>(bytes.size(), 64));
  const bool whole =
      png ? tail.find("IEND") != std::string::npos : tail.find("\xff\xd9") != std::string::npos;
  if ((!png && !jpeg) || !whole) return nullptr;
  auto image = std::make_shared<Image>();
  if (!decode) {
    image->format = png ? "png" : "jpeg";
    image->encoded.assign(bytes.begin(), bytes.end());
    return image;
  }
  const cv::Mat raw(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data()));
  try {
    image->pixels = cv::imdecode(raw, cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {  // a size in the header that is beyond all limits
    return nullptr;
  }
  image->format = "bgr8";
  return image->pixels.empty() ? nullptr : image;
}

}  // namespace atlas::record
