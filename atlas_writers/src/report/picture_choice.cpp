// SPDX-License-Identifier: MIT
#include "report/picture_choice.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "atlas/output/coco_names.hpp"
#include "report/number_text.hpp"

namespace atlas::report {
namespace {

namespace fs = std::filesystem;

constexpr double kNear_m = 3.0, kFar_m = 80.0;  // ends of the colour scale, logarithmic between

std::vector<fs::path> foldersOf(const fs::path& folder) {
  std::vector<fs::path> folders;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_directory()) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

bool isThermal(const fs::path& folder) { return folder.filename().string().find("_ir") != std::string::npos; }

/// "000123.png" of the sequence, not the preview beside it.
std::vector<fs::path> sequenceFiles(const fs::path& folder) {
  std::vector<fs::path> files = filesOf(folder, ".png");
  files.erase(std::remove_if(files.begin(), files.end(),
                             [](const fs::path& file) {
                               const std::string stem = file.stem().string();
                               return stem.find_first_not_of("0123456789") != std::string::npos;
                             }),
              files.end());
  return files;
}

/// At most `count` of the files, evenly spread.
std::vector<fs::path> spread(const std::vector<fs::path>& files, std::size_t count) {
  if (files.size() <= count) return files;
  std::vector<fs::path> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(files[(2 * i + 1) * files.size() / (2 * count)]);
  return chosen;
}

/// Up to twice the size when small, so that thermal images are not lost on the page.
cv::Mat enlarged(const cv::Mat& pixels) {
  cv::Mat result = pixels;
  if (pixels.cols < 700) cv::resize(pixels, result, {}, 2, 2, cv::INTER_NEAREST);
  return result;
}

std::size_t countLines(const fs::path& path) {
  std::ifstream file(path);
  std::size_t lines = 0;
  for (std::string line; std::getline(file, line);) lines += line.empty() ? 0 : 1;
  return lines;
}

/// Draws the YOLO labels "class cx cy w h" (shares of the image) of a file.
void drawLabels(cv::Mat& picture, const fs::path& labels, double scale) {
  std::ifstream file(labels);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    int class_id = 0;
    double cx = 0, cy = 0, w = 0, h = 0;
    if (!(words >> class_id >> cx >> cy >> w >> h)) continue;
    const cv::Point2d size(picture.cols, picture.rows);
    const cv::Point top_left(static_cast<int>((cx - w / 2) * size.x),
                             static_cast<int>((cy - h / 2) * size.y));
    const cv::Point bottom_right(static_cast<int>((cx + w / 2) * size.x),
                                 static_cast<int>((cy + h / 2) * size.y));
    const cv::Scalar color(60, 200, 255);
    cv::rectangle(picture, top_left, bottom_right, color, 2);
    cv::putText(picture, className(class_id), {top_left.x, std::max(12, top_left.y - 4)},
                cv::FONT_HERSHEY_SIMPLEX, 0.45 * scale, color, 1, cv::LINE_AA);
  }
}

}  // namespace

std::vector<fs::path> filesOf(const fs::path& folder, const std::string& extension) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.is_regular_file() && entry.path().extension() == extension) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

cv::Mat colorDepth(const cv::Mat& depth_x256) {
  cv::Mat scale(depth_x256.size(), CV_8UC1), picture;
  for (int y = 0; y < depth_x256.rows; ++y) {
    for (int x = 0; x < depth_x256.cols; ++x) {
      const double depth_m = std::clamp(depth_x256.at<std::uint16_t>(y, x) / 256.0, kNear_m, kFar_m);
      scale.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>(255.0 * (1 - std::log(depth_m / kNear_m) / std::log(kFar_m / kNear_m)));
    }
  }
  cv::Mat known = depth_x256 > 0;
  scale.setTo(0, ~known);
  // Measured pixels are sparse: each is shown as a 3x3 square, the nearer one in front.
  cv::dilate(scale, scale, cv::Mat());
  cv::dilate(known, known, cv::Mat());
  cv::applyColorMap(scale, picture, cv::COLORMAP_TURBO);
  picture.setTo(cv::Scalar(24, 19, 16), ~known);
  return picture;
}

std::optional<Picture> chooseDepth(const fs::path& out) {
  std::vector<fs::path> cameras = foldersOf(out / "depth");
  std::stable_partition(cameras.begin(), cameras.end(),
                        [](const fs::path& camera) { return !isThermal(camera); });
  for (const fs::path& camera : cameras) {
    int best = 0;
    std::optional<Picture> picture;
    for (const fs::path& file : spread(sequenceFiles(camera), 9)) {
      const cv::Mat depth = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
      if (depth.type() != CV_16UC1) continue;
      const int known = cv::countNonZero(depth);
      if (known <= best) continue;
      best = known;
      const double percent = 100.0 * known / static_cast<double>(depth.total());
      picture = Picture{enlarged(colorDepth(depth)),
                        "Depth image " + camera.filename().string() + "/" + file.filename().string() +
                            ": red " + valueText(kNear_m) + " m to blue " + valueText(kFar_m) +
                            " m, measured pixels " + valueText(percent) + " %"};
    }
    if (picture) return picture;
  }
  return std::nullopt;
}

/// The overlay with the most lidar points: its depth image, of the same camera and number, is the fullest.
std::optional<Picture> chooseOverlay(const fs::path& out) {
  for (const fs::path& folder : foldersOf(out / "overlay")) {
    int most = -1;
    std::optional<fs::path> best;
    for (const fs::path& file : spread(filesOf(folder, ".png"), 9)) {
      const fs::path depth_file = out / "depth" / folder.filename() / file.filename();
      const cv::Mat depth =
          fs::exists(depth_file) ? cv::imread(depth_file.string(), cv::IMREAD_UNCHANGED) : cv::Mat();
      const int known = depth.type() == CV_16UC1 ? cv::countNonZero(depth) : 0;
      if (known > most) most = known, best = file;
    }
    if (!best) continue;
    const cv::Mat pixels = cv::imread(best->string(), cv::IMREAD_COLOR);
    if (pixels.empty()) continue;
    return Picture{pixels, "Camera overlay " + fs::relative(*best, out / "overlay").string() +
                               ": lidar depth, detections with their distance"};
  }
  return std::nullopt;
}

std::optional<Picture> chooseThermal(const fs::path& out) {
  const std::vector<fs::path> images = filesOf(out / "thermal/images", ".png");
  std::optional<fs::path> best;
  std::size_t best_labels = 0;
  for (const fs::path& image : images) {
    const std::size_t labels = countLines((out / "thermal/labels" / image.stem()).string() + ".txt");
    if (labels > best_labels || !best) best = image, best_labels = labels;
  }
  if (!best) return std::nullopt;
  cv::Mat pixels = cv::imread(best->string(), cv::IMREAD_COLOR);
  if (pixels.empty()) return std::nullopt;
  pixels = enlarged(pixels);
  drawLabels(pixels, (out / "thermal/labels" / best->stem()).string() + ".txt", 1.2);
  return Picture{pixels, "Thermal image " + best->filename().string() + " with " + countText(best_labels) +
                             " labels carried over from the colour camera, of " + countText(images.size()) +
                             " images"};
}

std::optional<Picture> contactSheet(const fs::path& out) {
  const cv::Mat pixels = cv::imread((out / "thermal/contact_sheet.png").string(), cv::IMREAD_COLOR);
  if (pixels.empty()) return std::nullopt;
  return Picture{pixels, "Contact sheet of the thermal dataset: labelled frames chosen at random"};
}

}  // namespace atlas::report
