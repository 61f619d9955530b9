// SPDX-License-Identifier: MIT
// A map that is painted with what the camera sees has no error; other colours and none are told.
#include <cmath>
#include <set>

#include "atlas/lidar/voxel.hpp"
#include "atlas/output/pcd.hpp"
#include "evaluate_fixture.hpp"
#include "synthetic/camera_view.hpp"
#include "synthetic/shading.hpp"

namespace atlas::synthetic {
namespace {

constexpr double kVoxel_m = 0.02;  // smaller than what one pixel sees: no voxel has two colours

class MapColourTest : public EvaluateTest {
 protected:
  void SetUp() override {
    EvaluateTest::SetUp();
    options_.duration_s = 2.0;
    options_.rgb_scale = 0.1;
    const World world(options_);
    writeTruth(world, folders_.truth);
    writeText(folders_.truth / "depth" / "camera_left_front" / "000003.png", "");
    writeText(folders_.record / "camera_left_front" / "timestamps.txt", std::to_string(stamp()) + ",3, 0\n");
    writeText(folders_.out / "map" / "tiles.json", "{\"voxel_m\": " + std::to_string(kVoxel_m) + "}");
    paintMap(world);
  }
  [[nodiscard]] Stamp stamp() const { return options_.start + kSecond; }
  void paintMap(const World& world) {
    const Camera camera = rigCameras(options_.rgb_scale).front();
    ASSERT_EQ(camera.name, "camera_left_front");
    const CameraView viewer(camera);
    const double t_s = world.routeTime(stamp());
    const View view =
        viewer.look(world.scene(), world.ego().T_city_imu(t_s) * T_imu_sensor(camera.name), t_s);
    const auto rgb = paint(view, viewer);
    for (std::size_t i = 0; i < view.hit.size(); ++i) {
      if (view.hit[i] == kHitNothing || view.depth[i] > 40.0F) continue;
      const Eigen::Vector2f tangent = viewer.tangent(static_cast<int>(i));
      const Eigen::Vector3f p_camera = view.depth[i] * Eigen::Vector3f(tangent.x(), tangent.y(), 1.0F);
      const Eigen::Vector3d p = world.T_map_city() * (view.T_city_camera * p_camera.cast<double>());
      const std::uint32_t colour = 0xFF000000U | static_cast<std::uint32_t>(rgb[3 * i]) << 16U |
                                   static_cast<std::uint32_t>(rgb[3 * i + 1]) << 8U | rgb[3 * i + 2];
      points_.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()), 0, 1, colour});
    }
  }
  [[nodiscard]] nlohmann::ordered_json judged(bool coloured = true) {
    writeText(folders_.out / "map" / "map.pcd",
              mapPcdHeader(points_.size(), coloured) + mapRecords(points_, coloured));
    evaluation_ = Evaluation();
    evaluateMapColour(folders_, {}, evaluation_);
    return evaluation_.toJson()["map_colour"];
  }

  DriveOptions options_;
  std::vector<MapPoint> points_;
  Evaluation evaluation_;
};

TEST_F(MapColourTest, TrueColoursHaveNoError) {
  const auto result = judged();
  EXPECT_EQ(result["frames"], 1);
  EXPECT_EQ(result["known_percent"], 100.0);
  EXPECT_GT(result["error_levels"]["count"], 500);
  EXPECT_LT(result["error_levels"]["p95"], 1.0);
  EXPECT_GT(result["error_of_one_colour_for_all_levels"]["median"], 5.0);
}

TEST_F(MapColourTest, OtherColoursAndNoneAreTold) {
  for (MapPoint& point : points_) point.colour ^= 0x00400000U;  // 64 levels of red
  EXPECT_NEAR(judged()["error_levels"]["median"].get<double>(), 64.0 / 3.0, 0.01) << "one colour of three";
  for (std::size_t i = 0; i < points_.size(); i += 2) points_[i].colour = 0;
  EXPECT_NEAR(judged()["known_percent"].get<double>(), 50.0, 15.0);
}

TEST_F(MapColourTest, AMapWithoutColoursIsNotCompared) {
  EXPECT_TRUE(judged(false).is_null());
  EXPECT_TRUE(isSkipped(evaluation_, "no map.pcd with colours"));
}

}  // namespace
}  // namespace atlas::synthetic
