// SPDX-License-Identifier: MIT
// Stereo pairs with ground truth of $ATLAS_DATA: KITTI stereo 2015, KITTI depth, Middlebury; and the measure
// of the KITTI 2015 benchmark.
#pragma once

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "atlas/stereo/disparity_image.hpp"
#include "atlas/stereo/stereo_rig.hpp"

namespace atlas::test {

struct RecordedPair {
  std::string name;
  StereoRig rig;
  int range_px = 128;
  cv::Mat left, right;
  cv::Mat truth;  ///< CV_32FC1, px, 0 unknown
};

namespace recorded {

inline StereoRig kittiRig(cv::Size size) {
  return {721.5377, 609.5593, 172.854, 0.53273, size.width, size.height, {}};
}
/// No road and no metres in it: only the images count.
inline StereoRig indoorRig(cv::Size size) {
  return {500.0, 0.5 * size.width, 0.5 * size.height, 0.1, size.width, size.height, {}};
}

inline RecordedPair pairOf(const std::string& name, const std::filesystem::path& left,
                           const std::filesystem::path& right) {
  RecordedPair pair;
  pair.name = name;
  pair.left = cv::imread(left.string(), cv::IMREAD_GRAYSCALE);
  pair.right = cv::imread(right.string(), cv::IMREAD_GRAYSCALE);
  return pair;
}

inline std::filesystem::path dataFolder() {
  const char* data = std::getenv("ATLAS_DATA");
  return data == nullptr ? std::filesystem::path() : std::filesystem::path(data);
}

}  // namespace recorded

inline std::vector<RecordedPair> kitti2015Pairs() {
  const auto folder = recorded::dataFolder() / "kitti_stereo2015_sample";
  std::vector<RecordedPair> pairs;
  for (const char* id : {"000010.png", "000050.png", "000075.png"}) {
    RecordedPair pair = recorded::pairOf(id, folder / "image_02" / id, folder / "image_03" / id);
    if (pair.left.empty() || pair.right.empty()) return {};
    pair.rig = recorded::kittiRig(pair.left.size());
    cv::imread((folder / "gt/disp_occ_0" / id).string(), cv::IMREAD_UNCHANGED)
        .convertTo(pair.truth, CV_32FC1, 1.0 / kDisparityScale);
    pairs.push_back(pair);
  }
  return pairs;
}

inline std::vector<RecordedPair> kittiDepthPairs() {
  const auto folder = recorded::dataFolder() / "kitti_depth_0001";
  const std::string drive = "2011_09_26_drive_0001_sync";
  std::vector<RecordedPair> pairs;
  for (int frame = 5; frame <= 16; ++frame) {
    std::string number = std::to_string(frame);
    number.insert(0, 10 - number.size(), '0');
    const auto images = folder / "raw/2011_09_26" / drive;
    RecordedPair pair = recorded::pairOf(number, images / "image_02/data" / (number + ".jpg"),
                                         images / "image_03/data" / (number + ".jpg"));
    if (pair.left.empty() || pair.right.empty()) return {};
    pair.rig = recorded::kittiRig(pair.left.size());
    const cv::Mat depth = cv::imread(
        (folder / "data_depth_annotated" / drive / "proj_depth/groundtruth/image_02" / (number + ".png"))
            .string(),
        cv::IMREAD_UNCHANGED);
    pair.truth = cv::Mat(depth.size(), CV_32FC1, cv::Scalar(0));
    for (int v = 0; v < depth.rows; ++v)
      for (int u = 0; u < depth.cols; ++u)
        if (const double z = depth.at<std::uint16_t>(v, u) / 256.0; z > 0.0)
          pair.truth.at<float>(v, u) = static_cast<float>(pair.rig.disparityAt(z));
    pairs.push_back(pair);
  }
  return pairs;
}

inline std::vector<RecordedPair> middleburyPairs() {
  const auto folder = recorded::dataFolder() / "stereo_middlebury";
  RecordedPair cones = recorded::pairOf("Cones", folder / "left.png", folder / "right.png");
  RecordedPair chair =
      recorded::pairOf("Adirondack", folder / "2bt/Adirondack_left.png", folder / "2bt/Adirondack_right.png");
  if (cones.left.empty() || chair.left.empty()) return {};
  cones.truth = cv::abs(cv::imread((folder / "disp_left.tif").string(), cv::IMREAD_UNCHANGED));
  cv::patchNaNs(cones.truth, 0.0);
  cones.range_px = 64;
  cv::Mat truth = cv::imread((folder / "2bt/Adirondack_gt.png").string(), cv::IMREAD_GRAYSCALE);
  truth.convertTo(chair.truth, CV_32FC1);
  for (RecordedPair* pair : {&cones, &chair}) pair->rig = recorded::indoorRig(pair->left.size());
  return {cones, chair};
}

/// Of the pixels with ground truth: how many have a disparity, and how many of those are wrong, that is by
/// more than 3 px and 5 % (KITTI 2015).
struct Score {
  double truths = 0, known = 0, wrong = 0;
  void add(const cv::Mat& disparity, const cv::Mat& truth) {
    for (int v = 0; v < truth.rows; ++v) {
      for (int u = 0; u < truth.cols; ++u) {
        const double t = static_cast<double>(truth.at<float>(v, u));
        if (!(t > 0.0)) continue;
        ++truths;
        const int found = disparity.at<std::uint16_t>(v, u);
        if (found == 0) continue;
        ++known;
        const double error = std::abs(found / static_cast<double>(kDisparityScale) - t);
        wrong += error > 3.0 && error > 0.05 * t;
      }
    }
  }
  [[nodiscard]] double density() const { return known / truths; }
  [[nodiscard]] double wrongShare() const { return wrong / known; }
};

}  // namespace atlas::test
