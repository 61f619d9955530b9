// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "atlas/output/pcd.hpp"
#include "evaluate_fixture.hpp"
#include "synthetic/random.hpp"
#include "synthetic/rigid_fit.hpp"
#include "synthetic/scan_files.hpp"

namespace atlas::synthetic {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kDegree = M_PI / 180.0;
constexpr double kRounding = 2e-5;  // of float coordinates up to 100 m

/// Points of a street, every tenth without a return, every seventh on object 3.
std::vector<TruthPoint> makeScan(std::uint64_t seed) {
  Random random(seed, "scan");
  std::vector<TruthPoint> points;
  for (int i = 0; i < 3000; ++i) {
    const auto x = static_cast<float>(random.uniform(-50, 50)),
               y = static_cast<float>(random.uniform(-20, 20));
    const auto z = static_cast<float>(random.uniform(-2, 8));
    points.push_back(i % 10 == 0 ? TruthPoint{kNaN, kNaN, kNaN, kNaN}
                                 : TruthPoint{x, y, z, i % 7 == 0 ? 3.0F : 0.0F});
  }
  return points;
}

class PointsTest : public EvaluateTest {
 protected:
  void SetUp() override {
    EvaluateTest::SetUp();
    for (int scan : {0, 5}) {
      truth_.push_back(makeScan(static_cast<std::uint64_t>(scan)));
      writeTruthPoints(folders_.truth / "points" / "lidar_left" / name(scan, ".bin"), truth_.back());
    }
  }
  static std::string name(int scan, const char* extension) {
    char text[32];
    std::snprintf(text, sizeof text, "%06d%s", scan, extension);
    return text;
  }
  /// Writes both scans with each true point moved by `move(point index, point)`.
  template <class Move>
  void writeRun(Move&& move) {
    for (int k = 0; k < 2; ++k) {
      std::vector<LidarPoint> points(truth_[k].size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        const Eigen::Vector3d p =
            move(i, Eigen::Vector3f(truth_[k][i].x, truth_[k][i].y, truth_[k][i].z).cast<double>());
        points[i].x = static_cast<float>(p.x());
        points[i].y = static_cast<float>(p.y());
        points[i].z = static_cast<float>(p.z());
      }
      writeText(folders_.out / "deskewed" / "lidar_left" / name(5 * k, ".pcd"), encodePcd(points));
    }
  }
  Evaluation compare() {
    Evaluation evaluation;
    evaluatePoints(folders_, {}, evaluation);
    return evaluation;
  }

  std::vector<std::vector<TruthPoint>> truth_;
};

TEST_F(PointsTest, CopyOfTheTruthHasNoError) {
  writeRun([](std::size_t, const Eigen::Vector3d& p) { return p; });
  const auto result = compare().toJson()["points"];
  EXPECT_EQ(result["static_error_m"]["max"], 0.0);
  EXPECT_EQ(result["object_error_m"]["max"], 0.0);
  EXPECT_LT(result["distortion_m"]["max"], kRounding);
  EXPECT_EQ(result["returns_lost_percent"], 0.0);
  EXPECT_EQ(result["returns_invented"], 0);
  EXPECT_EQ(result["static_error_m"]["count"].get<int>() + result["object_error_m"]["count"].get<int>(),
            2 * 2700);
  EXPECT_FALSE(result.contains("noise_floor_median_m"));  // no meta.json here
  EXPECT_EQ(result["lidar_left"]["static_error_m"], result["static_error_m"]);
}

TEST_F(PointsTest, ShiftIsAnErrorButNoDistortion) {
  writeRun([](std::size_t, const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p + Eigen::Vector3d(0.3, 0.0, -0.4));
  });
  const auto result = compare().toJson()["points"];
  EXPECT_NEAR(result["static_error_m"]["median"], 0.5, kRounding);
  EXPECT_NEAR(result["object_error_m"]["max"], 0.5, kRounding);
  EXPECT_LT(result["distortion_m"]["max"], kRounding);
  EXPECT_LT(result["scan_turn_deg"]["max"], 1e-4);
}

TEST_F(PointsTest, TurnIsAnErrorButNoDistortion) {
  const Eigen::Quaterniond turn = expSo3({0, 0, 1.5 * kDegree});
  writeRun([&](std::size_t, const Eigen::Vector3d& p) { return Eigen::Vector3d(turn * p); });
  const auto result = compare().toJson()["points"];
  EXPECT_NEAR(result["scan_turn_deg"]["median"], 1.5, 1e-4);
  EXPECT_GT(result["static_error_m"]["p95"], 40.0 * 1.5 * kDegree);  // points up to 50 m away
  EXPECT_LT(result["distortion_m"]["max"], kRounding);
}

TEST_F(PointsTest, BendIsDistortion) {
  // Every other point 10 cm up, the others 10 cm down: no rigid motion takes that away. The points are
  // random, so the fit can gain no more than a few 0.1 m / sqrt(2300).
  writeRun([](std::size_t i, const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p + Eigen::Vector3d(0, 0, i % 2 == 0 ? 0.1 : -0.1));
  });
  const auto result = compare().toJson()["points"];
  EXPECT_NEAR(result["static_error_m"]["rmse"], 0.1, kRounding);
  EXPECT_NEAR(result["distortion_m"]["rmse"], 0.1, 0.005);
}

TEST_F(PointsTest, ObjectsAreApartFromWhatStands) {
  writeRun([](std::size_t i, const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p + Eigen::Vector3d(i % 7 == 0 ? 2.0 : 0.0, 0, 0));
  });
  const auto result = compare().toJson()["points"];
  EXPECT_EQ(result["static_error_m"]["max"], 0.0);
  EXPECT_NEAR(result["object_error_m"]["median"], 2.0, kRounding);
}

TEST_F(PointsTest, ScansAfterFiveSecondsOfDrivingAreApart) {
  const auto poses = [](Stamp from_s, Stamp to_s) {  // 1 m/s
    std::string text;
    for (Stamp t = 10 * from_s; t < 10 * to_s; ++t) {
      Odometry odometry;
      odometry.stamp = t * kSecond / 10;
      odometry.T_map_imu.translation.x() = 0.1 * static_cast<double>(t);
      text += tumLine(odometry);
    }
    return text;
  };
  writeText(folders_.truth / "trajectory.tum", poses(100, 110));
  // Scan 0 ends after 4 s of driving, scan 5 after 6 s.
  writeText(folders_.record / "lidar_left" / "timestamps.txt", "104000000000,0, 0\r\n106000000000,5, 0\r\n");
  int written = 0;
  writeRun([&](std::size_t, const Eigen::Vector3d& p) {
    return Eigen::Vector3d(p + Eigen::Vector3d(written++ < 3000 ? 1.0 : 0.25, 0, 0));
  });
  const auto result = compare().toJson()["points"];
  EXPECT_NEAR(result["static_error_m"]["max"], 1.0, kRounding);
  EXPECT_NEAR(result["static_error_after_5_s_of_driving_m"]["max"], 0.25, kRounding);
  EXPECT_EQ(2 * result["static_error_after_5_s_of_driving_m"]["count"].get<int>(),
            result["static_error_m"]["count"].get<int>());
}

TEST_F(PointsTest, LostAndInventedReturnsAreCounted) {
  writeRun([](std::size_t i, const Eigen::Vector3d& p) {
    if (i % 10 == 0) return Eigen::Vector3d(1, 2, 3);
    return i % 10 == 1 ? Eigen::Vector3d::Constant(std::nan("")).eval() : p;
  });
  const auto result = compare().toJson()["points"];
  EXPECT_NEAR(result["returns_lost_percent"], 100.0 / 9.0, 1e-9);
  EXPECT_EQ(result["returns_invented"], 600);
  EXPECT_EQ(result["static_error_m"]["max"], 0.0);
}

TEST_F(PointsTest, ScansThatAreAbsentOrDifferentAreNamed) {
  EXPECT_TRUE(compare().empty());
  EXPECT_TRUE(isSkipped(compare(), "deskewed: no such folder"));
  writeRun([](std::size_t, const Eigen::Vector3d& p) { return p; });
  writeText(folders_.out / "deskewed" / "lidar_left" / "000005.pcd", encodePcd(std::vector<LidarPoint>(7)));
  Evaluation evaluation = compare();
  EXPECT_TRUE(isSkipped(evaluation, "000005.pcd has 7 points, the scan 3000"));
  EXPECT_EQ(evaluation.toJson()["points"]["scan_turn_deg"]["count"], 1);
  std::filesystem::remove(folders_.out / "deskewed" / "lidar_left" / "000005.pcd");
  EXPECT_TRUE(isSkipped(compare(), "scan with truth but no file"));
}

TEST_F(PointsTest, NoiseFloorComesFromTheDrive) {
  writeRun([](std::size_t, const Eigen::Vector3d& p) { return p; });
  writeText(folders_.truth / "meta.json", R"({"noise": {"lidar_range_m": 0.02}})");
  const auto result = compare().toJson()["points"];
  // Half of all normal values lie within 0.6745 sigma, 95 % within 1.96.
  EXPECT_NEAR(result["noise_floor_median_m"], 0.01349, 1e-5);
  EXPECT_NEAR(result["noise_floor_p95_m"], 0.0392, 1e-5);
}

TEST(RigidFit, FindsTheMotionAmongOutliers) {
  Random random(1, "fit");
  const Pose truth{expSo3({0.1, -0.2, 0.7}), {3.0, -2.0, 0.5}};
  std::vector<PointPair> pairs;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d p(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-2, 5));
    const Eigen::Vector3d wrong = i % 10 == 0 ? Eigen::Vector3d(0.0, 3.0, 0.0) : Eigen::Vector3d::Zero();
    pairs.emplace_back(p.cast<float>(), (truth * p + wrong).cast<float>());
  }
  const auto T = rigidFit(pairs);
  ASSERT_TRUE(T);
  EXPECT_LT((T->translation - truth.translation).norm(), 1e-4);
  EXPECT_LT(logSo3(T->rotation.conjugate() * truth.rotation).norm(), 1e-5);
  pairs.resize(2);
  EXPECT_FALSE(rigidFit(pairs));
}

TEST(RigidFit, PointsOnALineFixNoRotation) {
  std::vector<PointPair> pairs;
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3f p(static_cast<float>(i), 0, 0);
    pairs.emplace_back(p, p);
  }
  EXPECT_FALSE(rigidFit(pairs));
}

}  // namespace
}  // namespace atlas::synthetic
