// SPDX-License-Identifier: MIT
#include "evaluate_fixture.hpp"

namespace atlas::synthetic {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr double kRounding = 1e-6;  // files have 9 decimals, the geodesy 1 nm, errors are kept as float

class TrajectoryTest : public EvaluateTest {
 protected:
  void SetUp() override {
    EvaluateTest::SetUp();
    writeTrueRun();
    truth_ = readTrajectory(folders_.truth / "trajectory.tum");
    anchor_ = *readAnchor(folders_.truth / "anchor.json");
  }
  nlohmann::ordered_json compare() { return evaluateRun(folders_).toJson(); }

  std::vector<StampedPose> truth_;
  Geodetic anchor_;
};

TEST_F(TrajectoryTest, CopyOfTheTruthHasNoError) {
  const auto result = compare();
  for (const char* name : {"horizontal_error_m", "vertical_error_m"})
    EXPECT_LT(result["trajectory"][name]["max"], kRounding) << name;
  for (const char* name : {"heading_error_deg", "roll_error_deg", "pitch_error_deg"})
    EXPECT_LT(result["trajectory"][name]["max"], kRounding) << name;
  EXPECT_EQ(result["trajectory"]["stamps_answered_percent"], 100.0);
  EXPECT_EQ(result["trajectory"]["horizontal_error_m"]["count"], truth_.size());
  EXPECT_FALSE(result.contains("smoothed"));
}

TEST_F(TrajectoryTest, ShiftAndTurnComeBackAsTheyAre) {
  std::vector<StampedPose> run = truth_;
  for (StampedPose& pose : run) {
    pose.pose.translation += Eigen::Vector3d(0.3, -0.4, -0.2);
    pose.pose.rotation = expSo3({0, 0, -2.0 * kDegree}) * pose.pose.rotation;
  }
  writeRun(run, anchorText(anchor_));
  const auto all = compare()["trajectory"];
  for (const char* key : {"median", "rmse", "p95", "max"}) {
    EXPECT_NEAR(all["horizontal_error_m"][key], 0.5, kRounding) << key;
    EXPECT_NEAR(all["vertical_error_m"][key], 0.2, kRounding) << key;
    EXPECT_NEAR(all["heading_error_deg"][key], 2.0, kRounding) << key;
    EXPECT_NEAR(all["roll_error_deg"][key], 0.0, kRounding) << key;
  }
}

TEST_F(TrajectoryTest, AnotherAnchorOfTheSameEarthIsNoError) {
  const LocalEnu truth(anchor_);
  const Geodetic elsewhere = truth.toGeodetic({400.0, -300.0, 20.0});
  const LocalEnu map(elsewhere);
  std::vector<StampedPose> run = truth_;
  for (StampedPose& pose : run) pose.pose.translation = map.toMap(truth.toGeodetic(pose.pose.translation));
  writeRun(run, anchorText(elsewhere));
  const auto all = compare()["trajectory"];
  EXPECT_LT(all["horizontal_error_m"]["max"], kRounding);
  EXPECT_LT(all["vertical_error_m"]["max"], kRounding);
  // The rotations were left as they are, so what remains is the meridians' convergence: 400 m east at
  // latitude 49.2.
  EXPECT_NEAR(all["heading_error_deg"]["median"], 400.0 * std::tan(49.228 * kDegree) / 6.39e6 / kDegree,
              1e-4);
}

TEST_F(TrajectoryTest, WrongAnchorIsSeen) {
  const Geodetic wrong = LocalEnu(anchor_).toGeodetic({0.0, 1.0, -0.5});
  writeRun(truth_, anchorText(wrong));
  const auto all = compare()["trajectory"];
  EXPECT_NEAR(all["horizontal_error_m"]["median"], 1.0, 1e-4);
  EXPECT_NEAR(all["vertical_error_m"]["median"], 0.5, 1e-4);
}

TEST_F(TrajectoryTest, SettledPartBeginsAfterFiveSecondsOfDriving) {
  const auto driven =
      [&](std::size_t i) {  // well beyond 5 s of driving: the car stands for at most a few seconds
        return toSeconds(truth_[i].stamp - truth_.front().stamp) > 15.0;
      };
  std::vector<StampedPose> run = truth_;
  for (std::size_t i = 0; i < run.size(); ++i) {
    const bool moved = (truth_[i].pose.translation - truth_.front().pose.translation).norm() > 1.0;
    if (!moved) run[i].pose.rotation = expSo3({0, 0, 30.0 * kDegree}) * run[i].pose.rotation;
    if (driven(i)) run[i].pose.rotation = expSo3({0, 0, 1.0 * kDegree}) * run[i].pose.rotation;
  }
  writeRun(run, anchorText(anchor_));
  const auto result = compare();
  EXPECT_NEAR(result["trajectory"]["heading_error_deg"]["max"], 30.0, 1e-4);
  const auto after = result["trajectory_after_5_s_of_driving"];
  EXPECT_NEAR(after["heading_error_deg"]["max"], 1.0, 1e-4);
  const std::size_t settled = after["heading_error_deg"]["count"];
  EXPECT_GT(settled, truth_.size() / 4 - 1);    // all beyond 15 of 20 s
  EXPECT_LT(settled, truth_.size() - 5 * 390);  // not the 5 s of driving themselves, at 400 Hz
}

TEST_F(TrajectoryTest, MissingAnswersAreCountedAndStrangeOnesToo) {
  std::vector<StampedPose> run;
  for (std::size_t i = 0; i < truth_.size(); i += 4) run.push_back(truth_[i]);
  run.push_back({run.back().stamp + 1, run.back().pose});
  writeRun(run, anchorText(anchor_));
  const Evaluation evaluation = evaluateRun(folders_);
  EXPECT_NEAR(evaluation.toJson()["trajectory"]["stamps_answered_percent"], 25.0, 0.05);
  EXPECT_EQ(evaluation.skipped().at("trajectory/trajectory.tum: stamp without a true pose"), 1U);
}

TEST_F(TrajectoryTest, MissingFilesAreAbsentAndSaid) {
  std::filesystem::remove(folders_.out / "trajectory" / "trajectory.tum");
  Evaluation evaluation = evaluateRun(folders_);
  EXPECT_TRUE(evaluation.empty());
  EXPECT_TRUE(isSkipped(evaluation, "trajectory/trajectory.tum"));
  for (const char* product : {"deskewed", "depth", "frustums", "thermal"})
    EXPECT_TRUE(isSkipped(evaluation, product)) << product;
  writeTrueRun();
  std::filesystem::remove(folders_.out / "trajectory" / "anchor.json");
  evaluation = evaluateRun(folders_);
  EXPECT_TRUE(evaluation.empty());
  EXPECT_TRUE(isSkipped(evaluation, "anchor.json"));
  std::filesystem::remove(folders_.truth / "anchor.json");
  EXPECT_THROW(evaluateRun(folders_), std::runtime_error);
}

TEST(ErrorStatistics, QuantilesAreValuesThatOccurred) {
  std::vector<float> errors;
  for (int i = 100; i >= 1; --i) errors.push_back(static_cast<float>(i % 2 == 0 ? i : -i));
  const auto statistics = statisticsOf(errors);
  ASSERT_TRUE(statistics);
  EXPECT_EQ(statistics->count, 100U);
  EXPECT_EQ(statistics->median, 50.0);
  EXPECT_EQ(statistics->p95, 95.0);
  EXPECT_EQ(statistics->max, 100.0);
  EXPECT_NEAR(statistics->rmse, std::sqrt(101.0 * 201.0 / 6.0),
              1e-9);  // sum of squares: n (n + 1) (2 n + 1) / 6
  std::vector<float> none;
  EXPECT_FALSE(statisticsOf(none));
  EXPECT_FALSE(Share{}.percent());
}

}  // namespace
}  // namespace atlas::synthetic
