// SPDX-License-Identifier: MIT
#include "files/thermal_writer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <sstream>

namespace atlas {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr Stamp kBegin = 1568186740 * kSecond;

class ThermalWriterTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("thermal_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static ImagePtr image(Stamp stamp, const cv::Mat& pixels) {
    auto image = std::make_shared<Image>();
    image->stamp = stamp;
    image->format = "mono8";
    image->pixels = pixels;
    return image;
  }
  static ProjectedDetections labels(Stamp stamp, std::uint32_t index, std::vector<Detection2d> boxes) {
    ProjectedDetections projected;
    projected.detections.stamp = stamp;
    projected.detections.image_index = index;
    projected.detections.boxes = std::move(boxes);
    projected.selected = true;
    return projected;
  }
  /// A frame with everything that belongs to it.
  static void addFrame(ThermalWriter& writer, std::uint32_t index, const std::vector<Detection2d>& boxes) {
    const Stamp stamp = kBegin + index * kSecond / 3;
    writer.add(TemperatureRange{stamp, -10.0, 40.0});
    writer.add(image(stamp, cv::Mat(512, 640, CV_8UC1, cv::Scalar(index % 256))));
    writer.add(labels(stamp, index, boxes));
  }
  [[nodiscard]] std::string text(const std::string& name) const {
    std::ostringstream content;
    content << std::ifstream(folder_ / "thermal" / name).rdbuf();
    return content.str();
  }
  [[nodiscard]] std::size_t lines(const std::string& name) const {
    const std::string content = text(name);
    return static_cast<std::size_t>(std::count(content.begin(), content.end(), '\n'));
  }
  fs::path folder_;
};

/// What pycocotools relies on, and what it does not look at.
void checkCoco(const json& document) {
  std::set<std::int64_t> categories, annotation_ids;
  std::map<std::int64_t, json> images;
  for (const json& category : document["categories"])
    ASSERT_TRUE(categories.insert(category["id"].get<std::int64_t>()).second);
  for (const json& image : document["images"])
    ASSERT_TRUE(images.emplace(image["id"].get<std::int64_t>(), image).second);
  for (const json& annotation : document["annotations"]) {
    ASSERT_GT(annotation["id"].get<std::int64_t>(), 0);
    ASSERT_TRUE(annotation_ids.insert(annotation["id"].get<std::int64_t>()).second);
    ASSERT_EQ(categories.count(annotation["category_id"].get<std::int64_t>()), 1U);
    ASSERT_EQ(images.count(annotation["image_id"].get<std::int64_t>()), 1U);
    const json& image = images[annotation["image_id"].get<std::int64_t>()];
    const auto box = annotation["bbox"].get<std::vector<double>>();
    EXPECT_GE(box[0], 0.0);
    EXPECT_GE(box[1], 0.0);
    EXPECT_GT(box[2], 0.0);
    EXPECT_GT(box[3], 0.0);
    EXPECT_LE(box[0] + box[2], image["width"].get<double>() + 1e-9);
    EXPECT_LE(box[1] + box[3], image["height"].get<double>() + 1e-9);
    EXPECT_NEAR(annotation["area"].get<double>(), box[2] * box[3], 0.0006);
  }
}

TEST_F(ThermalWriterTest, theWholeDataset) {
  ThermalWriter writer({}, folder_);
  for (std::uint32_t i = 0; i < 300; ++i)  // 100 s
    addFrame(writer, i, {{100.0, 100.0, 150.0, 140.0 + i % 7, 2, 0.9}, {-20.0, 300.0, 30.0, 700.0, 0, 0.5}});
  writer.close();
  writer.close();  // nothing happens a second time
  const json document = json::parse(text("annotations.json"));
  checkCoco(document);
  EXPECT_EQ(document["images"].size(), 300U);
  EXPECT_EQ(document["annotations"].size(), 600U);
  EXPECT_EQ(document["images"][7]["temperature_max_degc"], 40.0);
  EXPECT_EQ(lines("detections.txt"), 600U);
  EXPECT_EQ(lines("train.txt"), 210U);
  EXPECT_EQ(lines("val.txt"), 60U);
  EXPECT_EQ(lines("test.txt"), 30U);
  EXPECT_EQ(lines("labels/000123.txt"), 2U);
  const cv::Mat grey = cv::imread((folder_ / "thermal/images/000051.png").string(), cv::IMREAD_UNCHANGED);
  EXPECT_EQ(grey.at<std::uint8_t>(0, 0), 51);
  const cv::Mat kelvin =
      cv::imread((folder_ / "thermal/radiometric/000051.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(kelvin.type(), CV_16UC1);
  EXPECT_EQ(kelvin.at<std::uint16_t>(511, 639), 27315);
  EXPECT_FALSE(cv::imread((folder_ / "thermal/contact_sheet.png").string()).empty());
  EXPECT_EQ(json::parse(text("card.json"))["classes"]["car"]["boxes"]["train"], 210);
  EXPECT_NE(text("data.yaml").find("train: train.txt"), std::string::npos);
  for (const auto& entry : fs::recursive_directory_iterator(folder_))
    EXPECT_NE(entry.path().filename().string()[0], '.') << "a temporary file is left: " << entry.path();
}

// Neighbours in time are in one part, but at the edges of blocks.
TEST_F(ThermalWriterTest, splitByBlocksOfTime) {
  ThermalWriter writer({}, folder_);
  for (std::uint32_t i = 0; i < 300; ++i) addFrame(writer, i, {});
  writer.close();
  const json document = json::parse(text("annotations.json"));
  int changes = 0;
  for (std::size_t i = 1; i < 300; ++i) {
    const json &before = document["images"][i - 1], &image = document["images"][i];
    if (before["split"] == image["split"]) continue;
    ++changes;
    EXPECT_NE(before["stamp_ns"].get<Stamp>() / (10 * kSecond),
              image["stamp_ns"].get<Stamp>() / (10 * kSecond));
  }
  EXPECT_EQ(changes, 6) << "from block 4 of ten on: train, val, train, test, 2 train, val, 3 train";
  EXPECT_TRUE(document["annotations"].empty());
  EXPECT_FALSE(fs::exists(folder_ / "thermal/contact_sheet.png")) << "no frame has labels";
}

TEST_F(ThermalWriterTest, badInputIsCountedWithItsReason) {
  ThermalWriter writer({}, folder_);
  addFrame(writer, 0,
           {{100, 100, 150, 140, 80, 0.9},
            {100, 100, 150, 140, -1, 0.9},
            {100, std::nan(""), 150, 140, 2, 0.9},
            {700, 100, 750, 140, 2, 0.9},
            {100, 100, 150, 140, 2, 0.9}});
  const Stamp stamp = kBegin + 10 * kSecond;
  writer.add(image(stamp, cv::Mat()));  // a truncated image decodes to nothing
  writer.add(labels(stamp, 1, {}));
  writer.add(image(stamp + 1, cv::Mat(256, 320, CV_8UC1, cv::Scalar(3))));  // the resolution has changed,
  CameraInfo info;                                                          // camera_info has not
  info.stamp = stamp + 1, info.width = 640, info.height = 512;
  writer.add(info);
  writer.add(labels(stamp + 1, 2, {{400, 400, 450, 440, 2, 0.9}}));
  writer.add(image(stamp + 2, cv::Mat(256, 320, CV_8UC1, cv::Scalar(4))));  // both have: legal
  info.stamp = stamp + 2, info.width = 320, info.height = 256;
  writer.add(info);
  writer.add(labels(stamp + 2, 3, {{100, 100, 150, 140, 2, 0.9}}));
  writer.add(image(stamp + 3, cv::Mat(256, 320, CV_16UC1, cv::Scalar(5))));
  writer.add(labels(stamp + 3, 4, {}));
  writer.add(image(stamp + 4, cv::Mat(256, 320, CV_8UC1, cv::Scalar(6))));
  writer.add(labels(stamp + 4, 3, {}));
  writer.add(labels(stamp + 5, 9, {}));
  ProjectedDetections not_chosen = labels(stamp + 6, 10, {});
  not_chosen.selected = false;
  writer.add(image(stamp + 6, cv::Mat(256, 320, CV_8UC1, cv::Scalar(7))));
  writer.add(not_chosen);
  writer.close();
  const std::map<std::string, std::uint64_t> expected = {
      {"label: unknown class id", 2},
      {"label: not finite", 1},
      {"label: outside the image", 1},
      {"frame: no picture", 2},
      {"frame: picture has another size than its camera_info", 1},
      {"frame: picture is not 8 bit", 1},
      {"frame: number not after the one before", 1},
      {"frame: no RGB image near it", 1},
      {"temperatures: none for the frame", 1}};
  EXPECT_EQ(writer.dropped(), expected);
  const json document = json::parse(text("annotations.json"));
  checkCoco(document);
  EXPECT_EQ(document["images"].size(), 2U);
  EXPECT_EQ(document["images"][1]["width"], 320);
  EXPECT_EQ(document["annotations"].size(), 2U);
  EXPECT_EQ(lines("labels/000000.txt"), 1U);
}

TEST_F(ThermalWriterTest, nothingChosenNoFiles) {
  ThermalWriter writer({}, folder_);
  writer.close();
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(ThermalWriterTest, parametersAreChecked) {
  ThermalDatasetParams params;
  params.split_block_s = 0.0;
  EXPECT_THROW(validate(params), std::invalid_argument);
  params = {};
  params.contact_sheet_frames = 0;
  EXPECT_THROW(validate(params), std::invalid_argument);
}

}  // namespace
}  // namespace atlas
