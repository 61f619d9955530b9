// SPDX-License-Identifier: MIT
// The YAML keys of the stereo camera and the occupancy filter (compare stage_params.hpp).
#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include "atlas/grid/occupancy_chain.hpp"
#include "atlas/stereo/stereo_stage.hpp"

namespace atlas_ros {

/// Reads a word that stands for one of a few values.
template <class Reader, class Value>
void readChoice(Reader& reader, const std::string& key, const std::map<std::string, Value>& choices,
                Value& value) {
  std::string word;
  reader.readOptional(key, word);
  if (word.empty()) return;
  const auto choice = choices.find(word);
  if (choice == choices.end()) {
    std::string known;
    for (const auto& [name, unused] : choices) known += (known.empty() ? "" : ", ") + name;
    throw std::invalid_argument(key + " must be one of " + known + ", got '" + word + "'");
  }
  value = choice->second;
}

template <class Reader>
void readParams(Reader& reader, atlas::StereoStageParams& p) {
  reader.readOptional("name", p.name);
  reader.read("left_camera", p.left_camera);
  reader.read("right_camera", p.right_camera);
  reader.readOptional("max_stamp_difference_s", p.max_stamp_difference_s);
  reader.read("width_px", p.width_px);
  reader.read("range_px", p.matcher.range_px);
  reader.readOptional("method", p.matcher.method);
  reader.readOptional("aggregation", p.matcher.aggregation);
  reader.readOptional("speckle_px", p.matcher.speckle_px);
  reader.readOptional("camera_height_m", p.matcher.camera_height_m);
  reader.readOptional("camera_pitch_deg", p.matcher.camera_pitch_deg);
  reader.readOptional("false_positive", p.u_disparity.false_positive);
  reader.readOptional("false_negative", p.u_disparity.false_negative);
  reader.readOptional("max_height_m", p.u_disparity.max_height_m);
  reader.readOptional("disparity_sigma_px", p.u_disparity.disparity_sigma_px);
  reader.readOptional("ground_ahead_m", p.ground_ahead_m);
  reader.readOptional("ground_width_m", p.ground_width_m);
  reader.readOptional("ground_cell_m", p.ground_cell_m);
}

template <class Reader>
void readParams(Reader& reader, atlas::OccupancyParams& p) {
  reader.read("lidars", p.lidars);
  reader.readOptional("stereo", p.stereo);
  reader.readOptional("group_s", p.group_s);
  reader.readOptional("max_gap_s", p.max_gap_s);
  reader.readOptional("max_odometry_age_s", p.max_odometry_age_s);
  reader.read("road_below_imu_m", p.road_below_imu_m);
  reader.readOptional("unknown_above", p.unknown_above);
  reader.readOptional("threads", p.threads);
  reader.read("length_m", p.grid.length_m);
  reader.read("width_m", p.grid.width_m);
  reader.read("cell_m", p.grid.cell_m);
  reader.read("ahead_m", p.grid.ahead_m);
  reader.readOptional("layer_elevations_rad", p.layers.elevations_rad);
  reader.readOptional("layers", p.layers.count);
  reader.readOptional("layer_spacing_rad", p.layers.spacing_rad);
  reader.readOptional("layer_middle_rad", p.layers.middle_rad);
  reader.readOptional("layer_max_miss_rad", p.layers.max_miss_rad);
  reader.readOptional("hit_probability", p.beams.hit);
  reader.readOptional("free_probability", p.beams.free);
  reader.readOptional("range_sigma_m", p.beams.range_sigma_m);
  reader.readOptional("max_range_m", p.beams.max_range_m);
  reader.readOptional("trusted_m", p.beams.trusted_m);
  reader.readOptional("min_height_m", p.beams.min_height_m);
  reader.readOptional("max_height_m", p.beams.max_height_m);
  reader.readOptional("sure_free_height_m", p.beams.sure_free_height_m);
  reader.readOptional("slope_sigma", p.beams.slope_sigma);
  reader.readOptional("layer_weight", p.beams.layer_weight);
  readChoice<Reader, atlas::Pooling>(reader, "pooling",
                                     {{"product", atlas::Pooling::kProduct},
                                      {"log", atlas::Pooling::kLog},
                                      {"linear", atlas::Pooling::kLinear}},
                                     p.pooling);
  atlas::FilterParams& f = p.filter;
  readChoice<Reader, atlas::FilterMode>(
      reader, "mode", {{"lattice", atlas::FilterMode::kLattice}, {"tay2008", atlas::FilterMode::kTay2008}},
      f.mode);
  reader.readOptional("levels_mps", f.levels_mps);
  reader.readOptional("static_share", f.static_share);
  reader.readOptional("static_share_free", f.static_share_free);
  reader.readOptional("birth_per_s", f.birth_per_s);
  reader.readOptional("change_per_s", f.change_per_s);
  reader.readOptional("accelerate_per_s", f.accelerate_per_s);
  reader.readOptional("start_per_s", f.start_per_s);
  reader.readOptional("stop_per_s", f.stop_per_s);
  reader.readOptional("vanish_per_s", f.vanish_per_s);
  reader.readOptional("forget_free_s", f.forget_free_s);
  reader.readOptional("forget_moving_s", f.forget_moving_s);
  reader.readOptional("forget_static_s", f.forget_static_s);
  reader.readOptional("reach_cells", f.reach_cells);
  reader.readOptional("prediction_error", f.prediction_error);
  reader.readOptional("velocity_error", f.velocity_error);
  atlas::ClusterTrackParams& t = p.tracking;
  reader.readOptional("occupied", t.occupied);
  reader.readOptional("velocity_gate_mps", t.velocity_gate_mps);
  reader.readOptional("min_cells", t.min_cells);
  reader.readOptional("max_length_m", t.max_length_m);
  reader.readOptional("merge_above", t.merge_above);
  reader.readOptional("lost_visible_s", t.lost_visible_s);
  reader.readOptional("lost_hidden_s", t.lost_hidden_s);
  reader.readOptional("static_speed_mps", t.static_speed_mps);
  atlas::RiskParams& r = p.risk;
  reader.readOptional("risk_horizon_s", r.horizon_s);
  reader.readOptional("risk_bin_s", r.bin_s);
  reader.readOptional("vehicle_front_m", r.front_m);
  reader.readOptional("vehicle_rear_m", r.rear_m);
  reader.readOptional("vehicle_half_width_m", r.half_width_m);
}

}  // namespace atlas_ros
