// SPDX-License-Identifier: MIT
#include "atlas/monitor/monitor_stage.hpp"

#include <algorithm>
#include <stdexcept>

namespace atlas {
namespace {

constexpr Duration kTick = 100 * kMillisecond;  // silence is noticed so soon
/// Silence of everything is told when the inputs are known for so long: less than a source may be ahead,
/// which would else wait for this stage while this stage waits for its next message; more than the ends of
/// streams lie apart.
constexpr Duration kSilence = 500 * kMillisecond;

std::vector<std::string> inputNames(const MonitorParams& p) {
  validate(p);
  std::vector<std::string> names = {"tf_static",    "imu/data",     "imu/mag",  "imu/pressure", "gnss/fix",
                                    "gnss/heading", "imu/gnss/fix", "imu/time", "gnss/time"};
  const auto add = [&names](const std::vector<std::string>& sensors, const char* suffix) {
    for (const std::string& sensor : sensors) names.push_back(sensor + suffix);
  };
  add(p.lidars, "/points");
  add(p.lidars, "/time");
  add(p.cameras, "/camera_info");
  add(p.cameras, "/image");
  add(p.thermal_cameras, "/temperature_range");
  add(p.radars, "/scan");
  return names;
}

std::vector<std::string> sensorNames(const MonitorParams& p) {
  std::vector<std::string> names = {"imu", "imu_mag", "imu_pressure", "gnss", "imu_gnss"};
  for (const auto* list : {&p.lidars, &p.cameras, &p.radars})
    names.insert(names.end(), list->begin(), list->end());
  return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

void validate(const MonitorParams& p) {
  for (const std::string& name : p.required) {
    if (!contains(sensorNames(p), name))
      throw std::invalid_argument("sensor_monitor: required names an unknown sensor, got '" + name + "'");
  }
  for (const std::string& name : p.thermal_cameras) {
    if (!contains(p.cameras, name))
      throw std::invalid_argument("sensor_monitor: thermal_cameras must be among cameras, got '" + name +
                                  "'");
  }
  if (!(p.status_period_s >= toSeconds(kTick)))
    throw std::invalid_argument("sensor_monitor: status_period_s must be at least 0.1, got " +
                                std::to_string(p.status_period_s));
  for (std::size_t i = 0; i < kAnomalies; ++i) {
    const auto anomaly = static_cast<Anomaly>(i);
    if (p.thresholds[anomaly] >= 0.0) continue;
    throw std::invalid_argument("sensor_monitor: " + std::string(infoOf(anomaly).parameter) +
                                " must be >= 0, got " + std::to_string(p.thresholds[anomaly]));
  }
}

MonitorStage::Inputs::Inputs(const MonitorParams& p)
    : points(kFirstLidar),
      times(points + p.lidars.size()),
      infos(times + p.lidars.size()),
      images(infos + p.cameras.size()),
      ranges(images + p.cameras.size()),
      scans(ranges + p.thermal_cameras.size()) {}

MonitorStage::Sensor::Sensor(std::string sensor, const MonitorParams& params)
    : name(std::move(sensor)), required(contains(params.required, name)), findings(params.thresholds) {}

MonitorStage::MonitorStage(const MonitorParams& params)
    : Stage("sensor_monitor", inputNames(params)),
      params_(params),
      first_(params),
      arrivals_(inputs()),
      imu_(params.thresholds),
      lidars_(params.lidars.size(), LidarCheck(params.dead_rings)),
      cameras_(params.cameras.size()),
      radars_(params.radars.size()) {
  for (std::string& name : sensorNames(params)) sensors_.emplace_back(std::move(name), params);
  for (const std::string& name : params.thermal_cameras) {
    const auto at = std::find(params.cameras.begin(), params.cameras.end(), name);
    thermal_.push_back(static_cast<std::size_t>(at - params.cameras.begin()));
  }
}

void MonitorStage::push(Stamp stamp, const StaticTransforms& transforms) {
  enqueue(kTfStatic, stamp, [this, transforms] { rig_.add(transforms); });
}
void MonitorStage::push(const ImuSample& sample) {
  watch(kImu, sample.stamp, kImuSensor, true,
        [this, sample](Findings& findings) { imu_.add(sample, standing(sample.stamp), findings); });
}
void MonitorStage::push(const MagneticSample& sample) {
  watch(kMagnetic, sample.stamp, kMagneticSensor, true,
        [this, sample](Findings& findings) { magnetic_.add(sample, findings); });
}
void MonitorStage::push(const ScalarSample& pressure) {
  watch(kPressure, pressure.stamp, kPressureSensor, true,
        [this, pressure](Findings& findings) { pressure_.add(pressure, findings); });
}
void MonitorStage::push(const GnssFix& fix) {
  watch(kFix, fix.stamp, kGnss, true, [this, fix](Findings& findings) { gnss_.add(fix, findings); });
}
void MonitorStage::push(const GnssHeading& heading) {
  watch(kHeading, heading.stamp, kGnss, false,
        [this, heading](Findings& findings) { gnss_.add(heading, findings); });
}
void MonitorStage::pushSecond(const GnssFix& fix) {
  watch(kSecondFix, fix.stamp, kSecondGnss, true,
        [this, fix](Findings& findings) { second_gnss_.add(fix, findings); });
}
void MonitorStage::pushTime(std::size_t input, const TimeReference& reference) {
  std::size_t sensor = input == kImuTime ? kImuSensor : kGnss;
  if (input >= first_.times) sensor = lidarSensor(input - first_.times);
  watch(input, reference.stamp, sensor, false,
        [this, sensor, reference](Findings& findings) { clocks_[sensor].add(reference, findings); });
}
void MonitorStage::push(std::size_t lidar, const SweepPtr& sweep) {
  watch(first_.points + lidar, sweep->stamp, lidarSensor(lidar), true,
        [this, lidar, sweep](Findings&) { lookAt(lidar, *sweep); });
}
void MonitorStage::push(std::size_t camera, const CameraInfo& info) {
  watch(first_.infos + camera, info.stamp, cameraSensor(camera), true, [](Findings&) {});
}
void MonitorStage::push(std::size_t camera, const ImagePtr& image) {
  watch(first_.images + camera, image->stamp, cameraSensor(camera), false,
        [this, camera, image](Findings& findings) {
          cameras_[camera].add(*image, gnss_.motion(), findings);
          counters_.add("pictures");
        });
}
void MonitorStage::push(std::size_t thermal_camera, const TemperatureRange& range) {
  const std::size_t camera = thermal_.at(thermal_camera);
  watch(first_.ranges + thermal_camera, range.stamp, cameraSensor(camera), false,
        [this, camera, range](Findings& findings) { cameras_[camera].add(range, findings); });
}
void MonitorStage::push(std::size_t radar, const RadarScan& scan) {
  watch(first_.scans + radar, scan.stamp, radarSensor(radar), true,
        [this, radar, scan](Findings& findings) { radars_[radar].add(scan, findings); });
}

void MonitorStage::watch(std::size_t input, Stamp stamp, std::size_t sensor, bool paces,
                         std::function<void(Findings&)> check) {
  Arrival& arrival = arrivals_.at(input);
  if (stamp < arrival.newest) {
    ++arrival.misordered;
    enqueue(input, stamp, [] {});  // the merge counts it as late
    return;
  }
  arrival.newest = stamp;
  const std::uint64_t misordered = arrival.misordered;
  arrival.misordered = 0;
  enqueue(input, stamp, [this, stamp, sensor, paces, misordered, check = std::move(check)] {
    tickUntil(stamp);
    Sensor& s = sensors_[sensor];
    s.timing.misordered(stamp, misordered, s.findings);
    if (paces) s.timing.add(stamp, s.findings);
    check(s.findings);
    emitChanges(stamp);
  });
}

bool MonitorStage::standing(Stamp stamp) const { return gnss_.motion().standing(stamp); }

void MonitorStage::lookAt(std::size_t lidar, const Sweep& sweep) {
  Sensor& sensor = sensors_[lidarSensor(lidar)];
  const Outcome<Pose> T_imu_lidar = rig_.T_imu(sweep.frame);
  const bool compared = lidar < 2 && lidars_.size() >= 2 && T_imu_lidar;
  RangeProfile profile;
  Eigen::Isometry3f T = Eigen::Isometry3f::Identity();
  if (compared) {
    T.linear() = T_imu_lidar->rotation.cast<float>().toRotationMatrix();
    T.translation() = T_imu_lidar->translation.cast<float>();
  }
  const ScanSummary scan = summaryOf(sweep, [&](const LidarPoint& p) {
    if (compared) profile.add(T * Eigen::Vector3f(p.x, p.y, p.z));
  });
  lidars_[lidar].add(sweep.stamp, scan, sensor.findings);
  if (compared) {
    pair_.add(lidar, sweep.stamp, profile, sensors_[lidarSensor(0)].findings,
              sensors_[lidarSensor(1)].findings);
  }
}

void MonitorStage::tickUntil(Stamp stamp) {
  if (begin_ == kBeginOfTime) {
    begin_ = stamp;
    next_tick_ = stamp + kTick;
  }
  const auto per_status = static_cast<std::uint64_t>(fromSeconds(params_.status_period_s) / kTick);
  for (; next_tick_ < stamp; next_tick_ += kTick) {
    for (Sensor& sensor : sensors_) {
      if (sensor.required || sensor.timing.seen()) sensor.timing.tick(next_tick_, begin_, sensor.findings);
    }
    emitChanges(next_tick_);
    if (++ticks_ % per_status != 0) continue;
    for (const Sensor& sensor : sensors_) {
      if (sensor.required || sensor.timing.seen()) emit(next_tick_, sensor);
    }
  }
}

void MonitorStage::emitChanges(Stamp stamp) {
  for (Sensor& sensor : sensors_) {
    if (sensor.findings.takeChange()) emit(stamp, sensor);
  }
}

void MonitorStage::emit(Stamp stamp, const Sensor& sensor) {
  counters_.add("status");
  if (on_status) on_status({stamp, sensor.name, sensor.findings.score(), sensor.findings.list()});
}

Stamp MonitorStage::heldBackFrom() const { return next_tick_; }

void MonitorStage::onProgress() {
  const Stamp known = merge().watermark();
  if (next_tick_ == kEndOfTime || known == kEndOfTime) return;  // nothing seen yet; after the last message
  if (known > next_tick_ + kSilence) tickUntil(known - kSilence);
}

void MonitorStage::onEnd() {
  for (const Sensor& sensor : sensors_) {
    const auto& begun = sensor.findings.begun();
    for (std::size_t i = 0; i < kAnomalies; ++i) {
      if (begun[i] > 0)
        counters_.add("anomaly " + sensor.name + ": " + infoOf(static_cast<Anomaly>(i)).name, begun[i]);
    }
  }
}

}  // namespace atlas
