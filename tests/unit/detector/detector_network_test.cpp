// SPDX-License-Identifier: MIT
#include "detector_network.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>

#include "tiny_model.hpp"

namespace atlas_fusion {
namespace {

namespace fs = std::filesystem;

class DetectorNetwork : public testing::Test {
 protected:
  void TearDown() override { fs::remove(params_.model); }
  atlas::Network load(const std::string& bytes) {
    params_.model = testing::TempDir() + "tiny_" +
                    testing::UnitTest::GetInstance()->current_test_info()->name() + ".onnx";
    params_.cameras = {"camera"};
    params_.input_px = atlas::kTinySide;
    std::ofstream(params_.model, std::ios::binary) << bytes;
    return loadNetwork(params_);
  }
  std::string refusal(const std::string& bytes) {
    try {
      load(bytes);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  }
  /// 64 x 32 px, black, a red square of 16 px at (32, 0) and a weaker blue one at (0, 16).
  static cv::Mat squares() {
    cv::Mat image(32, 64, CV_8UC3, cv::Scalar::all(0));
    image(cv::Rect(32, 0, 16, 16)).setTo(cv::Scalar(0, 0, 255));
    image(cv::Rect(0, 16, 16, 16)).setTo(cv::Scalar(204, 0, 0));
    return image;
  }
  atlas::DetectorParams params_;
};

TEST_F(DetectorNetwork, findsTheSquaresInBothLayouts) {
  for (const auto layout : {atlas::Layout::kV5, atlas::Layout::kV8}) {
    const atlas::Network network = load(atlas::tinyModel(layout));
    const cv::Mat input = atlas::networkInput(squares(), atlas::kTinySide);
    const auto boxes = atlas::detectionsOf(network(input), {64, 32}, atlas::kTinySide, params_.limits);
    ASSERT_EQ(boxes.size(), 2U);
    EXPECT_EQ(boxes[0].class_id, 0);
    EXPECT_NEAR(boxes[0].confidence, 1.0, 1e-5);
    EXPECT_NEAR(boxes[0].x_min, 31.5, 1e-4);  // edges of pixels, the first has its centre at 0
    EXPECT_NEAR(boxes[0].x_max, 47.5, 1e-4);
    EXPECT_NEAR(boxes[0].y_min, -0.5, 1e-4);
    EXPECT_NEAR(boxes[0].y_max, 15.5, 1e-4);
    EXPECT_EQ(boxes[1].class_id, 1);
    EXPECT_NEAR(boxes[1].confidence, 0.8, 1e-5);
    EXPECT_NEAR(boxes[1].x_min, -0.5, 1e-4);
    EXPECT_NEAR(boxes[1].y_max, 31.5, 1e-4);
    const cv::Mat again = network(input);
    EXPECT_EQ(cv::norm(again, network(input), cv::NORM_INF), 0.0);
  }
}

TEST_F(DetectorNetwork, refusesWhatItCannotRunAndSaysWhy) {
  EXPECT_NE(refusal("no model at all").find("not an ONNX model"), std::string::npos);
  EXPECT_NE(refusal("").find("not an ONNX model"), std::string::npos);
  const std::string good = atlas::tinyModel(atlas::Layout::kV8);
  EXPECT_NE(refusal(good.substr(0, good.size() / 2)).find(params_.model), std::string::npos) << "truncated";
  params_.classes = 80;
  EXPECT_NE(refusal(good).find("1 x 6 x 16"), std::string::npos);
  fs::remove(params_.model);
  EXPECT_THROW(loadNetwork(params_), std::invalid_argument);
}

TEST_F(DetectorNetwork, classesByName) {
  EXPECT_EQ(classIds({"car", "person"}), (std::vector<int>{2, 0}));
  EXPECT_TRUE(classIds({}).empty());
  EXPECT_THROW(classIds({"car", "unicorn"}), std::invalid_argument);
}

}  // namespace
}  // namespace atlas_fusion
