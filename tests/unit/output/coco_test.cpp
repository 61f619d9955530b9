// SPDX-License-Identifier: MIT
#include "atlas/output/coco.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "atlas/output/coco_names.hpp"

namespace atlas {
namespace {

TEST(CocoNames, theOrderOfTheDetectors) {
  ASSERT_EQ(cocoNames().size(), 80U);
  EXPECT_EQ(className(0), "person");
  EXPECT_EQ(className(2), "car");
  EXPECT_EQ(className(9), "traffic light");
  EXPECT_EQ(className(79), "toothbrush");
  EXPECT_EQ(className(80), "class 80");
  EXPECT_EQ(className(-1), "class -1");
  EXPECT_EQ(std::set<std::string>(cocoNames().begin(), cocoNames().end()).size(), 80U);
}

TEST(Coco, thePiecesMakeADocument) {
  CocoImage image{
      12, "images/\"odd\".png", 640, 512, 1568186745453388439, TemperatureRange{0, -29.65, 20.74}, "val"};
  const CocoImage plain{13, "images/000013.png", 640, 512, 1, std::nullopt, ""};
  const Detection2d inside{127.5, 95.5, 191.5, 159.5, 2, 0.5}, cut{-100, 499.5, 63.5, 600, 0, 0.75},
      outside{700, 0, 800, 10, 0, 1};
  EXPECT_FALSE(cocoAnnotation(3, image, outside));
  const std::string text = cocoBegin("test") + cocoImage(image) + ",\n" + cocoImage(plain) + cocoMiddle() +
                           *cocoAnnotation(1, image, inside) + ",\n" + *cocoAnnotation(2, image, cut) +
                           cocoEnd();
  const auto document = nlohmann::json::parse(text);
  EXPECT_EQ(document["info"]["description"], "test");
  ASSERT_EQ(document["categories"].size(), 80U);
  EXPECT_EQ(document["categories"][2]["id"], 2);
  EXPECT_EQ(document["categories"][2]["name"], "car");
  ASSERT_EQ(document["images"].size(), 2U);
  EXPECT_EQ(document["images"][0]["id"], 12);
  EXPECT_EQ(document["images"][0]["file_name"], "images/\"odd\".png");
  EXPECT_EQ(document["images"][0]["width"], 640);
  EXPECT_EQ(document["images"][0]["height"], 512);
  EXPECT_EQ(document["images"][0]["stamp_ns"].get<std::int64_t>(), 1568186745453388439);
  EXPECT_EQ(document["images"][0]["temperature_min_degc"], -29.65);
  EXPECT_EQ(document["images"][0]["temperature_max_degc"], 20.74);
  EXPECT_EQ(document["images"][0]["split"], "val");
  EXPECT_FALSE(document["images"][1].contains("split"));
  EXPECT_FALSE(document["images"][1].contains("temperature_min_degc"));  // unknown is left out, not zero
  ASSERT_EQ(document["annotations"].size(), 2U);
  const auto& first = document["annotations"][0];
  EXPECT_EQ(first["id"], 1);
  EXPECT_EQ(first["image_id"], 12);
  EXPECT_EQ(first["category_id"], 2);
  EXPECT_EQ(first["bbox"], nlohmann::json({128.0, 96.0, 64.0, 64.0}));
  EXPECT_EQ(first["area"], 4096.0);
  EXPECT_EQ(document["annotations"][1]["bbox"], nlohmann::json({0.0, 500.0, 64.0, 12.0}));
}

// Rounding to thousandths must not push a box over the edge, and the area is that of the numbers beside it.
TEST(Coco, boxesStayInsideAndAreasAgree) {
  const CocoImage image{1, "a.png", 641, 479, 1, std::nullopt, ""};
  for (double x = 0.0; x < 600.0; x += 7.3377) {
    const auto text = cocoAnnotation(1, image, {x, 0.61 * x, 1000.0, 1000.0, 0, 1.0});
    ASSERT_TRUE(text);
    const auto box = nlohmann::json::parse(*text)["bbox"].get<std::vector<double>>();
    EXPECT_NEAR(box[0] + box[2], 641.0, 1e-9);
    EXPECT_NEAR(box[1] + box[3], 479.0, 1e-9);
    EXPECT_NEAR(nlohmann::json::parse(*text)["area"].get<double>(), box[2] * box[3], 0.0006);
  }
}

TEST(Coco, withoutAnnotationsStillADocument) {
  const auto document = nlohmann::json::parse(cocoBegin("x") + cocoMiddle() + cocoEnd());
  EXPECT_TRUE(document["images"].empty());
  EXPECT_TRUE(document["annotations"].empty());
}

}  // namespace
}  // namespace atlas
