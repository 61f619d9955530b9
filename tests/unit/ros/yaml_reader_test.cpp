// SPDX-License-Identifier: MIT
// Missing, mistyped and unknown keys are refused by name; every configuration that ships can be read
// completely.
#include "atlas_ros/yaml_reader.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "atlas_ros/stage_params.hpp"

namespace {

std::string messageOf(const std::function<void()>& body) {
  try {
    body();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(YamlReader, NamesWhatIsWrong) {
  const YAML::Node node = YAML::Load("{lidars: [a], batches_per_sweep: many, min_rnage_m: 1}");
  double value = 0;
  int count = 0;
  atlas_ros::YamlReader reader(node, "x.yaml: deskew");
  EXPECT_EQ(messageOf([&] { reader.read("min_range_m", value); }),
            "x.yaml: deskew: missing parameter min_range_m");
  EXPECT_EQ(messageOf([&] { reader.read("batches_per_sweep", count); }),
            "x.yaml: deskew: parameter batches_per_sweep has the wrong type");
  std::vector<std::string> lidars;
  reader.read("lidars", lidars);
  EXPECT_EQ(lidars, std::vector<std::string>{"a"});
  EXPECT_NE(messageOf([&] { reader.rejectUnread(); }).find("unknown parameter"), std::string::npos);
}

TEST(Configurations, WhatIsWrongWithTheFileIsSaidWithItsName) {
  const std::string file = testing::TempDir() + "configuration_test.yaml";
  EXPECT_NE(messageOf([&] { (void)atlas_ros::loadConfiguration(file + ".none"); }).find(file + ".none"),
            std::string::npos);
  const auto messageFor = [&](const std::string& text) {
    std::ofstream(file) << text;
    return messageOf([&] {
      (void)atlas_ros::readSection<atlas::DeskewParams>(atlas_ros::loadConfiguration(file), file, "deskew");
    });
  };
  EXPECT_EQ(messageFor("just words"), "configuration " + file + ": not a map of sections");
  EXPECT_NE(messageFor("deskew: [").find("configuration " + file), std::string::npos);
  EXPECT_EQ(messageFor("localization: {}"), file + ": deskew: missing or not a map");
}

TEST(Configurations, EveryStageSectionIsComplete) {
  for (const char* name : {"bud.yaml", "kitti.yaml"}) {
    const YAML::Node root = YAML::LoadFile(std::string(ATLAS_REPO_ROOT) + "/atlas_bringup/config/" + name);
    const auto check = [&](const char* section, auto params) {
      atlas_ros::YamlReader reader(root[section], std::string(name) + ": " + section);
      EXPECT_NO_THROW(readParams(reader, params); reader.rejectUnread(); validate(params))
          << name << " " << section;
    };
    check("localization", atlas::LocalizationParams());
    check("deskew", atlas::DeskewParams());
    check("aggregate", atlas::AggregateParams());
    check("obstacles", atlas::ObstacleParams());
    check("lines", atlas::LineParams());
    check("camera_lidar", atlas::CameraLidarParams());
    check("thermal", atlas::ThermalParams());
    check("depth", atlas::DepthParams());
    check("objects", atlas::ObjectParams());
    check("local_map", atlas::LocalMapParams());
    check("stereo", atlas::StereoStageParams());
    check("occupancy", atlas::OccupancyParams());
    check("sensor_monitor", atlas::MonitorParams());
  }
}

}  // namespace
