// SPDX-License-Identifier: MIT
// atlas_stereo --left L --right R --camera CALIB --out OUT: disparities of one pair of images, or of all
// pairs of two folders (files of the same name, in the order of their names, as the images of a drive). For
// each pair
//   OUT             16-bit PNG, disparity x 256, 0 = unknown
//   OUT_road.png    8-bit PNG beside it: 255 road, 127 obstacle, 0 unknown
// Exit status 0: written, 2: wrong arguments, a calibration or image that cannot be used.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "atlas/stereo/rectifier.hpp"
#include "atlas/stereo/stereo_matcher.hpp"
#include "stereo/pair_calibration.hpp"

namespace {

namespace fs = std::filesystem;

struct Pair {
  fs::path left, right, out;
};

struct Arguments {
  std::string left, right, camera, out;
  std::vector<std::string> cameras;
  int range_px = 0;
  atlas::StereoParams stereo;
};

bool isImage(const fs::path& path) {
  const std::string ending = path.extension().string();
  return ending == ".png" || ending == ".jpg" || ending == ".jpeg" || ending == ".tif" || ending == ".tiff" ||
         ending == ".pgm";
}

/// In the order of their names. A left image without a right one is an error: a drive has no holes.
std::vector<Pair> pairsOf(const Arguments& arguments) {
  if (!fs::is_directory(arguments.left)) return {{arguments.left, arguments.right, arguments.out}};
  std::set<fs::path> names;
  for (const auto& entry : fs::directory_iterator(arguments.left))
    if (isImage(entry.path())) names.insert(entry.path().filename());
  if (names.empty()) throw std::runtime_error(arguments.left + ": has no images");
  std::vector<Pair> pairs;
  for (const fs::path& name : names) {
    const fs::path right = fs::path(arguments.right) / name;
    if (!fs::exists(right)) throw std::runtime_error(right.string() + ": the right image is missing");
    pairs.push_back(
        {fs::path(arguments.left) / name, right, fs::path(arguments.out) / name.stem().concat(".png")});
  }
  return pairs;
}

cv::Mat readImage(const fs::path& path) {
  const cv::Mat image = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
  if (image.empty()) throw std::runtime_error(path.string() + ": cannot be read as an image");
  return image;
}

void writeImage(const fs::path& path, const cv::Mat& image) {
  if (path.has_parent_path()) fs::create_directories(path.parent_path());
  if (!cv::imwrite(path.string(), image)) throw std::runtime_error(path.string() + ": cannot be written");
}

/// For the eye as for programs.
cv::Mat roadMask(const cv::Mat& surface) {
  cv::Mat mask(surface.size(), CV_8UC1, cv::Scalar(0));
  mask.setTo(127, surface == static_cast<int>(atlas::SurfaceLabel::kObstacle));
  mask.setTo(255, surface == static_cast<int>(atlas::SurfaceLabel::kRoad));
  return mask;
}

/// A tenth of the width, in steps of 32: the nearest thing that is seen is as wide as a tenth of the view.
int usualRange(int width_px) { return std::clamp((width_px / 10 + 31) / 32 * 32, 32, 256); }

void run(Arguments arguments) {
  const std::vector<Pair> pairs = pairsOf(arguments);
  atlas::PairNames names;
  if (!arguments.cameras.empty()) names = {arguments.cameras.at(0), arguments.cameras.at(1)};
  const cv::Size size = readImage(pairs.front().left).size();
  const atlas::PairCalibration calibration = atlas::readPairCalibration(arguments.camera, names, size);
  const atlas::Rectifier rectifier(calibration.left, calibration.right, calibration.T_left_right);
  if (arguments.stereo.camera_height_m == 0.0) {
    arguments.stereo.camera_height_m = calibration.height_m;
    arguments.stereo.camera_pitch_deg = calibration.pitch_deg;
  }
  arguments.stereo.range_px =
      arguments.range_px > 0 ? arguments.range_px : usualRange(rectifier.rig().width_px);
  atlas::StereoMatcher matcher(rectifier.rig(), arguments.stereo);
  for (const Pair& pair : pairs) {
    atlas::DisparityImage found;
    try {
      found = matcher.match(rectifier.left(readImage(pair.left)), rectifier.right(readImage(pair.right)));
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(pair.left.string() + ", " + pair.right.string() + ": " + error.what());
    }
    writeImage(pair.out, found.disparity);
    fs::path mask = pair.out;
    writeImage(mask.replace_filename(pair.out.stem().concat("_road.png")), roadMask(found.surface));
    const double known = cv::countNonZero(found.disparity) / static_cast<double>(found.disparity.total());
    std::printf("%s: %.1f %% known, ", pair.out.c_str(), 100.0 * known);
    if (found.road)
      std::printf("horizon at row %.1f, camera %.2f m above the road\n", found.road->horizon_row,
                  rectifier.rig().baseline_m / found.road->slope_px);
    else
      std::printf("road unknown\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Disparities and road of rectified stereo pairs.");
  Arguments arguments;
  app.add_option("--left", arguments.left, "left image, or folder")->required()->check(CLI::ExistingPath);
  app.add_option("--right", arguments.right, "right image, or folder")->required()->check(CLI::ExistingPath);
  app.add_option("--camera", arguments.camera,
                 "KITTI calib_cam_to_cam.txt, YAML with f u0 v0 baseline, or rig folder")
      ->required()
      ->check(CLI::ExistingPath);
  app.add_option("--out", arguments.out, "PNG, or folder")->required();
  app.add_option("--method", arguments.stereo.method, "double_correlation, sgbm or bm")
      ->capture_default_str();
  app.add_option("--aggregation", arguments.stereo.aggregation,
                 "of double_correlation: paths, or window as published")
      ->capture_default_str();
  app.add_option("--range", arguments.range_px,
                 "disparities that are looked for, px; 0: a tenth of the width");
  app.add_option("--cameras", arguments.cameras, "names of the left and the right camera")
      ->expected(2)
      ->delimiter(',');
  app.add_option("--height", arguments.stereo.camera_height_m,
                 "of the camera above the road, m; 0: from the images");
  app.add_option("--pitch", arguments.stereo.camera_pitch_deg, "of the camera, down, deg; with --height");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    run(arguments);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "atlas_stereo: %s\n", error.what());
    return 2;
  }
}
