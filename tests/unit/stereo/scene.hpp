// SPDX-License-Identifier: MIT
// Stereo pairs of random texture whose disparities are known: a road, and things that stand on it.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "atlas/stereo/disparity_image.hpp"
#include "atlas/stereo/stereo_rig.hpp"

namespace atlas::test {

/// The stereo camera of the Lexus: 512x320, f = 410 px, baseline 0.22 m.
inline StereoRig lexusRig() { return {410.0, 258.0, 156.0, 0.22, 512, 320, {}}; }
/// 1.28 m above the road, level.
inline RoadProfile lexusRoad() { return {156.0, 0.22 / 1.28}; }

/// An upright thing, in the left image.
struct Thing {
  cv::Rect place;
  double disparity_px;
};

struct StereoScene {
  cv::Mat left, right;  ///< CV_8UC1
  cv::Mat truth;        ///< CV_32FC1, px
  cv::Mat things;       ///< CV_8UC1, 255 where a thing is
};

/// Smooth noise: neighbours hang together over about two pixels.
inline cv::Mat randomTexture(cv::Size size, unsigned seed) {
  std::mt19937 random(seed);
  cv::Mat texture(size, CV_32FC1);
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) texture.at<float>(v, u) = static_cast<float>(random() % 256);
  cv::GaussianBlur(texture, texture, {0, 0}, 1.0);
  cv::normalize(texture, texture, 10.0, 245.0, cv::NORM_MINMAX);
  return texture;
}

inline float between(const cv::Mat& row_image, int v, double u) {
  const double inside = std::clamp(u, 0.0, row_image.cols - 1.001);
  const int whole = static_cast<int>(inside);
  const float ratio = static_cast<float>(inside - whole);
  return (1.0F - ratio) * row_image.at<float>(v, whole) + ratio * row_image.at<float>(v, whole + 1);
}

/// `background_px`: disparity of a row behind all things; noise: grey levels of each camera.
inline StereoScene render(cv::Size size, const std::function<double(int)>& background_px,
                          const std::vector<Thing>& things, double noise = 1.0, unsigned seed = 1) {
  cv::Mat left = randomTexture(size, seed), right = left.clone();
  StereoScene scene{{}, {}, cv::Mat(size, CV_32FC1), cv::Mat(size, CV_8UC1, cv::Scalar(0))};
  const cv::Mat behind = right.clone();
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) {
      left.at<float>(v, u) = between(behind, v, u - background_px(v));
      scene.truth.at<float>(v, u) = static_cast<float>(background_px(v));
    }
  }
  for (const Thing& thing : things) {
    const cv::Mat texture = randomTexture(size, ++seed);
    for (int v = thing.place.y; v < thing.place.br().y; ++v) {
      for (int u = thing.place.x; u < thing.place.br().x; ++u) {
        left.at<float>(v, u) = between(texture, v, u - thing.disparity_px);
        scene.truth.at<float>(v, u) = static_cast<float>(thing.disparity_px);
        scene.things.at<std::uint8_t>(v, u) = 255;
        const int in_right = static_cast<int>(std::lround(u - thing.disparity_px));
        if (in_right >= 0) right.at<float>(v, in_right) = texture.at<float>(v, in_right);
      }
    }
  }
  std::mt19937 random(seed + 1000);
  std::normal_distribution<float> normal(0.0F, static_cast<float>(noise));
  for (cv::Mat* image : {&left, &right})
    for (int v = 0; v < size.height; ++v)
      for (int u = 0; u < size.width; ++u) image->at<float>(v, u) += normal(random);
  left.convertTo(scene.left, CV_8UC1);
  right.convertTo(scene.right, CV_8UC1);
  return scene;
}

/// The Lexus' road with a car 10 m ahead and a pedestrian at 6 m.
inline StereoScene roadScene(unsigned seed = 1) {
  const RoadProfile road = lexusRoad();
  const auto foot = [&](double d) { return static_cast<int>(road.horizon_row + d / road.slope_px); };
  const double car_px = 9.02, pedestrian_px = 15.03;
  return render(
      {512, 320}, [&](int v) { return std::max(1.0, road.disparityAt(v)); },
      {{{280, foot(car_px) - 60, 80, 60}, car_px},
       {{150, foot(pedestrian_px) - 116, 34, 116}, pedestrian_px}},
      1.0, seed);
}

/// Of the pixels inside `where` (all without): how many have a disparity, and how wrong they are.
struct Judgement {
  double density = 0, median_px = 0, bad_share = 0;  ///< bad: more than 1 px off
};
inline Judgement judge(const cv::Mat& disparity, const cv::Mat& truth, const cv::Mat& where = {}) {
  std::vector<double> errors;
  double asked = 0, bad = 0;
  for (int v = 0; v < truth.rows; ++v) {
    for (int u = 0; u < truth.cols; ++u) {
      const double t = static_cast<double>(truth.at<float>(v, u));
      if (!(t > 0.0) || (!where.empty() && where.at<std::uint8_t>(v, u) == 0)) continue;
      ++asked;
      const int found = disparity.at<std::uint16_t>(v, u);
      if (found == 0) continue;
      errors.push_back(std::abs(found / static_cast<double>(kDisparityScale) - t));
      bad += errors.back() > 1.0;
    }
  }
  if (errors.empty()) return {};
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2),
                   errors.end());
  const double count = static_cast<double>(errors.size());
  return {count / asked, errors[errors.size() / 2], bad / count};
}

/// Share of the pixels with a label inside `where` whose label is `label`.
inline double shareOf(const cv::Mat& surface, SurfaceLabel label, const cv::Mat& where) {
  const double known = cv::countNonZero((surface != 0) & where);
  return cv::countNonZero((surface == static_cast<int>(label)) & where) / known;
}

}  // namespace atlas::test
