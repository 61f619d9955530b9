// SPDX-License-Identifier: MIT
// track_drive --record DIR --out OUT: the objects of a recording, by lidar only, lidar and camera, and all
// sensors, in one pass over it. The stages and their configuration are those of atlas_replay; only what the
// objects need is run. Writes OUT/<sensors>/objects and OUT/<sensors>/trajectory for evaluate_run.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "atlas/pipeline.hpp"
#include "atlas_ros/stage_params.hpp"
#include "atlas_ros/yaml_reader.hpp"
#include "feed.hpp"
#include "files/writer_stages.hpp"
#include "input_arguments.hpp"

namespace {

using namespace atlas;

/// A bus whose outputs, and the input `objects`, carry a prefix: the same stage several times in one graph.
class PrefixedBus {
 public:
  PrefixedBus(LocalGraph::Bus& bus, std::string prefix) : bus_(bus), prefix_(std::move(prefix)) {}
  template <class StageType, class T>
  void input(std::size_t index, const std::string& topic, std::function<void(StageType&, const T&)> push) {
    bus_.template input<StageType, T>(index, topic == "objects" ? prefix_ + topic : topic, std::move(push));
  }
  template <class T>
  std::function<void(const T&)> output(const std::string& topic) {
    return bus_.template output<T>(prefix_ + topic);
  }

 private:
  LocalGraph::Bus& bus_;
  std::string prefix_;
};

struct Arguments {
  atlas_loader::InputOptions input;
  std::string out, config;
};

void addObjects(LocalGraph& graph, const std::string& sensors, const ObjectParams& params,
                const std::string& out) {
  using Bus = LocalGraph::Bus;
  const std::string folder = (std::filesystem::path(out) / sensors).string();
  std::filesystem::create_directories(folder);
  graph.add([&](Bus& bus) {
    PrefixedBus prefixed(bus, sensors + "/");
    return bindObjects(prefixed, params);
  });
  graph.add([&](Bus& bus) {
    PrefixedBus prefixed(bus, sensors + "/");
    return bindObjectWriter(prefixed, folder);
  });
  graph.add([&](Bus& bus) { return bindTrajectoryWriter(bus, folder); });
}

void addStages(LocalGraph& graph, const std::string& file, const std::string& out) {
  using Bus = LocalGraph::Bus;
  const YAML::Node root = atlas_ros::loadConfiguration(file);
  const auto localization = atlas_ros::readSection<LocalizationParams>(root, file, "localization");
  const auto deskew = atlas_ros::readSection<DeskewParams>(root, file, "deskew");
  const auto obstacles = atlas_ros::readSection<ObstacleParams>(root, file, "obstacles");
  const auto camera_lidar = atlas_ros::readSection<CameraLidarParams>(root, file, "camera_lidar");
  const auto all = atlas_ros::readSection<ObjectParams>(root, file, "objects");
  const auto monitor = atlas_ros::readSection<MonitorParams>(root, file, "sensor_monitor");
  graph.add([&](Bus& bus) { return bindMonitor(bus, monitor); });
  graph.add([&](Bus& bus) { return bindLocalization(bus, localization); });
  graph.add([&](Bus& bus) { return bindDeskew(bus, deskew); });
  graph.add([&](Bus& bus) { return bindObstacles(bus, obstacles); });
  graph.add([&](Bus& bus) { return bindCameraLidar(bus, camera_lidar); });
  ObjectParams lidar_camera = all, lidar = all;
  lidar_camera.radars.clear();
  lidar.radars.clear();
  lidar.use_frustums = false;
  addObjects(graph, "lidar", lidar, out);
  addObjects(graph, "lidar_camera", lidar_camera, out);
  addObjects(graph, "all", all, out);
}

void run(const Arguments& arguments) {
  const auto reader = atlas_loader::openInput(arguments.input);
  const std::string config =
      !arguments.config.empty()
          ? arguments.config
          : atlas_loader::packageFile(
                "atlas_bringup", "config/" + atlas_loader::configurationFor(reader->streams()) + ".yaml");
  LocalGraph graph;
  addStages(graph, config, arguments.out);
  while (const auto event = reader->next()) {
    const StreamInfo& stream = reader->streams()[event->stream];
    if (!graph.wants(stream.topic)) continue;
    atlas_loader::feed(graph, stream, *event);
    if (event->stream != 0) graph.advance(event->stamp - 1);
  }
  graph.finish();
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Objects of a recording by lidar only, lidar and camera, and all sensors");
  Arguments arguments;
  app.add_option("--record", arguments.input.record, "folder of a record")->required();
  app.add_option("--out", arguments.out, "output folder: OUT/lidar, OUT/lidar_camera, OUT/all")->required();
  app.add_option("--config", arguments.config, "parameters of all stages (default: the packaged ones)");
  atlas_loader::addRecordArguments(app, arguments.input);
  CLI11_PARSE(app, argc, argv);
  try {
    run(arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "track_drive: %s\n", error.what());
    return 1;
  }
  return 0;
}
