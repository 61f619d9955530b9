// SPDX-License-Identifier: MIT
#include "smooth_run.hpp"

#include <filesystem>
#include <stdexcept>

#include "atlas/localization/eskf_history.hpp"
#include "atlas/output/trajectory_text.hpp"
#include "atlas/pipeline.hpp"
#include "atlas_ros/stage_params.hpp"
#include "atlas_ros/yaml_reader.hpp"
#include "files/output_file.hpp"
#include "progress_bar.hpp"

namespace atlas_loader {

std::shared_ptr<const atlas::eskf::History> smoothRun(const InputOptions& input,
                                                      const atlas::LocalizationParams& params,
                                                      const std::string& out) {
  const auto history = std::make_shared<atlas::eskf::History>(atlas::SpillParams{out});
  atlas::LocalGraph graph;
  graph.add([&](atlas::LocalGraph::Bus& bus) -> atlas::StageFactory {
    const atlas::StageFactory factory = bindLocalization(bus, params);
    return [factory, history] {
      auto stage = factory();
      static_cast<atlas::LocalizationStage&>(*stage).record(history.get());
      return stage;
    };
  });
  const auto reader = openInput(input);
  ProgressBar bar("positioning", requestedSpan(reader->span(), input));
  while (const auto event = reader->next()) {
    const atlas::StreamInfo& stream = reader->streams()[event->stream];
    if (!graph.wants(stream.topic)) continue;
    std::visit([&](const auto& value) { graph.publish(stream.topic, value); }, event->payload);
    if (event->stream != 0) graph.advance(event->stamp - 1);
    bar.show(event->stamp);
  }
  graph.finish();
  if (history->size() == 0) throw std::runtime_error("no pose to smooth: position or heading never known");
  history->smooth();
  atlas::OutputFile file(std::filesystem::path(out) / "trajectory" / "smoothed.tum");
  for (std::size_t i = 0; i < history->size(); ++i) file.write(tumLine(history->odometry(i)));
  file.commit();
  return history;
}

atlas::LocalizationParams localizationParams(const std::string& config, const InputOptions& input) {
  const std::string file =
      !config.empty()
          ? config
          : packageFile("atlas_bringup", "config/" + configurationFor(openInput(input)->streams()) + ".yaml");
  return atlas_ros::readSection<atlas::LocalizationParams>(atlas_ros::loadConfiguration(file), file,
                                                           "localization");
}

}  // namespace atlas_loader
