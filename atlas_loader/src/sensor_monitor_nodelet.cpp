// SPDX-License-Identifier: MIT
// Nodelet: how far each sensor can be believed, on sensor_status and, with event time, on /diagnostics.
#include <diagnostic_msgs/DiagnosticArray.h>

#include <pluginlib/class_list_macros.hpp>

#include "atlas_ros/stage_nodelet.hpp"

namespace atlas_loader {
namespace {

constexpr double kWarnBelow = 1.0, kErrorBelow = 0.5;  // score

diagnostic_msgs::DiagnosticArray diagnosticsOf(const atlas::SensorStatus& status) {
  diagnostic_msgs::DiagnosticStatus sensor;
  sensor.name = "sensor " + status.sensor;
  sensor.hardware_id = status.sensor;
  sensor.level = diagnostic_msgs::DiagnosticStatus::OK;
  if (status.score < kWarnBelow) sensor.level = diagnostic_msgs::DiagnosticStatus::WARN;
  if (status.score < kErrorBelow) sensor.level = diagnostic_msgs::DiagnosticStatus::ERROR;
  const auto add = [&sensor](const std::string& key, const std::string& value) {
    diagnostic_msgs::KeyValue pair;
    pair.key = key;
    pair.value = value;
    sensor.values.push_back(pair);
  };
  add("score", std::to_string(status.score));
  for (const atlas::SensorAnomaly& anomaly : status.anomalies) {
    sensor.message += (sensor.message.empty() ? "" : ", ") + anomaly.name;
    add(anomaly.name, std::to_string(anomaly.value) + " " + anomaly.unit + ", threshold " +
                          std::to_string(anomaly.threshold));
  }
  if (sensor.message.empty()) sensor.message = "no anomaly";
  diagnostic_msgs::DiagnosticArray array;
  array.header.stamp = atlas_ros::toTime(status.stamp);
  array.status.push_back(sensor);
  return array;
}

}  // namespace

class SensorMonitorNodelet : public atlas_ros::StageNodelet<atlas::MonitorParams> {
  atlas::StageFactory bind(atlas_ros::StageLink& link, const atlas::MonitorParams& params) override {
    const atlas::StageFactory factory = atlas::bindMonitor(link, params);
    diagnostics_ =
        getNodeHandle().advertise<diagnostic_msgs::DiagnosticArray>("/diagnostics", atlas_ros::kKeepAll);
    return [this, factory] {
      auto stage = factory();
      auto& monitor = static_cast<atlas::MonitorStage&>(*stage);
      monitor.on_status = [this, emit = monitor.on_status](const atlas::SensorStatus& status) {
        diagnostics_.publish(diagnosticsOf(status));
        emit(status);
      };
      return stage;
    };
  }

  ros::Publisher diagnostics_;
};

}  // namespace atlas_loader

PLUGINLIB_EXPORT_CLASS(atlas_loader::SensorMonitorNodelet, nodelet::Nodelet)
