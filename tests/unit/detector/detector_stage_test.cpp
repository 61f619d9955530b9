// SPDX-License-Identifier: MIT
#include "atlas/camera/detector_stage.hpp"

#include <gtest/gtest.h>

#include <array>
#include <opencv2/core.hpp>
#include <stdexcept>

namespace atlas {
namespace {

DetectorParams params() {
  DetectorParams p;
  p.model = "none.onnx";
  p.cameras = {"left", "right"};
  p.input_px = 32;
  return p;
}
ImagePtr image(Stamp stamp, const cv::Mat& pixels) {
  auto image = std::make_shared<Image>();
  image->stamp = stamp;
  image->frame = "optical";
  image->pixels = pixels;
  return image;
}
/// One box in the middle, of class 1.
cv::Mat middle(const cv::Mat&) {
  const std::array<int, 3> shape = {1, 6, 16};
  cv::Mat output(3, shape.data(), CV_32F, cv::Scalar(0));
  const std::array<float, 6> box = {16, 16, 8, 8, 0, 0.5F};
  for (std::size_t i = 0; i < 6; ++i) output.ptr<float>()[16 * i] = box[i];
  return output;
}

TEST(DetectorStage, everyImageIsAnsweredAlsoWhatCannotBeLookedAt) {
  DetectorStage stage(params(), middle);
  std::vector<std::pair<std::size_t, Detections>> out;
  stage.on_detections = [&](std::size_t camera, const Detections& d) { out.emplace_back(camera, d); };
  const cv::Mat good(32, 32, CV_8UC3, cv::Scalar::all(0));
  stage.push(0, image(10, good));
  stage.push(0, image(20, cv::Mat()));
  stage.push(0, image(30, cv::Mat(32, 32, CV_16UC1, cv::Scalar(0))));
  stage.push(0, image(40, cv::Mat(8, 64, CV_8UC1, cv::Scalar(0))));  // another size and kind than before
  EXPECT_TRUE(out.empty()) << "the other camera could still be earlier";
  stage.push(1, image(15, good));
  stage.finish(0);
  stage.finish(1);
  ASSERT_EQ(out.size(), 5U);
  const std::vector<Stamp> stamps = {10, 15, 20, 30, 40};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(out[i].second.stamp, stamps[i]);
  EXPECT_EQ(out[0].second.boxes.size(), 1U);
  EXPECT_EQ(out[1].first, 1U);
  EXPECT_TRUE(out[2].second.boxes.empty());
  EXPECT_TRUE(out[3].second.boxes.empty());
  EXPECT_EQ(out[4].second.image_index, 3U);
  EXPECT_EQ(out[4].second.frame, "optical");
  EXPECT_EQ(stage.counters().get("images"), 3U);
  EXPECT_EQ(stage.counters().get("skipped image: empty"), 1U);
  EXPECT_EQ(stage.counters().get("skipped image: unexpected layout"), 1U);
  EXPECT_TRUE(stage.ended());
}

TEST(DetectorStage, classesOfTheModelBecomeThoseOfCoco) {
  DetectorParams p = params();
  p.class_ids = {0, 7};
  std::int32_t found = -1;
  DetectorStage stage(p, middle);
  stage.on_detections = [&](std::size_t, const Detections& d) { found = d.boxes.at(0).class_id; };
  stage.push(0, image(1, cv::Mat(32, 32, CV_8UC1, cv::Scalar(0))));
  stage.finish(1);
  stage.finish(0);
  EXPECT_EQ(found, 7);
}

TEST(DetectorStage, refusesParametersThatCannotBe) {
  const auto refused = [](auto change) {
    DetectorParams p = params();
    change(p);
    EXPECT_THROW(validate(p), std::invalid_argument);
  };
  refused([](DetectorParams& p) { p.model.clear(); });
  refused([](DetectorParams& p) { p.cameras.clear(); });
  refused([](DetectorParams& p) { p.input_px = 0; });
  refused([](DetectorParams& p) { p.class_ids = {80}; });
  refused([](DetectorParams& p) { p.limits.overlap = 1.5; });
  EXPECT_NO_THROW(validate(params()));
}

}  // namespace
}  // namespace atlas
