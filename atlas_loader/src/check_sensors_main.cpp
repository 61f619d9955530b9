// SPDX-License-Identifier: MIT
// check_sensors (--record DIR | --bag F): runs the sensor monitor alone over a recording and prints, for each
// sensor, its mean score and what was wrong, when and how often. Exit status 0: nothing, 1: anomalies, 2:
// failed.
#include <cstdio>
#include <map>

#include "input_arguments.hpp"
#include "sensor_check.hpp"

namespace {

void print(const atlas_loader::SensorCheck& check) {
  std::printf("%.1f s of data\n%-22s %6s %6s  %s\n", check.data_s, "sensor", "mean", "least", "anomalies");
  for (const auto& [name, sensor] : check.sensors) {
    std::printf("%-22s %6.3f %6.3f ", name.c_str(), sensor.mean_score, sensor.least_score);
    const char* between = " ";
    for (const auto& [anomaly, seen] : sensor.anomalies) {
      std::printf("%s%s x%d (first at %.1f s, %.1f s in all, %.3f %s)", between, anomaly.c_str(), seen.times,
                  seen.first_s, seen.lasted_s, seen.worst, seen.unit.c_str());
      between = ", ";
    }
    std::printf("\n");
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Runs the sensor monitor over a recording: scores and anomalies of every sensor.");
  atlas_loader::SensorCheckOptions options;
  auto* bag = app.add_option("--bag", options.input.bag, "bag to look at");
  app.add_option("--record", options.input.record, "record to look at (folder)")->excludes(bag);
  app.add_option("--config", options.config, "YAML file; default: that of the record's rig");
  app.add_option("--out", options.out, "folder: also write OUT/sensors/status.csv");
  app.add_flag("--list", options.list, "print the table of all anomalies and end");
  atlas_loader::addRecordArguments(app, options.input);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (options.list) {
      std::printf("%s", atlas::anomalyTable().c_str());
      return 0;
    }
    const atlas_loader::SensorCheck check = atlas_loader::checkSensors(options);
    print(check);
    return check.clean() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "check_sensors: %s\n", error.what());
    return 2;
  }
}
