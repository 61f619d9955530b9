// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <limits>

#include "evaluate_fixture.hpp"
#include "synthetic/plan_box.hpp"
#include "synthetic/scan_files.hpp"

namespace atlas::synthetic {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr int kInstants = 3;

PlanBox box(double x, double y, double length, double width, double yaw_rad) {
  PlanBox b;
  b.center = {x, y};
  b.length = length;
  b.width = width;
  b.yaw_rad = yaw_rad;
  return b;
}

TEST(PlanBox, OverlapOfAreas) {
  const PlanBox car = box(3, -2, 4, 2, 0.4);
  EXPECT_NEAR(overlapOfAreas(car, car), 1.0, 1e-12);
  EXPECT_NEAR(overlapOfAreas(car, box(3, -2, 4, 2, 0.4 + M_PI)), 1.0, 1e-12) << "a box has no front";
  EXPECT_NEAR(overlapOfAreas(car, box(3, -2, 4, 1, 0.4)), 0.5, 1e-12);
  EXPECT_NEAR(overlapOfAreas(box(0, 0, 2, 2, 0), box(1, 0, 2, 2, 0)), 1.0 / 3.0, 1e-12);
  // two unit squares, one turned by an eighth: the octagon has 2 (sqrt(2) - 1) of area
  const double octagon = 2.0 * (std::sqrt(2.0) - 1.0);
  EXPECT_NEAR(overlapOfAreas(box(0, 0, 1, 1, 0), box(0, 0, 1, 1, M_PI / 4)), octagon / (2.0 - octagon),
              1e-12);
  EXPECT_EQ(overlapOfAreas(car, box(13, -2, 4, 2, 0.4)), 0.0);
  EXPECT_EQ(overlapOfAreas(box(0, 0, 0, 0, 0), box(0, 0, 0, 0, 0)), 0.0);
}

/// The vehicle stands in the true drive; two objects of 40 returns each (a car at 10 m, a person at 8 m), a
/// wall.
class ObstaclesTest : public EvaluateTest {
 protected:
  void SetUp() override {
    EvaluateTest::SetUp();
    DriveOptions options;
    options.duration_s = 2.0;
    const World world(options);
    writeTruth(world, folders_.truth);
    here_ = world.T_map_imu(options.start).translation;
    std::string stamps, objects = "stamp_ns,id,class,x,y,z,yaw,length,width,height,vx,vy,vz\n";
    for (int i = 0; i < kInstants; ++i) {
      stamp_[i] = options.start + (i + 1) * 100 * kMillisecond;
      stamps += std::to_string(stamp_[i]) + "," + std::to_string(i) + ", 0\n";
      objects += object(i, 1, 2, 10.0, 0.0, 4.0, 2.0) + object(i, 2, 0, 0.0, 8.0, 0.5, 0.5);
      writeTruthPoints(folders_.truth / "points" / "lidar_left" / ("00000" + std::to_string(i) + ".bin"),
                       points());
    }
    writeText(folders_.record / "lidar_left" / "timestamps.txt", stamps);
    writeText(folders_.truth / "objects.csv", objects);
  }
  std::string object(int i, int id, int class_id, double x, double y, double length, double width) const {
    char row[300];
    std::snprintf(row, sizeof row, "%lld,%d,%d,%.4f,%.4f,%.4f,0,%.3f,%.3f,1.5,0,0,0\n",
                  static_cast<long long>(stamp_[i]), id, class_id, here_.x() + x, here_.y() + y, here_.z(),
                  length, width);
    return row;
  }
  std::vector<TruthPoint> points() const {
    std::vector<TruthPoint> points;
    const auto add = [&](double x, double y, double z, float owner) {
      points.push_back({static_cast<float>(here_.x() + x), static_cast<float>(here_.y() + y),
                        static_cast<float>(here_.z() + z), owner});
    };
    for (int i = 0; i < 40; ++i) {
      add(8.0 + 0.1 * i, -1.0, 0.0, 1.0F);
      add(-0.2 + 0.01 * i, 8.0, 0.0, 2.0F);
      add(-10.0, -2.0 + 0.1 * i, 0.5, 0.0F);  // wall
      add(-6.0, -2.0 + 0.1 * i, -5.0, 0.0F);  // far below the street: ground
    }
    points.push_back({kNaN, kNaN, kNaN, kNaN});
    return points;
  }
  /// Writes the same boxes (x, y from the vehicle, length, width) at each instant.
  void writeRun(const std::vector<std::array<double, 4>>& boxes, double z = 0.0) const {
    std::string csv = "stamp_ns,index,x,y,z,yaw,length,width,height,points\n";
    for (const Stamp stamp : stamp_) {
      int index = 0;
      for (const auto& [x, y, length, width] : boxes) {
        char row[300];
        std::snprintf(row, sizeof row, "%lld,%d,%.4f,%.4f,%.4f,0,%.4f,%.4f,1.5,40\n",
                      static_cast<long long>(stamp), index++, here_.x() + x, here_.y() + y, here_.z() + z,
                      length, width);
        csv += row;
      }
    }
    writeText(folders_.out / "obstacles" / "obstacles.csv", csv);
  }
  nlohmann::ordered_json judged(const char* group = "obstacles") const {
    Evaluation evaluation;
    evaluateObstacles(folders_, {}, evaluation);
    return evaluation.toJson()[group];
  }

  Eigen::Vector3d here_;
  std::array<Stamp, kInstants> stamp_{};
};

TEST_F(ObstaclesTest, TrueBoxesAreAllRight) {
  writeRun({{10.0, 0.0, 4.0, 2.0}, {0.0, 8.0, 0.5, 0.5}, {-10.0, 0.0, 0.2, 4.0}});
  const auto result = judged();
  EXPECT_EQ(result["instants"], kInstants);
  EXPECT_EQ(result["objects_found_percent"], 100.0);
  EXPECT_EQ(result["precision_percent"], 100.0);
  EXPECT_EQ(result["boxes_on_objects"], 2 * kInstants);
  EXPECT_EQ(result["boxes_on_structures"], kInstants);
  EXPECT_GT(result["overlap_from_above_median"], 0.99);
}

TEST_F(ObstaclesTest, WhatIsWrongHasAName) {
  // half of the car, the other half, something of nothing; nobody saw the person
  writeRun({{9.0, 0.0, 2.0, 2.0}, {11.0, 0.0, 1.5, 2.0}, {5.0, 5.0, 1.0, 1.0}});
  auto result = judged();
  EXPECT_EQ(result["objects_found_percent"], 50.0) << "one half holds half of the returns";
  EXPECT_EQ(result["objects_found_person_percent"], 0.0);
  EXPECT_EQ(result["boxes_that_are_fragments"], kInstants);
  EXPECT_EQ(result["boxes_of_nothing"], kInstants);
  EXPECT_NEAR(result["precision_percent"], 100.0 / 3.0, 1e-9);
  EXPECT_NEAR(result["overlap_from_above_median"], 0.5, 0.01);

  writeRun({{5.0, 4.0, 30.0, 20.0}});  // one box over everything
  result = judged();
  EXPECT_EQ(result["boxes_that_mix_things"], kInstants);
  EXPECT_EQ(result["objects_found_percent"], 0.0);
  EXPECT_EQ(result["precision_percent"], 0.0);

  writeRun({{-6.0, 0.0, 0.5, 4.0}}, -5.0);
  EXPECT_EQ(judged()["boxes_on_the_ground"], kInstants);
}

TEST_F(ObstaclesTest, AnInstantWithoutBoxesIsAMiss) {
  writeRun({{10.0, 0.0, 4.0, 2.0}, {0.0, 8.0, 0.5, 0.5}});
  const auto csv = folders_.out / "obstacles" / "obstacles.csv";
  std::ifstream file(csv);
  std::string kept;
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(std::to_string(stamp_[1]), 0) != 0) kept += line + "\n";
  }
  file.close();
  writeText(csv, kept + "7,broken\n");
  Evaluation evaluation;
  evaluateObstacles(folders_, {}, evaluation);
  EXPECT_NEAR(evaluation.toJson()["obstacles"]["objects_found_percent"], 200.0 / 3.0, 1e-9);
  EXPECT_TRUE(isSkipped(evaluation, "broken row"));
}

TEST_F(ObstaclesTest, TheErrorOfThePoseCanBeTakenOut) {
  // The run thinks that it is 3 m further east and a quarter further left: so are its boxes.
  const Pose T_wrong{fromRollPitchYaw({0, 0, M_PI / 2}), Eigen::Vector3d(3.0, 0.0, 0.0)};
  std::vector<StampedPose> wrong = readTrajectory(folders_.truth / "trajectory.tum");
  for (StampedPose& pose : wrong) pose.pose = T_wrong * pose.pose;
  EvaluateTest::writeRun(wrong, anchorText(DriveOptions().anchor));
  std::string csv = "stamp_ns,index,x,y,z,yaw,length,width,height,points\n";
  for (const Stamp stamp : stamp_) {
    int index = 0;
    for (const auto& [x, y, length, width] :
         {std::array{10.0, 0.0, 4.0, 2.0}, std::array{0.0, 8.0, 0.5, 0.5}}) {
      const Eigen::Vector3d center = T_wrong * (here_ + Eigen::Vector3d(x, y, 0.0));
      char row[300];
      std::snprintf(row, sizeof row, "%lld,%d,%.6f,%.6f,%.6f,%.9f,%.4f,%.4f,1.5,40\n",
                    static_cast<long long>(stamp), index++, center.x(), center.y(), center.z(), M_PI / 2,
                    length, width);
      csv += row;
    }
  }
  writeText(folders_.out / "obstacles" / "obstacles.csv", csv);
  EXPECT_EQ(judged()["objects_found_percent"], 0.0);
  const auto as_seen = judged("obstacles_without_pose_error");
  EXPECT_EQ(as_seen["instants"], kInstants);
  EXPECT_EQ(as_seen["objects_found_percent"], 100.0);
  EXPECT_GT(as_seen["overlap_from_above_median"], 0.99);
}

TEST_F(ObstaclesTest, WithoutDataThereIsAReason) {
  Evaluation evaluation;
  evaluateObstacles(folders_, {}, evaluation);
  EXPECT_TRUE(isSkipped(evaluation, "no obstacles/obstacles.csv"));
  writeRun({{10.0, 0.0, 4.0, 2.0}});
  std::filesystem::remove_all(folders_.truth / "points" / "lidar_left");
  evaluateObstacles(folders_, {}, evaluation);
  EXPECT_TRUE(isSkipped(evaluation, "no instant with truth"));
}

}  // namespace
}  // namespace atlas::synthetic
