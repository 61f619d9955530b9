// SPDX-License-Identifier: MIT
// Stage: watches the raw data of all sensors and says how far each can be believed (the "fail check" of the
// first paper, section III-B). A status of every sensor once a second of event time, and when its anomalies
// change. A sensor that never delivers is watched only when it is required.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "atlas/base/stage.hpp"
#include "atlas/calibration/rig.hpp"
#include "atlas/monitor/camera_check.hpp"
#include "atlas/monitor/clock_check.hpp"
#include "atlas/monitor/gnss_check.hpp"
#include "atlas/monitor/imu_check.hpp"
#include "atlas/monitor/lidar_check.hpp"
#include "atlas/monitor/lidar_pair_check.hpp"
#include "atlas/monitor/magnetic_check.hpp"
#include "atlas/monitor/pressure_check.hpp"
#include "atlas/monitor/radar_check.hpp"
#include "atlas/monitor/timing_check.hpp"

namespace atlas {

struct MonitorParams {
  std::vector<std::string> lidars = {"lidar_left", "lidar_right"};  ///< the first two are compared
  std::vector<std::string> cameras;          ///< pictures are looked at where the decoder makes them
  std::vector<std::string> thermal_cameras;  ///< of these, those with a range of temperatures
  std::vector<std::string> radars;
  std::vector<std::string> required = {"imu", "gnss"};  ///< missing when they never deliver
  std::vector<int> dead_rings;                          ///< beams that are known to be dead, of all lidars
  double status_period_s = 1.0;
  AnomalyThresholds thresholds;
};
/// Throws std::invalid_argument that names the field and its value.
void validate(const MonitorParams& params);

class MonitorStage : public Stage {
 public:
  /// Then points of each lidar, time of each lidar, camera_info of each camera, image of each camera,
  /// temperature_range of each thermal camera, scan of each radar.
  enum Input : std::size_t {
    kTfStatic,
    kImu,
    kMagnetic,
    kPressure,
    kFix,
    kHeading,
    kSecondFix,
    kImuTime,
    kFixTime,
    kFirstLidar
  };
  /// First inputs of the lists.
  struct Inputs {
    explicit Inputs(const MonitorParams& params);
    std::size_t points, times, infos, images, ranges, scans;
  };

  explicit MonitorStage(const MonitorParams& params);
  void push(Stamp stamp, const StaticTransforms& transforms);
  void push(const ImuSample& sample);
  void push(const MagneticSample& sample);
  void push(const ScalarSample& pressure);
  void push(const GnssFix& fix);
  void push(const GnssHeading& heading);
  void pushSecond(const GnssFix& fix);
  /// Of the inputs kImuTime, kFixTime, or of a lidar.
  void pushTime(std::size_t input, const TimeReference& reference);
  void push(std::size_t lidar, const SweepPtr& sweep);
  void push(std::size_t camera, const CameraInfo& info);
  void push(std::size_t camera, const ImagePtr& image);
  void push(std::size_t thermal_camera, const TemperatureRange& range);
  void push(std::size_t radar, const RadarScan& scan);

  std::function<void(const SensorStatus&)> on_status;

 protected:
  [[nodiscard]] Stamp heldBackFrom() const override;
  void onProgress() override;
  void onEnd() override;

 private:
  struct Sensor {
    Sensor(std::string sensor, const MonitorParams& params);
    std::string name;
    bool required;
    Findings findings;
    TimingCheck timing;
  };
  struct Arrival {
    Stamp newest = kBeginOfTime;
    std::uint64_t misordered = 0;  ///< since the last one in order
  };
  enum Fixed : std::size_t { kImuSensor, kMagneticSensor, kPressureSensor, kGnss, kSecondGnss, kFirstOfList };

  /// Queues the check of a message: `paces` when the stream is the one whose stamps pace the sensor.
  void watch(std::size_t input, Stamp stamp, std::size_t sensor, bool paces,
             std::function<void(Findings&)> check);
  void tickUntil(Stamp stamp);
  void emitChanges(Stamp stamp);
  void emit(Stamp stamp, const Sensor& sensor);
  [[nodiscard]] std::size_t lidarSensor(std::size_t i) const { return kFirstOfList + i; }
  [[nodiscard]] std::size_t cameraSensor(std::size_t i) const {
    return lidarSensor(params_.lidars.size()) + i;
  }
  [[nodiscard]] std::size_t radarSensor(std::size_t i) const {
    return cameraSensor(params_.cameras.size()) + i;
  }
  void lookAt(std::size_t lidar, const Sweep& sweep);
  [[nodiscard]] bool standing(Stamp stamp) const;

  MonitorParams params_;
  Inputs first_;
  Rig rig_;
  std::vector<Sensor> sensors_;
  std::vector<Arrival> arrivals_;  ///< by input
  ImuCheck imu_;
  MagneticCheck magnetic_;
  PressureCheck pressure_;
  GnssCheck gnss_, second_gnss_;
  std::map<std::size_t, ClockCheck> clocks_;  ///< by sensor
  std::vector<LidarCheck> lidars_;
  LidarPairCheck pair_;
  std::vector<CameraCheck> cameras_;
  std::vector<std::size_t> thermal_;  ///< thermal camera -> camera
  std::vector<RadarCheck> radars_;
  Stamp begin_ = kBeginOfTime, next_tick_ = kEndOfTime;
  std::uint64_t ticks_ = 0;
};

}  // namespace atlas
