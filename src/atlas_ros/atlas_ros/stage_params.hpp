// SPDX-License-Identifier: MIT
// The YAML keys of every stage: field name = key. One list serves the nodelets (ParamReader) and the offline
// replay (YamlReader).
#pragma once

#include "atlas/pipeline.hpp"
#include "atlas_ros/grid_params.hpp"

namespace atlas_ros {

template <class Reader>
void readParams(Reader& reader, atlas::MonitorParams& p) {
  reader.read("lidars", p.lidars);
  reader.read("cameras", p.cameras);
  reader.readOptional("thermal_cameras", p.thermal_cameras);
  reader.readOptional("radars", p.radars);
  reader.read("required", p.required);
  reader.readOptional("dead_rings", p.dead_rings);
  reader.readOptional("status_period_s", p.status_period_s);
  for (std::size_t i = 0; i < atlas::kAnomalies; ++i) {
    const auto anomaly = static_cast<atlas::Anomaly>(i);
    reader.readOptional(atlas::infoOf(anomaly).parameter, p.thresholds[anomaly]);
  }
}

template <class Reader>
void readParams(Reader& reader, atlas::LocalizationParams& p) {
  reader.read("filter", p.filter);
  reader.read("gnss_antenna_frame", p.gnss_antenna_frame);
  atlas::PositioningParams& q = p.positioning;
  reader.read("gnss_horizontal_sigma_m", q.gnss_horizontal_sigma_m);
  reader.read("gnss_vertical_sigma_m", q.gnss_vertical_sigma_m);
  reader.read("gnss_heading_sigma_rad", q.gnss_heading_sigma_rad);
  reader.read("accelerometer_noise_mps2_sqrt_hz", q.accelerometer_noise_mps2_sqrt_hz);
  reader.read("gyroscope_noise_radps_sqrt_hz", q.gyroscope_noise_radps_sqrt_hz);
  reader.read("tilt_time_constant_s", q.tilt_time_constant_s);
  reader.read("velocity_heading_min_speed_mps", q.velocity_heading_min_speed_mps);
  reader.read("max_imu_gap_s", q.max_imu_gap_s);
  reader.readOptional("gate_on_sensors", p.gate_on_sensors);
  atlas::ReceiverParams& r = p.receivers;
  reader.readOptional("second_receiver", r.second_receiver);
  reader.readOptional("second_gnss_antenna_frame", r.second_gnss_antenna_frame);
  reader.readOptional("fallback_after_s", r.fallback_after_s);
  reader.readOptional("second_gnss_horizontal_sigma_m", r.second_gnss_horizontal_sigma_m);
  reader.readOptional("second_gnss_vertical_sigma_m", r.second_gnss_vertical_sigma_m);
  reader.readOptional("second_gnss_error_time_s", r.second_gnss_error_time_s);
  reader.readOptional("barometer", p.barometer.barometer);
  reader.readOptional("barometer_sigma_m", p.barometer.barometer_sigma_m);
  reader.readOptional("barometer_error_time_s", p.barometer.barometer_error_time_s);
  reader.readOptional("accelerometer_range_mps2", p.imu_guard.accelerometer_range_mps2);
  reader.readOptional("gyroscope_range_radps", p.imu_guard.gyroscope_range_radps);
  reader.readOptional("imu_frozen_after_s", p.imu_guard.frozen_after_s);
  atlas::EskfParams& e = q.eskf;  // of the filter "eskf"; defaults hold for cars with a MEMS IMU
  reader.readOptional("eskf_accelerometer_noise_mps2_sqrt_hz", e.accelerometer_noise_mps2_sqrt_hz);
  reader.readOptional("eskf_gyroscope_noise_radps_sqrt_hz", e.gyroscope_noise_radps_sqrt_hz);
  reader.readOptional("eskf_vibration_share", e.vibration_share);
  reader.readOptional("eskf_accelerometer_bias_mps2", e.accelerometer_bias_mps2);
  reader.readOptional("eskf_gyroscope_bias_radps", e.gyroscope_bias_radps);
  reader.readOptional("eskf_accelerometer_bias_walk_mps3_sqrt_hz", e.accelerometer_bias_walk_mps3_sqrt_hz);
  reader.readOptional("eskf_gyroscope_bias_walk_radps2_sqrt_hz", e.gyroscope_bias_walk_radps2_sqrt_hz);
  reader.readOptional("eskf_mount_sigma_rad", e.mount_sigma_rad);
  reader.readOptional("eskf_lever_arm_sigma_m", e.lever_arm_sigma_m);
  reader.readOptional("eskf_gnss_delay_sigma_s", e.gnss_delay_sigma_s);
  reader.readOptional("eskf_slip_sigma_mps", e.slip_sigma_mps);
  reader.readOptional("eskf_slip_sigma_rad", e.slip_sigma_rad);
  reader.readOptional("eskf_axle_height_m", e.axle_height_m);
  reader.readOptional("eskf_standing_sigma_mps", e.standing_sigma_mps);
  reader.readOptional("eskf_recovery_s", e.recovery_s);
}

template <class Reader>
void readParams(Reader& reader, atlas::DeskewParams& p) {
  reader.read("lidars", p.lidars);
  reader.read("batches_per_sweep", p.batches_per_sweep);
  reader.read("min_range_m", p.min_range_m);
  reader.read("max_range_m", p.max_range_m);
  reader.read("max_pose_gap_s", p.max_pose_gap_s);
  reader.readOptional("motion", p.motion);
  reader.readOptional("scan_stamp", p.scan_stamp);
  reader.readOptional("vehicle_box_m", p.vehicle_box_m);
  reader.readOptional("dead_rings", p.dead_rings);
  reader.readOptional("drop_duplicates", p.drop_duplicates);
}

template <class Reader>
void readParams(Reader& reader, atlas::AggregateParams& p) {
  reader.read("lidars", p.lidars);
  reader.read("window_s", p.window_s);
  reader.read("period_s", p.period_s);
  reader.read("voxel_m", p.voxel_m);
}

template <class Reader>
void readParams(Reader& reader, atlas::ObstacleParams& p) {
  reader.read("lidars", p.lidars);
  reader.read("window_s", p.window_s);
  reader.read("max_range_m", p.max_range_m);
  reader.read("sweeps_per_lidar", p.sweeps_per_lidar);
  reader.read("ground_cell_m", p.ground_cell_m);
  reader.read("ground_tolerance_m", p.ground_tolerance_m);
  reader.read("max_height_m", p.max_height_m);
  reader.read("cluster_tolerance_m", p.cluster_tolerance_m);
  reader.read("cluster_tolerance_per_m", p.cluster_tolerance_per_m);
  reader.read("cluster_step_m", p.cluster_step_m);
  reader.read("cluster_step_per_m", p.cluster_step_per_m);
  reader.read("min_points", p.min_points);
  reader.read("max_points", p.max_points);
}

template <class Reader>
void readParams(Reader& reader, atlas::LineParams& p) {
  reader.read("lidars", p.lidars);
  reader.read("max_range_m", p.max_range_m);
  reader.read("max_gap_m", p.max_gap_m);
  reader.read("max_gap_per_m", p.max_gap_per_m);
  reader.read("min_points", p.min_points);
  reader.read("min_length_m", p.min_length_m);
  reader.read("max_rms_m", p.max_rms_m);
  reader.read("ground_tolerance_m", p.ground_tolerance_m);
  reader.read("marking_contrast", p.marking_contrast);
  reader.read("max_marking_m", p.max_marking_m);
}

template <class Reader>
void readParams(Reader& reader, atlas::CameraLidarParams& p) {
  reader.read("cameras", p.cameras);
  reader.read("lidars", p.lidars);
  reader.read("method", p.method);
  reader.read("window_s", p.window_s);
  reader.read("look_ahead_s", p.look_ahead_s);
  reader.read("recent_s", p.recent_s);
  reader.read("max_depth_m", p.max_depth_m);
  reader.read("min_points", p.min_points);
  reader.read("object_depth_m", p.object_depth_m);
  reader.readOptional("merge_within_s", p.merge_within_s);
  reader.readOptional("gate_on_sensors", p.gate_on_sensors);
  reader.read("max_pose_gap_s", p.max_pose_gap_s);
}

template <class Reader>
void readParams(Reader& reader, atlas::ObjectParams& p) {
  reader.read("lidars", p.lidars);
  reader.read("radars", p.radars);
  reader.read("use_frustums", p.use_frustums);
  reader.read("max_range_m", p.max_range_m);
  reader.read("classes", p.tracker.classes.classes);
  reader.readOptional("confusion", p.tracker.classes.confusion);
  reader.readOptional("detections_independent", p.tracker.classes.detections_independent);
  reader.readOptional("none_prior", p.tracker.classes.none_prior);
  reader.read("confirm_existence", p.tracker.confirm_existence);
  reader.read("tell_existence", p.tracker.tell_existence);
  reader.read("drop_existence", p.tracker.drop_existence);
  reader.read("drop_position_sigma_m", p.tracker.drop_position_sigma_m);
  reader.read("static_probability", p.tracker.static_probability);
  reader.read("gate_sigmas", p.tracker.gate_sigmas);
  reader.readOptional("robust_sigmas", p.tracker.robust_sigmas);
  reader.read("history", p.tracker.history);
  reader.readOptional("max_tracks", p.tracker.max_tracks);
  reader.readOptional("max_odometry_age_s", p.max_odometry_age_s);
  reader.readOptional("max_silence_s", p.max_silence_s);
}

template <class Reader>
void readParams(Reader& reader, atlas::LocalMapParams& p) {
  reader.read("history_s", p.history_s);
  reader.read("radius_m", p.radius_m);
  reader.read("period_s", p.period_s);
  reader.read("frustum_window_s", p.frustum_window_s);
}

template <class Reader>
void readParams(Reader& reader, atlas::ThermalParams& p) {
  reader.read("thermal_camera", p.thermal_camera);
  reader.read("cameras", p.cameras);
  reader.read("lidars", p.lidars);
  reader.read("max_time_difference_s", p.max_time_difference_s);
  reader.read("neighbour_s", p.neighbour_s);
  reader.read("bridged_confidence", p.bridged_confidence);
  reader.read("max_hidden_fraction", p.max_hidden_fraction);
  reader.read("look_ahead_s", p.look_ahead_s);
  reader.read("recent_s", p.recent_s);
  reader.read("min_box_px", p.min_box_px);
  reader.read("min_visible_fraction", p.min_visible_fraction);
  reader.read("max_pose_gap_s", p.max_pose_gap_s);
}

template <class Reader>
void readParams(Reader& reader, atlas::DepthParams& p) {
  reader.read("cameras", p.cameras);
  reader.read("lidars", p.lidars);
  reader.read("window_s", p.window_s);
  reader.read("min_depth_m", p.min_depth_m);
  reader.read("max_depth_m", p.max_depth_m);
  reader.read("look_ahead_s", p.look_ahead_s);
  reader.read("recent_s", p.recent_s);
  reader.read("hide_occluded", p.hide_occluded);
  reader.read("line_gap_deg", p.line_gap_deg);
  reader.read("surface_step", p.surface_step);
  reader.read("fill_gap_m", p.fill_gap_m);
  reader.read("max_pose_gap_s", p.max_pose_gap_s);
  reader.readOptional("virtual_camera", p.virtual_camera.name);
  reader.readOptional("virtual_x_m", p.virtual_camera.x_m);
  reader.readOptional("virtual_y_m", p.virtual_camera.y_m);
  reader.readOptional("virtual_z_m", p.virtual_camera.z_m);
  reader.readOptional("virtual_pitch_deg", p.virtual_camera.pitch_deg);
  reader.readOptional("virtual_yaw_deg", p.virtual_camera.yaw_deg);
  reader.readOptional("virtual_width_px", p.virtual_camera.width_px);
  reader.readOptional("virtual_height_px", p.virtual_camera.height_px);
  reader.readOptional("virtual_focal_px", p.virtual_camera.focal_px);
}

}  // namespace atlas_ros
