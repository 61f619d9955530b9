// SPDX-License-Identifier: MIT
#include "atlas/monitor/findings.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "atlas/monitor/anomaly.hpp"
#include "watched.hpp"

namespace atlas {
namespace {

using test::at;

TEST(AnomalyTable, EveryEntryIsComplete) {
  std::set<std::string> parameters, names;
  for (std::size_t i = 0; i < kAnomalies; ++i) {
    const AnomalyInfo& info = infoOf(static_cast<Anomaly>(i));
    ASSERT_NE(info.name, nullptr) << "entry " << i << " is missing";
    EXPECT_TRUE(parameters.insert(info.parameter).second) << info.parameter << " occurs twice";
    EXPECT_TRUE(names.insert(std::string(info.sensors) + " " + info.name).second) << info.name;
    EXPECT_NE(std::string(info.unit), "");
    EXPECT_NE(std::string(info.explanation), "");
    EXPECT_GT(info.severity, 0.0) << info.parameter;
    EXPECT_LE(info.severity, 1.0) << info.parameter;
  }
}

TEST(AnomalyTable, EntriesStandInTheOrderOfTheEnumeration) {
  EXPECT_STREQ(infoOf(Anomaly::kMissing).parameter, "missing_s");
  EXPECT_STREQ(infoOf(Anomaly::kGyroBias).parameter, "gyro_bias_jump_radps");
  EXPECT_STREQ(infoOf(Anomaly::kHeadingLost).parameter, "heading_lost_s");
  EXPECT_STREQ(infoOf(Anomaly::kOccluded).parameter, "occluded_share");
  EXPECT_STREQ(infoOf(Anomaly::kTargetsFrozen).parameter, "targets_frozen_s");
}

TEST(AnomalyTable, IsTheOneInTheReadme) {
  const auto repository = std::filesystem::canonical(__FILE__).parent_path() / "../../..";
  std::ifstream file(repository / "atlas_loader/README.md");
  ASSERT_TRUE(file) << repository;
  const std::string readme((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  EXPECT_NE(readme.find(anomalyTable()), std::string::npos) << "paste what check_sensors --list prints";
}

TEST(Findings, ScoreIsTheProductOfWhatIsLeft) {
  Findings findings{AnomalyThresholds()};
  EXPECT_DOUBLE_EQ(findings.score(), 1.0);
  findings.measure(Anomaly::kGap, at(0), 2.0);      // severity 0.2
  findings.measure(Anomaly::kGravity, at(0), 1.5);  // severity 0.6
  EXPECT_NEAR(findings.score(), 0.8 * 0.4, 1e-12);
  findings.measure(Anomaly::kMissing, at(0), 3.0);
  EXPECT_DOUBLE_EQ(findings.score(), 0.0);
}

TEST(Findings, ExactlyAtTheThresholdIsNoAnomaly) {
  Findings findings{AnomalyThresholds()};
  findings.measure(Anomaly::kGap, at(0), infoOf(Anomaly::kGap).threshold);
  findings.measure(Anomaly::kBlack, at(0), infoOf(Anomaly::kBlack).threshold);
  EXPECT_TRUE(findings.list().empty());
}

TEST(Findings, LastsUntilMeasuredGoodAndForASecondAtLeast) {
  Findings findings{AnomalyThresholds()};
  findings.measure(Anomaly::kGap, at(0), 2.0);
  EXPECT_TRUE(findings.takeChange());
  EXPECT_FALSE(findings.takeChange());
  findings.measure(Anomaly::kGap, at(0.5), 1.0);
  EXPECT_TRUE(findings.has(Anomaly::kGap)) << "a single bad interval must be seen by others";
  findings.measure(Anomaly::kGap, at(0.9), 3.0);
  findings.measure(Anomaly::kGap, at(1.5), 1.0);
  EXPECT_TRUE(findings.has(Anomaly::kGap));
  EXPECT_FALSE(findings.takeChange()) << "the same anomaly goes on";
  findings.measure(Anomaly::kGap, at(1.9), 1.0);
  EXPECT_FALSE(findings.has(Anomaly::kGap));
  EXPECT_TRUE(findings.takeChange());
  EXPECT_EQ(findings.begun()[static_cast<std::size_t>(Anomaly::kGap)], 1U);
}

TEST(Findings, TellsTheNewestValueBeyondTheThreshold) {
  Findings findings{AnomalyThresholds()};
  findings.measure(Anomaly::kBlurred, at(1), 0.3);
  findings.measure(Anomaly::kBlurred, at(2), 0.2);
  findings.measure(Anomaly::kBlurred, at(2.5), 0.9);
  ASSERT_EQ(findings.list().size(), 1U);
  EXPECT_EQ(findings.list()[0].name, "blurred");
  EXPECT_DOUBLE_EQ(findings.list()[0].value, 0.2);
  EXPECT_EQ(findings.list()[0].since, at(1));
}

}  // namespace
}  // namespace atlas
