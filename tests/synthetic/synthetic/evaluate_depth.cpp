// SPDX-License-Identifier: MIT
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "synthetic/evaluate.hpp"

namespace atlas::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr double kUnitsPerMetre = 256.0;
constexpr double kOutlier = 0.1;  // of the true depth

struct DepthErrors {
  std::vector<float> error_m;
  std::uint64_t frames = 0;
  Share filled, outliers, on_sky;

  void compare(const cv::Mat& truth, const cv::Mat& run) {
    ++frames;
    for (int row = 0; row < truth.rows; ++row) {
      const auto* t = truth.ptr<std::uint16_t>(row);
      const auto* r = run.ptr<std::uint16_t>(row);
      for (int column = 0; column < truth.cols; ++column) {
        filled.add(r[column] != 0);
        if (r[column] == 0) continue;
        on_sky.add(t[column] == 0);
        if (t[column] == 0) {  // nothing within 255 m is there
          outliers.add(true);
          continue;
        }
        const double difference_m = (r[column] - t[column]) / kUnitsPerMetre;
        error_m.push_back(static_cast<float>(difference_m));
        outliers.add(std::fabs(difference_m) > kOutlier * t[column] / kUnitsPerMetre);
      }
    }
  }
  void report(const std::string& group, Evaluation& evaluation) {
    evaluation.add(group, "error_m", statisticsOf(error_m));
    evaluation.add(group, "outliers_percent", outliers.percent());
    evaluation.add(group, "filled_on_sky_percent", on_sky.percent());
    evaluation.add(group, "filled_percent", filled.percent());
    evaluation.addCount(group, "frames", frames);
  }
};

}  // namespace

void evaluateDepth(const RunFolders& folders, Evaluation& evaluation) {
  if (!fs::is_directory(folders.out / "depth")) return evaluation.skip("depth: no such folder");
  for (const std::string& camera : foldersOf(folders.out / "depth")) {
    DepthErrors errors;
    const std::string label = "depth/" + camera;
    for (const auto& [frame, path] : numberedFiles(folders.truth / "depth" / camera, ".png")) {
      const fs::path file = folders.out / "depth" / camera / path.filename();
      if (!fs::exists(file)) {
        evaluation.skip(label + ": frame with truth but no file");
        continue;
      }
      const cv::Mat truth = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
      const cv::Mat run = cv::imread(file.string(), cv::IMREAD_UNCHANGED);
      if (truth.type() != CV_16UC1 || run.type() != CV_16UC1 || truth.size() != run.size()) {
        evaluation.skip(label + ": no 16-bit picture of the size of the truth: " + file.string());
        continue;
      }
      errors.compare(truth, run);
    }
    if (errors.frames > 0) {
      errors.report("depth_" + camera, evaluation);
    } else {
      evaluation.skip(label + ": no frame with truth");
    }
  }
}

}  // namespace atlas::synthetic
