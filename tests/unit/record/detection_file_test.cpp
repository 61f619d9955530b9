// SPDX-License-Identifier: MIT
// The three layouts of yolo/camera_*.txt.
#include "record/detection_file.hpp"

#include <gtest/gtest.h>

#include "small_record.hpp"

namespace atlas::record {
namespace {

using test::kBegin;

class Detectors : public ::testing::Test {
 protected:
  DetectionFile open(const std::string& text, ImageSize size = {1920, 1200}) {
    return {folder_.write("boxes.txt", text), "yolo/boxes.txt", size, log_};
  }
  FrameTable frames(int count) {
    return {folder_.write("timestamps.txt", test::rows(count, 100 * kMillisecond,
                                                       [](int i) { return "," + std::to_string(i) + ",1"; })),
            "timestamps.txt", FrameColumns::kInner, 0, log_};
  }
  FileReport& report() { return log_->file("yolo/boxes.txt"); }
  test::TemporaryFolder folder_;
  std::shared_ptr<RecordLog> log_ = std::make_shared<RecordLog>();
};

TEST_F(Detectors, LayoutAIsByTheTopLeftCorner) {
  // The row and the box of the test of the published program: 310,550 .. 379,582 of a 1920x1200 picture.
  auto file = open("2, 0.1617, 0.4584, 0.0362, 0.0268, 0.8189, 0.9967, 2\n");
  EXPECT_EQ(file.layout(), DetectionLayout::kTopLeft);
  const auto boxes = file.boxes(2);
  ASSERT_EQ(boxes.size(), 1U);
  // To half a pixel: that program takes the left edge of the image for pixel 0, here it is pixel -1/2.
  EXPECT_NEAR(boxes[0].x_min, 0.1617 * 1920 - 0.5, 1e-9);
  EXPECT_NEAR(boxes[0].y_min, 0.4584 * 1200 - 0.5, 1e-9);
  EXPECT_NEAR(boxes[0].x_max, 379.97 - 0.5, 0.1);
  EXPECT_NEAR(boxes[0].y_max, 582.24 - 0.5, 0.1);
  EXPECT_EQ(boxes[0].class_id, 2);
  EXPECT_NEAR(boxes[0].confidence, 0.8189 * 0.9967, 1e-9);
}

TEST_F(Detectors, LayoutBIsByTheCentre) {
  auto file = open("0, 0.5, 0.25, 0.2, 0.1, 0.9, 7\n");
  EXPECT_EQ(file.layout(), DetectionLayout::kCenter);
  const auto boxes = file.boxes(0);
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_NEAR(boxes[0].x_min, 0.4 * 1920 - 0.5, 1e-9);
  EXPECT_NEAR(boxes[0].x_max, 0.6 * 1920 - 0.5, 1e-9);
  EXPECT_NEAR(boxes[0].y_min, 0.2 * 1200 - 0.5, 1e-9);
  EXPECT_NEAR(boxes[0].y_max, 0.3 * 1200 - 0.5, 1e-9);
}

// A box around the whole image ends at the outer edges of its first and last pixels.
TEST_F(Detectors, TheImageBeginsHalfAPixelBeforeItsFirstPixel) {
  auto file = open("0, 0.5, 0.5, 1, 1, 0.9, 7\n", {640, 512});
  const auto boxes = file.boxes(0);
  ASSERT_EQ(boxes.size(), 1U);
  EXPECT_EQ(boxes[0].x_min, -0.5);
  EXPECT_EQ(boxes[0].y_min, -0.5);
  EXPECT_EQ(boxes[0].x_max, 639.5);
  EXPECT_EQ(boxes[0].y_max, 511.5);
}

TEST_F(Detectors, LayoutCIsInPixelsUnclipped) {
  auto file =
      open("0, -12, 30, 80, 90, 0.9, 2\n1, 1, 1, 660, 520, 0.5, 0\n2, 0, 0, 1, 1, 0.5, 0\n", {640, 512});
  EXPECT_EQ(file.layout(), DetectionLayout::kCorners);
  EXPECT_EQ(file.boxes(0).at(0).x_min, -12);
  EXPECT_EQ(file.boxes(1).at(0).x_max, 660);
  EXPECT_EQ(file.boxes(2).at(0).x_max, 1) << "a small box does not change the layout of the file";
}

TEST_F(Detectors, RowsNeedNotBeInOrder) {
  auto file =
      open("7, 0.5, 0.5, 0.2, 0.1, 0.9, 2\n1, 0.5, 0.5, 0.2, 0.1, 0.8, 0\n7, 0.4, 0.5, 0.1, 0.1, 0.7, 5");
  const auto boxes = file.boxes(7);
  ASSERT_EQ(boxes.size(), 2U);
  EXPECT_EQ(boxes[0].class_id, 2) << "in the order of the file";
  EXPECT_EQ(boxes[1].class_id, 5) << "the last row needs no line end";
  EXPECT_EQ(file.boxes(1).size(), 1U);
  EXPECT_TRUE(file.boxes(3).empty());
  EXPECT_EQ(report().rows, 3U);
}

TEST_F(Detectors, RowsOfAnotherLayoutAreSkipped) {
  auto file = open(
      "0, 0.5, 0.5, 0.2, 0.1, 0.9, 2\n0, 0.5, 0.5, 0.2, 0.1, 0.9, 0.9, 2\n0, 0.1, 0.5, 0.2, 0.1, 0.9, 2\n");
  EXPECT_EQ(file.boxes(0).size(), 2U);
  EXPECT_EQ(report().skipped.at("too many fields"), 1U);
}

TEST_F(Detectors, UnbelievableBoxesAreSkippedByReason) {
  open(
      "0, 0.5, 0.5, 0.2, 0.1, 1.9, 2\n0, 0.5, 0.5, -0.2, 0.1, 0.9, 2\n0, 0.5, 0.5, 0.2, 0.1, 0.9, -2\n"
      "0, 5, 0.5, 0.2, 0.1, 0.9, 2\n-1, 0.5, 0.5, 0.2, 0.1, 0.9, 2\n0, 0.5, 0.5, 0.2, nan, 0.9, 2\n"
      "0, 0.5, 0.5, 0.2, 0.1, 0.9, 2\n");
  EXPECT_EQ(report().rows, 7U);
  EXPECT_EQ(report().skipped.at("confidence out of range"), 1U);
  EXPECT_EQ(report().skipped.at("box with a negative side"), 1U);
  EXPECT_EQ(report().skipped.at("out of range"), 2U) << "class and frame";
  EXPECT_EQ(report().skipped.at("box out of range"), 1U);
  EXPECT_EQ(report().skipped.at("not finite"), 1U);
}

TEST_F(Detectors, BoxesOfFramesThatAreNotThereAreBooked) {
  auto file =
      open("0, 0.5, 0.5, 0.2, 0.1, 0.9, 2\n1, 0.5, 0.5, 0.2, 0.1, 0.9, 2\n9, 0.5, 0.5, 0.2, 0.1, 0.9, 2\n");
  file.account(frames(2), {kBegin + 1, kEndOfTime});
  EXPECT_EQ(report().used, 1U);
  EXPECT_EQ(report().skipped.at(kOutsideSpan), 1U);
  EXPECT_EQ(report().skipped.at("frame without a row in timestamps.txt or without a picture"), 1U);
  EXPECT_EQ(report().examples.front(), "yolo/boxes.txt:3: field 1 (frame): no such frame: '9'");
}

TEST_F(Detectors, NormalizedBoxesNeedTheSizeOfTheImage) {
  auto file = open("0, 0.5, 0.5, 0.2, 0.1, 0.9, 2\n", {0, 0});
  EXPECT_EQ(report().skipped.at("image size unknown"), 1U);
  auto pixels = open("0, 10, 20, 30, 40, 0.9, 2\n", {0, 0});
  EXPECT_EQ(pixels.boxes(0).size(), 1U) << "pixels are pixels";
}

TEST_F(Detectors, EmptyFile) {
  auto file = open("\n");
  EXPECT_TRUE(file.boxes(0).empty());
  EXPECT_EQ(report().rows, 0U);
}

}  // namespace
}  // namespace atlas::record
