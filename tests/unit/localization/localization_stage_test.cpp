// SPDX-License-Identifier: MIT
#include "atlas/localization/localization_stage.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <stdexcept>

#include "stage_run.hpp"

namespace atlas::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

struct Short {
  DriveParams drive_params = cityDrive(12.0);
  std::vector<Truth> truth = drive(drive_params);
  Recording recording;
  Short() {
    std::mt19937 random(5);
    const Errors e = realisticErrors(random);
    // Every fifth sample has the stamp of a fix and a heading: ties.
    recording = record(truth, drive_params, e, random, 20.0, 0);
  }
};

bool same(const Odometry& a, const Odometry& b) {
  return a.stamp == b.stamp && a.T_map_imu.rotation.coeffs() == b.T_map_imu.rotation.coeffs() &&
         a.T_map_imu.translation == b.T_map_imu.translation && a.velocity_imu_mps == b.velocity_imu_mps &&
         a.angular_velocity_imu_radps == b.angular_velocity_imu_radps &&
         a.pose_covariance == b.pose_covariance && a.twist_covariance == b.twist_covariance;
}

/// Pushes the streams in a random interleaving; within a stream the order stays.
StageRun runShuffled(const Short& s, unsigned seed) {
  StageRun result;
  LocalizationStage stage{LocalizationParams{}};
  listen(stage, result);
  std::array<std::size_t, 4> next{};
  const std::array<std::size_t, 4> size{1, s.recording.fixes.size(), s.recording.headings.size(),
                                        s.recording.imu.size()};
  std::mt19937 random(seed);
  while (true) {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < 4; ++i) {
      if (next[i] < size[i]) open.push_back(i);
    }
    if (open.empty()) break;
    const std::size_t input = open[random() % open.size()];
    for (std::size_t burst = random() % 40; burst > 0 && next[input] < size[input]; --burst) {
      const std::size_t i = next[input]++;
      if (input == 0) stage.push(s.recording.imu.front().stamp, rigWith(s.drive_params.lever_arm_imu));
      if (input == 1) stage.push(s.recording.fixes[i]);
      if (input == 2) stage.push(s.recording.headings[i]);
      if (input == 3) stage.push(s.recording.imu[i]);
      if (next[input] == size[input]) stage.finish(input);
    }
  }
  EXPECT_TRUE(stage.ended());
  result.counters = stage.counters();
  return result;
}

TEST(LocalizationStage, ArrivalOrderHasNoInfluence) {
  const Short s;
  const StageRun reference = runStage(s.recording, s.drive_params);
  ASSERT_GT(reference.odometry.size(), 1000U);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const StageRun shuffled = runShuffled(s, seed);
    ASSERT_EQ(shuffled.odometry.size(), reference.odometry.size());
    for (std::size_t i = 0; i < reference.odometry.size(); ++i) {
      ASSERT_TRUE(same(shuffled.odometry[i], reference.odometry[i])) << "seed " << seed << " odometry " << i;
    }
    EXPECT_EQ(shuffled.counters.all(), reference.counters.all());
  }
}

TEST(LocalizationStage, EveryInputIsAccountedFor) {
  const Short s;
  const StageRun r = runStage(s.recording, s.drive_params);
  const Counters& c = r.counters;
  EXPECT_EQ(c.get("fix"), s.recording.fixes.size());
  EXPECT_EQ(c.get("imu"), s.recording.imu.size());
  EXPECT_EQ(c.get("heading"), s.recording.headings.size());
  const auto sumOf = [&](const std::string& used, const std::string& skipped) {
    std::uint64_t sum = 0;
    for (const auto& [key, count] : c.all()) {
      if (key == used || key.rfind(skipped, 0) == 0) sum += count;
    }
    return sum;
  };
  EXPECT_EQ(sumOf("fix used", "skipped fix:"), c.get("fix"));
  EXPECT_EQ(sumOf("heading used", "skipped heading:") + c.get("heading initialized from gnss heading"),
            c.get("heading"));
  EXPECT_EQ(c.get("odometry") + c.get("skipped odometry: no pose yet"), c.get("imu"));
  EXPECT_EQ(c.get("odometry"), r.odometry.size());
}

TEST(LocalizationStage, AnchorIsTheFirstFixOnce) {
  Short s;
  s.recording.fixes[0].position.latitude_deg = kNan;  // that one is no fix
  const StageRun r = runStage(s.recording, s.drive_params);
  ASSERT_TRUE(r.anchor);
  EXPECT_EQ(r.anchor->stamp, s.recording.fixes[1].stamp);
  EXPECT_EQ(r.anchor->position.latitude_deg, s.recording.fixes[1].position.latitude_deg);
  EXPECT_EQ(r.counters.get("skipped fix: not finite"), 1U);
}

TEST(LocalizationStage, W11_AThousandMetresAreAThousandMetres) {
  // W11: the published program lost 3.07 m east and 0.23 m north of every kilometre. Reference: the
  // ellipsoid's radii of curvature at 49.2281 deg and 281 m (WGS84): N cos(lat) and M.
  const double lat = kBrno.latitude_deg * M_PI / 180.0, e2 = 0.00669437999014;
  const double w = std::sqrt(1.0 - e2 * std::sin(lat) * std::sin(lat));
  const double east_radius = (6378137.0 / w + kBrno.altitude_m) * std::cos(lat);
  const double north_radius = 6378137.0 * (1.0 - e2) / (w * w * w) + kBrno.altitude_m;
  for (const bool east : {true, false}) {
    Geodetic target = kBrno;
    (east ? target.longitude_deg : target.latitude_deg) +=
        1000.0 / (east ? east_radius : north_radius) * 180.0 / M_PI;
    StageRun result;
    LocalizationParams params;
    params.gnss_antenna_frame = "";
    LocalizationStage stage(params);
    listen(stage, result);
    stage.finish(LocalizationStage::kTfStatic);
    stage.push(GnssFix{0, kBrno, std::nullopt});
    for (int i = 1; i <= 40; ++i) {
      stage.push(GnssFix{i * kSecond / 10, target, std::nullopt});
    }
    stage.push(GnssHeading{kSecond / 10, 0.0, std::nullopt});
    stage.finish(LocalizationStage::kGnssFix);
    stage.finish(LocalizationStage::kGnssHeading);
    for (int i = 0; i <= 400; ++i) {
      ImuSample sample;
      sample.stamp = i * kSecond / 100;
      sample.linear_acceleration_mps2.z() = normalGravity(kBrno.latitude_deg, kBrno.altitude_m);
      sample.orientation = Eigen::Quaterniond::Identity();
      stage.push(sample);
    }
    stage.finish(LocalizationStage::kImu);
    ASSERT_FALSE(result.odometry.empty());
    const Eigen::Vector3d p = result.odometry.back().T_map_imu.translation;
    EXPECT_NEAR(east ? p.x() : p.y(), 1000.0, 0.005) << (east ? "east" : "north");
    EXPECT_NEAR(p.z(), -1000.0 * 1000.0 / (2.0 * 6.38e6), 0.01);  // map is tangential
  }
}

TEST(LocalizationStage, MissingLeverArmSkipsFixesWithAReason) {
  const Short s;
  StageRun result;
  LocalizationStage stage{LocalizationParams{}};
  listen(stage, result);
  for (const auto input : {LocalizationStage::kTfStatic, LocalizationStage::kGnssHeading})
    stage.finish(input);
  for (const GnssFix& fix : s.recording.fixes) stage.push(fix);
  stage.finish(LocalizationStage::kGnssFix);
  for (const ImuSample& sample : s.recording.imu) stage.push(sample);
  stage.finish(LocalizationStage::kImu);
  EXPECT_TRUE(result.odometry.empty());
  EXPECT_TRUE(result.anchor);
  EXPECT_EQ(stage.counters().get("skipped fix: no extrinsic calibration for the frame"),
            s.recording.fixes.size());
}

TEST(LocalizationStage, BadSamplesAreSkippedAndCounted) {
  Short s;
  s.recording.imu[500].linear_acceleration_mps2.x() = kNan;
  s.recording.imu[600].stamp = s.recording.imu[599].stamp;
  s.recording.imu[700].orientation = Eigen::Quaterniond(0, 0, 0, 0);
  s.recording.headings[100].yaw_rad = std::numeric_limits<double>::infinity();
  s.recording.fixes[100].covariance_enu_m2 = std::array<double, 9>{};  // all zero
  s.recording.headings[101].variance_rad2 = -1.0;
  const StageRun r = runStage(s.recording, s.drive_params);
  EXPECT_EQ(r.counters.get("skipped imu: not finite"), 1U);
  EXPECT_EQ(r.counters.get("skipped imu: stamp out of order"), 1U);
  EXPECT_EQ(r.counters.get("skipped imu orientation: quaternion not normalized"), 1U);
  EXPECT_EQ(r.counters.get("skipped heading: not finite"), 1U);
  EXPECT_EQ(r.counters.get("fix covariance unusable, parameter taken"), 1U);
  EXPECT_EQ(r.counters.get("heading variance unusable, parameter taken"), 1U);
  const auto all = errors(r.odometry, s.truth, s.recording, s.drive_params);
  EXPECT_LT(rms(all, 8.0, 12.0, [](const PoseError& e) { return e.position_m.head<2>().norm(); }), 0.05);
}

TEST(LocalizationStage, LateInputIsCounted) {
  Short s;
  std::swap(s.recording.imu[300].stamp, s.recording.imu[301].stamp);
  const StageRun r = runStage(s.recording, s.drive_params);
  EXPECT_EQ(r.counters.get("skipped imu: late"), 1U);
}

TEST(LocalizationStage, CovarianceOfTheFixIsUsed) {
  Short s;
  for (GnssFix& fix : s.recording.fixes)
    fix.covariance_enu_m2 = std::array<double, 9>{4, 0, 0, 0, 1, 0, 0, 0, 9};
  LocalizationParams params;
  const StageRun r = runStage(s.recording, s.drive_params, params);
  ASSERT_FALSE(r.odometry.empty());
  const auto& P = r.odometry.back().pose_covariance;
  EXPECT_GT(P[0], P[7]);
  EXPECT_GT(P[14], P[0]);
  EXPECT_GT(P[7], 0.01);
}

TEST(LocalizationStage, ProgressFollowsTheSlowestInput) {
  const Short s;
  StageRun result;
  LocalizationStage stage{LocalizationParams{}};
  listen(stage, result);
  const Stamp t0 = s.recording.imu.front().stamp;
  EXPECT_EQ(stage.progress(), kBeginOfTime);
  stage.finish(LocalizationStage::kTfStatic);
  stage.finish(LocalizationStage::kGnssHeading);
  stage.advance(LocalizationStage::kGnssFix, t0 + 5 * kSecond);
  stage.advance(LocalizationStage::kImu, t0 + 3 * kSecond);
  EXPECT_EQ(stage.progress(), t0 + 3 * kSecond);
  stage.finish(LocalizationStage::kImu);
  EXPECT_EQ(stage.progress(), t0 + 5 * kSecond);
  stage.finish(LocalizationStage::kGnssFix);
  EXPECT_EQ(stage.progress(), kEndOfTime);
}

TEST(LocalizationStage, RefusesAWrongConfiguration) {
  LocalizationParams params;
  params.filter = "particle";
  EXPECT_THROW(LocalizationStage{params}, std::invalid_argument);
  params = {};
  params.positioning.max_imu_gap_s = 0.0;
  EXPECT_THROW(LocalizationStage{params}, std::invalid_argument);
}

}  // namespace
}  // namespace atlas::test
