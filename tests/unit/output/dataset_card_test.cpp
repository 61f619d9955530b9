// SPDX-License-Identifier: MIT
#include "atlas/output/dataset_card.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace atlas {
namespace {

TEST(DatasetCard, countsSizesGapsTemperaturesAndWhatIsLeftOut) {
  DatasetCard card(10 * kSecond);
  card.addFrame(100 * kSecond, Split::kVal, 640, 512, true);
  card.addFrame(101 * kSecond, Split::kTrain, 640, 512, false);  // one second is no gap yet
  card.addFrame(104 * kSecond, Split::kTrain, 320, 256, true);
  card.addBox(2, Split::kVal, 20.0, 30.0);
  card.addBox(2, Split::kTrain, 200.0, 50.0);
  card.addBox(2, Split::kTrain, 32.0, 32.0);
  card.addBox(0, Split::kTrain, 5.5, 40.0);
  card.addTemperatures({0, -10.0, 20.0});
  card.addTemperatures({0, -5.0, 45.0});
  card.drop("label: unknown class id");
  card.drop("label: unknown class id");
  const auto json = nlohmann::json::parse(card.json());
  EXPECT_EQ(json["frames"], (nlohmann::json{{"train", 2}, {"val", 1}, {"test", 0}}));
  EXPECT_EQ(json["frames_without_labels"]["train"], 1);
  EXPECT_EQ(json["image_sizes"], (nlohmann::json{{320, 256}, {640, 512}}));
  EXPECT_EQ(json["gaps_over_1_s"], 1);
  EXPECT_EQ(json["longest_gap_s"], 3.0);
  const auto& car = json["classes"]["car"];
  EXPECT_EQ(car["boxes"], (nlohmann::json{{"train", 2}, {"val", 1}, {"test", 0}}));
  EXPECT_EQ(car["sizes"], (nlohmann::json{{"small", 1}, {"medium", 1}, {"large", 1}}));
  EXPECT_EQ(car["shorter_side_px"], (nlohmann::json{20.0, 50.0}));
  EXPECT_EQ(json["classes"]["person"]["boxes"]["train"], 1);
  EXPECT_EQ(json["temperature_degc"], (nlohmann::json{-10.0, 45.0}));
  EXPECT_EQ(json["temperature_span_degc"], (nlohmann::json{30.0, 50.0}));
  EXPECT_EQ(json["dropped"]["label: unknown class id"], 2);
  const std::string text = card.markdown();
  EXPECT_NE(text.find("| car | 2 | 2 | 1 | 0 | 1 | 1 | 1 | 20.0 to 50.0 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| label: unknown class id | 2 |"), std::string::npos) << text;
}

TEST(DatasetCard, emptyIsSaidNotInvented) {
  const auto json = nlohmann::json::parse(DatasetCard(kSecond).json());
  EXPECT_TRUE(json["first_stamp_ns"].is_null());
  EXPECT_FALSE(json.contains("temperature_degc"));
}

}  // namespace
}  // namespace atlas
