// SPDX-License-Identifier: MIT
#include "sensor_check.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "atlas/pipeline.hpp"
#include "atlas_ros/stage_params.hpp"
#include "atlas_ros/yaml_reader.hpp"
#include "feed.hpp"
#include "files/status_writer.hpp"
#include "files/writer_stages.hpp"
#include "progress_bar.hpp"
#include "video_decode_stage.hpp"

namespace atlas_loader {

bool SensorCheck::clean() const {
  return std::all_of(sensors.begin(), sensors.end(),
                     [](const auto& entry) { return entry.second.anomalies.empty(); });
}

void SensorCheckSummary::hold(Collected& sensor, atlas::Stamp until) {
  const double span_s = atlas::toSeconds(until - sensor.newest.stamp);
  sensor.score_time += span_s * sensor.newest.score;
  for (const atlas::SensorAnomaly& a : sensor.newest.anomalies)
    sensor.checked.anomalies[a.name].lasted_s += span_s;
}

void SensorCheckSummary::add(const atlas::SensorStatus& status) {
  if (first_ == 0) first_ = status.stamp;
  last_ = status.stamp;
  const bool is_new = sensors_.count(status.sensor) == 0;
  Collected& sensor = sensors_[status.sensor];
  if (is_new) {
    sensor.begin = status.stamp;
    sensor.checked.least_score = status.score;
  } else {
    hold(sensor, status.stamp);
  }
  for (const atlas::SensorAnomaly& a : status.anomalies) {
    SeenAnomaly& seen = sensor.checked.anomalies[a.name];
    const auto& before = sensor.newest.anomalies;
    const bool goes_on = !is_new && std::any_of(before.begin(), before.end(), [&](const auto& b) {
      return b.name == a.name && b.since == a.since;
    });
    if (seen.times == 0) {
      seen.first_s = atlas::toSeconds(a.since - first_);
      seen.worst = a.value;
      seen.unit = a.unit;
    }
    if (!goes_on) ++seen.times;
    if (std::abs(a.value - a.threshold) > std::abs(seen.worst - a.threshold)) seen.worst = a.value;
  }
  sensor.checked.least_score = std::min(sensor.checked.least_score, status.score);
  sensor.newest = status;
}

SensorCheck SensorCheckSummary::result() const {
  SensorCheck result;
  result.data_s = atlas::toSeconds(last_ - first_);
  for (const auto& [name, collected] : sensors_) {
    Collected sensor = collected;
    hold(sensor, last_);
    const double span_s = atlas::toSeconds(last_ - sensor.begin);
    sensor.checked.mean_score = span_s > 0 ? sensor.score_time / span_s : sensor.newest.score;
    result.sensors[name] = sensor.checked;
  }
  return result;
}

SensorCheck checkSensors(const SensorCheckOptions& options) {
  const auto reader = openInput(options.input);
  const std::string file =
      !options.config.empty()
          ? options.config
          : packageFile("atlas_bringup", "config/" + configurationFor(reader->streams()) + ".yaml");
  const YAML::Node root = atlas_ros::loadConfiguration(file);
  const auto decoder = atlas_ros::readSection<VideoDecodeParams>(root, file, "video_decoder");
  const auto monitor = atlas_ros::readSection<atlas::MonitorParams>(root, file, "sensor_monitor");
  SensorCheckSummary summary;
  atlas::LocalGraph graph;
  using Bus = atlas::LocalGraph::Bus;
  graph.add([&](Bus& bus) { return bindVideoDecoder(bus, decoder); });
  graph.add([&](Bus& bus) -> atlas::StageFactory {
    const atlas::StageFactory factory = atlas::bindMonitor(bus, monitor);
    return [factory, &summary] {
      auto stage = factory();
      auto& on_status = static_cast<atlas::MonitorStage&>(*stage).on_status;
      on_status = [&summary, emit = on_status](const atlas::SensorStatus& status) {
        summary.add(status);
        emit(status);
      };
      return stage;
    };
  });
  if (!options.out.empty()) graph.add([&](Bus& bus) { return atlas::bindStatusWriter(bus, options.out); });
  ProgressBar bar("checking", requestedSpan(reader->span(), options.input));
  while (const auto event = reader->next()) {
    feed(graph, reader->streams()[event->stream], *event);
    if (event->stream != 0) graph.advance(event->stamp - 1);
    bar.show(event->stamp);
  }
  graph.finish();
  return summary.result();
}

}  // namespace atlas_loader
