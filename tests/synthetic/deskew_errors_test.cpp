// SPDX-License-Identifier: MIT
// A sweep whose points are where they truly are: no error; moved as a whole: an error in the map but no
// distortion; read without de-skew: distorted.
#include "synthetic/deskew_errors.hpp"

#include <cmath>
#include <random>

#include "evaluate_fixture.hpp"
#include "synthetic/scan_files.hpp"

namespace atlas::synthetic {
namespace {

constexpr double kTurn_s = 0.1;
constexpr int kPoints = 2000;
constexpr Duration kAt = 10 * kSecond;  // after the start, when the car drives straight on

class DeskewErrorsTest : public EvaluateTest {
 protected:
  void SetUp() override {
    EvaluateTest::SetUp();
    writeTrueRun();
    for (const StampedPose& pose : readTrajectory(folders_.truth / "trajectory.tum")) true_.push(pose);
  }
  /// A sweep and the truth of its points beside it; every tenth
  /// point lies on a moving object and is where nothing is.
  [[nodiscard]] SweepPtr seen() const {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> side(-30.0, 30.0);
    auto sweep = std::make_shared<Sweep>();
    sweep->stamp = true_.poses().front().stamp + kAt;
    std::vector<TruthPoint> truth;
    for (int i = 0; i < kPoints; ++i) {
      const double time_s = kTurn_s * i / kPoints - kTurn_s;
      const Pose T = *true_.at(sweep->stamp + fromSeconds(time_s)) * T_imu_lidar_;
      Eigen::Vector3d p(side(random), side(random), side(random) / 10);
      if (p.norm() < 2.0) p.x() += 5.0;
      const bool moving = i % 10 == 0;
      const Eigen::Vector3f q = (T * p).cast<float>();
      if (moving) p.y() += 3.0;
      sweep->points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                               static_cast<float>(p.z()), 0, static_cast<float>(time_s), 0, 0});
      truth.push_back({q.x(), q.y(), q.z(), moving ? 7.0F : 0.0F});
    }
    std::filesystem::create_directories(folders_.truth / "points" / "lidar_left");
    writeTruthPoints(folders_.truth / "points" / "lidar_left" / "000000.bin", truth);
    return sweep;
  }
  [[nodiscard]] VehicleMotion motion(const Pose& T_moved = Pose{}) const {
    VehicleMotion run;
    for (const StampedPose& pose : true_.poses()) run.push(StampedPose{pose.stamp, T_moved * pose.pose});
    return run;
  }
  /// What is said about the sweep when the run's poses are the true ones moved by T_moved (about the map's
  /// origin).
  [[nodiscard]] nlohmann::ordered_json judged(const Pose& T_moved = Pose{}) const {
    const VehicleMotion run = motion(T_moved);
    DeskewErrors errors(folders_.truth, DriveOptions().anchor, run);
    errors.add("lidar_left", 0, seen(), T_imu_lidar_);
    nlohmann::ordered_json json;
    errors.print(json);
    EXPECT_EQ(json.size(), 1U);
    return json.empty() ? json : json.begin().value();
  }
  static double median_cm(const nlohmann::ordered_json& json, const char* way, const char* what) {
    return json.at(way).at(what).at(0).get<double>();
  }

  Trajectory true_;
  Pose T_imu_lidar_{fromRollPitchYaw({0.02, -0.03, 0.4}), Eigen::Vector3d(0.8, -0.4, 0.3)};
};

TEST_F(DeskewErrorsTest, TruePosesLeaveNothing) {
  const auto json = judged();
  EXPECT_EQ(json.at("per point").at("points"), kPoints * 9 / 10) << "what moves does not count";
  // Floats of coordinates below 200 m and poses in text leave less than a tenth of a millimetre.
  EXPECT_LT(median_cm(json, "per point", "distortion_cm"), 0.01);
  EXPECT_LT(median_cm(json, "per point", "in_map_cm"), 0.01);
}

TEST_F(DeskewErrorsTest, ASweepThatIsMovedAsAWholeIsNotDistorted) {
  const auto json = judged({Eigen::Quaterniond::Identity(), Eigen::Vector3d(0.3, 0.4, 0.0)});
  EXPECT_NEAR(median_cm(json, "per point", "in_map_cm"), 50.0, 0.02);
  EXPECT_LT(median_cm(json, "per point", "distortion_cm"), 0.01);
  const auto turned = judged({fromRollPitchYaw({0.0, 0.0, 0.01}), Eigen::Vector3d::Zero()});
  EXPECT_GT(median_cm(turned, "per point", "in_map_cm"), 1.0);
  EXPECT_LT(median_cm(turned, "per point", "distortion_cm"), 0.01);
}

TEST_F(DeskewErrorsTest, WithoutDeskewTheSweepIsDistortedByItsMotion) {
  const Pose a = *true_.at(true_.poses().front().stamp + kAt - fromSeconds(kTurn_s));
  const Pose b = *true_.at(true_.poses().front().stamp + kAt);
  const double moved_cm = 100 * (b.translation - a.translation).norm();
  ASSERT_GT(moved_cm, 20.0) << "the car drives";
  const auto json = judged();
  // Shifts spread evenly over +- moved / 2: their median size is a quarter of the motion. The rigid fit may
  // take a little of it, as places and times of the points are not related here.
  EXPECT_NEAR(median_cm(json, "none", "distortion_cm"), moved_cm / 4, 0.1 * moved_cm);
  EXPECT_GT(median_cm(json, "thinned first", "distortion_cm"), 0.1 * moved_cm);
}

TEST_F(DeskewErrorsTest, NoTruthIsNoErrorAndNoAnchorIsSaid) {
  const VehicleMotion run = motion();
  DeskewErrors errors(folders_.truth, DriveOptions().anchor, run);
  errors.add("lidar_left", 5, seen(), T_imu_lidar_);
  nlohmann::ordered_json json;
  errors.print(json);
  EXPECT_TRUE(json.empty());
  EXPECT_THROW(DeskewErrors(base_ / "nowhere", DriveOptions().anchor, run), std::runtime_error);
}

}  // namespace
}  // namespace atlas::synthetic
