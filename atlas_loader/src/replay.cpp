// SPDX-License-Identifier: MIT
#include "replay.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core/utility.hpp>
#include <set>
#include <stdexcept>

#include "atlas/pipeline.hpp"
#include "atlas_ros/stage_params.hpp"
#include "atlas_ros/yaml_reader.hpp"
#include "feed.hpp"
#include "files/writer_stages.hpp"
#include "progress_bar.hpp"
#include "smooth_run.hpp"
#include "video_decode_stage.hpp"
#include "writer_params.hpp"

namespace atlas_loader {
namespace {

std::atomic<bool> g_interrupted{false};  // set by the signal handler, which can reach nothing else

/// Reads one section of the configuration.
class Configuration {
 public:
  explicit Configuration(const std::string& file) : file_(file), root_(atlas_ros::loadConfiguration(file)) {}
  template <class Params>
  Params section(const std::string& name) {
    read_.insert(name);
    return atlas_ros::readSection<Params>(root_, file_, name);
  }
  /// Sections that nobody reads are typing errors.
  void rejectUnread() const {
    for (const auto& entry : root_) {
      const auto name = entry.first.as<std::string>();
      if (read_.count(name) == 0) throw std::invalid_argument(file_ + ": unknown section " + name);
    }
  }
  [[nodiscard]] std::string json() const { return toTree(root_).dump(); }

 private:
  static nlohmann::json toTree(const YAML::Node& node) {
    if (node.IsMap()) {
      nlohmann::json map = nlohmann::json::object();
      for (const auto& entry : node) map[entry.first.as<std::string>()] = toTree(entry.second);
      return map;
    }
    if (node.IsSequence()) {
      nlohmann::json list = nlohmann::json::array();
      for (const auto& entry : node) list.push_back(toTree(entry));
      return list;
    }
    return node.IsNull() ? nlohmann::json() : nlohmann::json(node.Scalar());
  }
  std::string file_;
  YAML::Node root_;
  std::set<std::string> read_;
};

/// Whether --write asks for a product that not every run has.
bool asksFor(const ReplayOptions& options, const std::string& product) {
  return std::find(options.write.begin(), options.write.end(), product) != options.write.end();
}

void refuseUnknownProducts(const ReplayOptions& options) {
  for (const std::string& product : options.write) {
    if (product != "deskewed" && product != "lines" && product != "map_colour")
      throw std::invalid_argument("--write knows deskewed, lines and map_colour, got '" + product + "'");
  }
}

atlas::WriterParams writerParams(Configuration& configuration, const ReplayOptions& options) {
  atlas::WriterParams writers;
  writers.cloud = configuration.section<atlas::CloudWriterParams>("cloud_writer");
  writers.line = configuration.section<atlas::LineWriterParams>("line_writer");
  writers.map = configuration.section<atlas::MapWriterParams>("map_writer");
  if (asksFor(options, "map_colour")) writers.map.map.colour = true;
  writers.depth = configuration.section<atlas::DepthWriterParams>("depth_writer");
  writers.frustum = configuration.section<atlas::FrustumWriterParams>("frustum_writer");
  writers.thermal = configuration.section<atlas::ThermalWriterParams>("thermal_writer");
  writers.overlay = configuration.section<atlas::OverlayWriterParams>("overlay_writer");
  writers.grid = configuration.section<atlas::GridWriterParams>("grid_writer");
  configuration.section<atlas::TrajectoryWriterParams>("trajectory_writer");
  configuration.section<atlas::ObstacleWriterParams>("obstacle_writer");
  configuration.section<atlas::ObjectWriterParams>("object_writer");
  configuration.section<atlas::StatusWriterParams>("status_writer");
  configuration.section<atlas::TraceWriterParams>("trace_writer");
  writers.write_deskewed = asksFor(options, "deskewed");
  writers.write_lines = asksFor(options, "lines");
  return writers;
}

/// Colours come from depth images and decoded pictures, which not every camera has.
void checkColourCameras(const atlas::MapWriterParams& map, const atlas::DepthParams& depth) {
  if (!map.map.colour) return;
  for (const std::string& camera : map.colour_cameras) {
    if (std::count(depth.cameras.begin(), depth.cameras.end(), camera) == 0)
      throw std::invalid_argument("map_writer: colour_cameras: " + camera + " is not one of depth/cameras");
  }
}

/// The stereo pair's images are decoded, its ground goes into the occupancy grid (config/<rig>_stereo.yaml
/// does the same for the nodelets).
void addStereo(const atlas::StereoStageParams& stereo, VideoDecodeParams& decoder,
               atlas::PipelineParams& params) {
  for (const std::string& camera : {stereo.left_camera, stereo.right_camera}) {
    if (std::count(decoder.cameras.begin(), decoder.cameras.end(), camera) == 0)
      decoder.cameras.push_back(camera);
  }
  params.occupancy.stereo = {stereo.name};
  params.stereo = stereo;
}

/// Adds the stages in order of the data path; the configuration decides all their parameters.
void buildGraph(atlas::LocalGraph& graph, Configuration& configuration, const ReplayOptions& options) {
  auto decoder = configuration.section<VideoDecodeParams>("video_decoder");
  atlas::PipelineParams params;
  params.occupancy = configuration.section<atlas::OccupancyParams>("occupancy");
  const auto stereo = configuration.section<atlas::StereoStageParams>("stereo");
  if (options.stereo) addStereo(stereo, decoder, params);
  graph.beginThread();  // beside reading and unpacking
  graph.add([&](atlas::LocalGraph::Bus& bus) { return bindVideoDecoder(bus, decoder); });
  params.monitor = configuration.section<atlas::MonitorParams>("sensor_monitor");
  params.localization = configuration.section<atlas::LocalizationParams>("localization");
  if (options.smooth)
    params.localization.smoothed = smoothRun(options.input, params.localization, options.out);
  params.deskew = configuration.section<atlas::DeskewParams>("deskew");
  params.aggregate = configuration.section<atlas::AggregateParams>("aggregate");
  params.obstacles = configuration.section<atlas::ObstacleParams>("obstacles");
  const auto lines = configuration.section<atlas::LineParams>("lines");
  if (asksFor(options, "lines")) params.lines = lines;
  params.camera_lidar = configuration.section<atlas::CameraLidarParams>("camera_lidar");
  params.objects = configuration.section<atlas::ObjectParams>("objects");
  params.local_map = configuration.section<atlas::LocalMapParams>("local_map");
  params.thermal = configuration.section<atlas::ThermalParams>("thermal");
  params.depth = configuration.section<atlas::DepthParams>("depth");
  addPipeline(graph, params);
  const atlas::WriterParams writers = writerParams(configuration, options);
  checkColourCameras(writers.map, params.depth);
  configuration.rejectUnread();
  atlas::addWriters(graph, writers, options.out);
}

}  // namespace

atlas::RunSummary replay(const ReplayOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  refuseUnknownProducts(options);
  const auto reader = openInput(options.input);
  const std::string config =
      !options.config.empty()
          ? options.config
          : packageFile("atlas_bringup", "config/" + configurationFor(reader->streams()) + ".yaml");
  Configuration configuration(config);
  std::filesystem::create_directories(options.out);
  cv::setNumThreads(1);  // the stages share the cores, OpenCV's own threads would only be in their way
  using Threads = atlas::LocalGraph::Threads;
  atlas::LocalGraph graph(options.one_thread ? Threads::kOne : Threads::kSeveral);
  buildGraph(graph, configuration, options);

  atlas::RunSummary summary;
  summary.mode = "offline";
  summary.configuration = configuration.json();
  summary.inputs.push_back(
      atlas::hashInput(options.input.bag.empty() ? options.input.record : options.input.bag));
  std::signal(SIGINT, [](int) { g_interrupted = true; });
  std::signal(SIGTERM, [](int) { g_interrupted = true; });
  ProgressBar bar("replaying", requestedSpan(reader->span(), options.input));
  constexpr atlas::Duration kAdvanceStep = 5 * atlas::kMillisecond;  // of event time; no influence on results
  atlas::Stamp advanced = atlas::kBeginOfTime, first = 0, last = 0;
  while (!g_interrupted) {
    const auto event = reader->next();
    if (!event) break;
    if (first == 0) first = event->stamp;
    last = event->stamp;
    const atlas::StreamInfo& stream = reader->streams()[event->stream];
    feed(graph, stream, *event);
    ++summary.streams[stream.topic];
    if (event->stream != 0 &&
        (advanced == atlas::kBeginOfTime || event->stamp - 1 >= advanced + kAdvanceStep)) {
      advanced = event->stamp - 1;
      graph.advance(advanced);
    }
    bar.show(event->stamp);
  }
  graph.finish();
  summary.complete = !g_interrupted;
  if (g_interrupted) summary.failure = "interrupted";
  for (const atlas::Stage* stage : graph.stages()) {
    auto& counters = summary.stages[stage->name()];
    counters = stage->counters().all();
    for (std::size_t i = 0; i < stage->inputs(); ++i) {
      counters["received " + stage->inputName(i)] = stage->merge().received(i);
      counters["late " + stage->inputName(i)] = stage->merge().late(i);
    }
  }
  summary.files = reader->report();
  summary.notes = reader->notes();
  summary.data_s = atlas::toSeconds(last - first);
  summary.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  atlas::measureProcess(summary);
  atlas::writeRunSummary(options.out, summary);
  return summary;
}

}  // namespace atlas_loader
