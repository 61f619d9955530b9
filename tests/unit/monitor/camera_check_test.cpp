// SPDX-License-Identifier: MIT
#include "atlas/monitor/camera_check.hpp"

#include <opencv2/imgproc.hpp>
#include <random>

#include "atlas/monitor/picture_statistics.hpp"
#include "watched.hpp"

namespace atlas {
namespace {

using test::at;
using test::expectClean;
using test::expectSeen;

/// A street-like scene of 640 x 400: bright sky, blocks with edges, a road; other noise in each picture.
cv::Mat scene(std::mt19937& random, double shift_px) {
  cv::Mat picture(400, 640, CV_8UC3, cv::Scalar(200, 190, 180));
  cv::rectangle(picture, {0, 220}, {639, 399}, cv::Scalar(90, 90, 90), cv::FILLED);
  for (int i = 0; i < 24; ++i) {
    const int x = static_cast<int>(std::fmod(i * 61.0 + shift_px, 640.0)), grey = 60 + (i * 37) % 120;
    cv::rectangle(picture, {x, 120 + (i * 13) % 80}, {x + 30, 260 + (i * 29) % 60},
                  cv::Scalar(grey, grey, grey), cv::FILLED);
  }
  cv::GaussianBlur(picture, picture, {}, 0.7);                                        // of a lens
  const auto noise = [&random] { return static_cast<double>(random() % 11) - 5.0; };  // 3 grey
  for (int y = 0; y < picture.rows; ++y) {
    auto* row = picture.ptr<std::uint8_t>(y);
    for (int x = 0; x < 3 * picture.cols; ++x) row[x] = cv::saturate_cast<std::uint8_t>(row[x] + noise());
  }
  return picture;
}

struct Camera {
  CameraCheck check;
  Findings findings{AnomalyThresholds()};
  MotionWitness motion;
  std::mt19937 random{1};
  double time_s = 0.0;

  void show(const cv::Mat& pixels) {
    Image image;
    image.stamp = at(time_s);
    image.pixels = pixels;
    check.add(image, motion, findings);
    time_s += 0.1;
  }
  template <class Damage>
  void run(double until_s, Damage&& damage) {
    while (time_s < until_s - 1e-6) {
      cv::Mat picture = scene(random, 20.0 * time_s);
      damage(picture);
      show(picture);
    }
  }
  void run(double until_s) {
    run(until_s, [](cv::Mat&) {});
  }
};

TEST(CameraCheck, OrdinaryPicturesAreNoAnomaly) {
  Camera camera;
  camera.run(5);
  expectClean(camera.findings);
}

TEST(CameraCheck, EmptyBlackAndWhiteAreSeenAtOnce) {
  Camera camera;
  camera.run(1);
  camera.show(cv::Mat());
  expectSeen(camera.findings, Anomaly::kPictureEmpty, 1.0, 0.0);
  camera.show(cv::Mat(400, 640, CV_8UC3, cv::Scalar(3, 3, 3)));
  expectSeen(camera.findings, Anomaly::kBlack, 1.1, 0.0);
  camera.show(cv::Mat(400, 640, CV_8UC3, cv::Scalar(254, 254, 254)));
  expectSeen(camera.findings, Anomaly::kWhite, 1.2, 0.0);
}

TEST(CameraCheck, FrozenIsSeenAfterHalfASecondUnlessTheVehicleStands) {
  Camera camera;
  camera.run(1);
  const cv::Mat still = scene(camera.random, 0.0);
  for (int i = 0; i < 8; ++i) camera.show(still);
  expectSeen(camera.findings, Anomaly::kPictureFrozen, 1.0, 0.65);
  Camera parked;
  for (int i = 0; i < 60; ++i) parked.motion.add(at(0.05 * i), {0.01 * (i % 3), 0, 0});
  for (int i = 0; i < 30; ++i) parked.show(still);
  EXPECT_FALSE(parked.findings.has(Anomaly::kPictureFrozen));
}

TEST(CameraCheck, BlurIsSeenAtOnce) {
  Camera camera;
  camera.run(2);
  camera.run(3, [](cv::Mat& picture) { cv::GaussianBlur(picture, picture, {}, 4.0); });
  expectSeen(camera.findings, Anomaly::kBlurred, 2.0, 0.01);
}

TEST(CameraCheck, FogIsSeenAtOnce) {
  Camera camera;
  camera.run(2);
  camera.run(3, [](cv::Mat& picture) { picture = 0.2 * picture + cv::Scalar(150, 150, 150); });
  expectSeen(camera.findings, Anomaly::kFogged, 2.0, 0.01);
}

TEST(CameraCheck, TheSunInTheLowerPartIsGlare) {
  Camera camera;
  camera.run(2);
  camera.run(3, [](cv::Mat& picture) {
    cv::circle(picture, {320, 260}, 120, cv::Scalar(255, 255, 255), cv::FILLED);
  });
  expectSeen(camera.findings, Anomaly::kGlare, 2.0, 0.01);
}

TEST(CameraCheck, ACoveredCornerIsSeenAfterASecond) {
  Camera camera;
  camera.run(2);
  const auto cover = [](cv::Mat& picture) {
    cv::rectangle(picture, {0, 150}, {260, 399}, cv::Scalar(6, 6, 6), cv::FILLED);
  };
  camera.run(2.5, cover);
  EXPECT_FALSE(camera.findings.has(Anomaly::kOccluded)) << "a shadow passes";
  camera.run(4, cover);
  expectSeen(camera.findings, Anomaly::kOccluded, 2.0, 1.1);
}

TEST(CameraCheck, TemperatureRangeThatSticksOrCannotBe) {
  Camera camera;
  for (double t = 0; t < 12; t += 0.033)
    camera.check.add(TemperatureRange{at(t), -29.0 + (t < 5 ? 0.01 * std::sin(90 * t) : 0.0), 20.7},
                     camera.findings);
  expectSeen(camera.findings, Anomaly::kTemperatureRangeFrozen, 4.9, 5.2);
  camera.check.add(TemperatureRange{at(12), 20.0, 10.0}, camera.findings);
  expectSeen(camera.findings, Anomaly::kTemperatureRange, 12.0, 0.0);
}

TEST(PictureStatistics, SharpnessOfAStepIsOneAndOfARampAQuarter) {
  cv::Mat step(64, 640, CV_8UC1, cv::Scalar(40)), ramp = step.clone();
  for (int x = 0; x < 640; ++x) {
    step.col(x).setTo(cv::Scalar(x % 16 < 8 ? 40 : 200));
    ramp.col(x).setTo(cv::Scalar(40 + 10 * (x % 20)));
  }
  EXPECT_NEAR(sharpnessOf(step).value(), 1.0, 1e-9);
  // A ramp of 10 a pixel, with its fall of 190 in one of 20 places: 4 of 20 spans hold the fall.
  EXPECT_LT(sharpnessOf(ramp).value(), 0.5);
  EXPECT_FALSE(sharpnessOf(cv::Mat(400, 640, CV_8UC1, cv::Scalar(128)))) << "no edges, no verdict";
}

TEST(PictureStatistics, UnknownKindsOfPixelsGiveNothing) {
  EXPECT_FALSE(rasterOf(cv::Mat()));
  EXPECT_FALSE(rasterOf(cv::Mat(400, 640, CV_32FC1, cv::Scalar(1.0))));
  EXPECT_FALSE(rasterOf(cv::Mat(10, 10, CV_8UC1, cv::Scalar(1))));
  EXPECT_TRUE(rasterOf(cv::Mat(512, 640, CV_16UC1, cv::Scalar(30000))));
}

}  // namespace
}  // namespace atlas
