// SPDX-License-Identifier: MIT
// Colours of out/map/map.pcd against those of the surfaces themselves. Each frame of an RGB camera that has a
// true depth picture is drawn again without the losses of a video, and what stands still in it is looked up
// in the map. A voxel is 20 cm wide and holds what was seen from many distances, through more or less haze.
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "atlas/lidar/voxel.hpp"
#include "atlas/output/pcd.hpp"
#include "synthetic/camera_view.hpp"
#include "synthetic/evaluate.hpp"
#include "synthetic/record_files.hpp"
#include "synthetic/shading.hpp"
#include "synthetic/world.hpp"

namespace atlas::synthetic {
namespace {

namespace fs = std::filesystem;

constexpr float kFarthest_m = 30.0F;
constexpr std::size_t kPixelStep = 7;  // no divisor of the width: over all columns and rows

using Levels = std::array<double, 3>;  ///< red, green, blue: 0..255

double differenceOf(const Levels& a, const Levels& b) {
  return (std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2])) / 3.0;
}

/// The points of a map with colours, found by their voxel.
class ColouredMap {
 public:
  explicit ColouredMap(const fs::path& folder) {
    std::ifstream file(folder / "map.pcd", std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    const std::string fields = "FIELDS x y z intensity count rgb\n", end = "DATA binary\n";
    const std::size_t header = bytes.find(end);
    std::ifstream index_file(folder / "tiles.json");
    const auto json = nlohmann::json::parse(index_file, nullptr, false);
    if (header == std::string::npos || bytes.find(fields) > header || !json.contains("voxel_m")) return;
    voxel_m_ = json["voxel_m"].get<double>();
    const std::size_t begin = header + end.size(), count = (bytes.size() - begin) / sizeof(MapPoint);
    for (std::size_t i = 0; i < count; ++i) {
      MapPoint point;
      std::memcpy(&point, &bytes[begin + i * sizeof point], sizeof point);
      const auto voxel = voxelOf(point.x, point.y, point.z, voxel_m_);
      if (voxel && index_.insert(*voxel) == colours_.size()) colours_.push_back(point.colour);
    }
  }
  [[nodiscard]] bool empty() const { return colours_.empty(); }
  /// Nothing where the map has no point; 0 where it has no colour.
  [[nodiscard]] std::optional<std::uint32_t> at(const Eigen::Vector3d& p_run) const {
    const auto voxel = voxelOf(p_run.x(), p_run.y(), p_run.z(), voxel_m_);
    const std::uint32_t number = voxel ? index_.find(*voxel) : VoxelIndex::kNone;
    if (number == VoxelIndex::kNone) return std::nullopt;
    return colours_[number];
  }

 private:
  double voxel_m_ = 0;
  VoxelIndex index_;
  std::vector<std::uint32_t> colours_;
};

struct ColourErrors {
  std::vector<float> levels;  ///< by pixel, mean of the three colours
  std::vector<Levels> truth;  ///< of the same pixels
  Share known;
  std::uint64_t frames = 0;

  void report(Evaluation& evaluation) {
    const std::string group = "map_colour";
    Levels mean{};
    for (const Levels& colour : truth)
      for (std::size_t k = 0; k < 3; ++k) mean[k] += colour[k] / static_cast<double>(truth.size());
    std::vector<float> grey;  // what one colour for everything would leave
    for (const Levels& colour : truth) grey.push_back(static_cast<float>(differenceOf(colour, mean)));
    evaluation.addCount(group, "frames", frames);
    evaluation.add(group, "known_percent", known.percent());
    evaluation.add(group, "error_levels", statisticsOf(levels));
    evaluation.add(group, "error_of_one_colour_for_all_levels", statisticsOf(grey));
  }
};

void compare(const View& view, const CameraView& camera, const Pose& T_run_city, const ColouredMap& map,
             ColourErrors& errors) {
  const std::vector<std::uint8_t> rgb = paint(view, camera);
  ++errors.frames;
  for (std::size_t pixel = 0; pixel < view.hit.size(); pixel += kPixelStep) {
    const std::int32_t hit = view.hit[pixel];
    if (hit == kHitNothing || view.depth[pixel] > kFarthest_m) continue;
    if (hit >= 0 && view.snapshot.primitives[static_cast<std::size_t>(hit)].object > 0) continue;
    const Eigen::Vector2f tangent = camera.tangent(static_cast<int>(pixel));
    const Eigen::Vector3f p_camera = view.depth[pixel] * Eigen::Vector3f(tangent.x(), tangent.y(), 1.0F);
    const auto colour = map.at(T_run_city * (view.T_city_camera * p_camera.cast<double>()));
    if (!colour) continue;
    errors.known.add(*colour != 0);
    if (*colour == 0) continue;
    const Levels seen{static_cast<double>(*colour >> 16U & 255U), static_cast<double>(*colour >> 8U & 255U),
                      static_cast<double>(*colour & 255U)};
    const Levels truth{static_cast<double>(rgb[3 * pixel]), static_cast<double>(rgb[3 * pixel + 1]),
                       static_cast<double>(rgb[3 * pixel + 2])};
    errors.levels.push_back(static_cast<float>(differenceOf(seen, truth)));
    errors.truth.push_back(truth);
  }
}

std::optional<DriveOptions> optionsOf(const fs::path& meta_json) {
  std::ifstream file(meta_json);
  const auto meta = nlohmann::json::parse(file, nullptr, false);
  DriveOptions options;
  try {
    options.seed = meta.at("seed").get<std::uint64_t>();
    options.duration_s = meta.at("duration_s").get<double>();
    options.skip_s = meta.at("skip_s").get<double>();
    options.stop_at_s = meta.at("stop_at_s").get<double>();
    options.stop_for_s = meta.at("stop_for_s").get<double>();
    options.start = meta.at("start_ns").get<Stamp>();
    options.street_yaw_rad = meta.at("street_yaw_rad").get<double>();
    options.rgb_scale = meta.at("rgb_scale").get<double>();
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
  return options;
}

}  // namespace

void evaluateMapColour(const RunFolders& folders, const Pose& T_truth_run, Evaluation& evaluation) {
  const ColouredMap map(folders.out / "map");
  if (map.empty()) return evaluation.skip("map_colour: no map.pcd with colours");
  const auto options = optionsOf(folders.truth / "meta.json");
  if (!options) return evaluation.skip("map_colour: meta.json does not say how the drive was made");
  const World world(*options);
  const Pose T_run_city = T_truth_run.inverse() * world.T_map_city();
  ColourErrors errors;
  for (const Camera& camera : rigCameras(options->rgb_scale)) {
    if (camera.thermal()) continue;
    const auto frames = numberedFiles(folders.truth / "depth" / camera.name, ".png");
    if (frames.empty()) continue;
    const CameraView viewer(camera);
    const auto stamps = readFrameStamps(folders.record / camera.name / "timestamps.txt");
    for (const auto& [frame, path] : frames) {
      const auto stamp = stamps.find(frame);
      if (stamp == stamps.end()) continue;
      const double t_s = world.routeTime(stamp->second);
      const Pose T_city_camera = world.ego().T_city_imu(t_s) * T_imu_sensor(camera.name);
      compare(viewer.look(world.scene(), T_city_camera, t_s), viewer, T_run_city, map, errors);
    }
  }
  if (errors.frames == 0) return evaluation.skip("map_colour: no frame with truth");
  errors.report(evaluation);
}

}  // namespace atlas::synthetic
