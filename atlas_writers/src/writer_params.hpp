// SPDX-License-Identifier: MIT
// The YAML keys of the writers (compare atlas_ros/stage_params.hpp).
#pragma once

#include "files/writer_stages.hpp"

namespace atlas {  // found by argument-dependent lookup

template <class Reader>
void readParams(Reader&, TrajectoryWriterParams&) {}
template <class Reader>
void readParams(Reader&, ObstacleWriterParams&) {}
template <class Reader>
void readParams(Reader&, ObjectWriterParams&) {}
template <class Reader>
void readParams(Reader&, StatusWriterParams&) {}
template <class Reader>
void readParams(Reader&, TraceWriterParams&) {}
template <class Reader>
void readParams(Reader& reader, CloudWriterParams& p) {
  reader.read("lidars", p.lidars);
}
template <class Reader>
void readParams(Reader& reader, LineWriterParams& p) {
  reader.read("lidars", p.lidars);
}
template <class Reader>
void readParams(Reader& reader, MapWriterParams& p) {
  reader.read("lidars", p.lidars);
  reader.read("voxel_m", p.map.voxel_m);
  reader.read("tile_m", p.map.tile_m);
  reader.read("keep_radius_m", p.map.keep_radius_m);
  reader.readOptional("colour", p.map.colour);
  reader.readOptional("colour_cameras", p.colour_cameras);
}
template <class Reader>
void readParams(Reader& reader, DepthWriterParams& p) {
  reader.read("cameras", p.cameras);
  reader.read("preview_period", p.preview_period);
}
template <class Reader>
void readParams(Reader& reader, FrustumWriterParams& p) {
  reader.read("cameras", p.cameras);
}
template <class Reader>
void readParams(Reader& reader, GridWriterParams& p) {
  reader.read("period_s", p.period_s);
}
template <class Reader>
void readParams(Reader& reader, ThermalWriterParams& p) {
  reader.read("thermal_camera", p.thermal_camera);
  reader.readOptional("radiometric", p.dataset.radiometric);
  reader.readOptional("split_block_s", p.dataset.split_block_s);
  reader.readOptional("contact_sheet_frames", p.dataset.contact_sheet_frames);
  reader.readOptional("contact_sheet_seed", p.dataset.contact_sheet_seed);
}
template <class Reader>
void readParams(Reader& reader, OverlayWriterParams& p) {
  reader.read("cameras", p.cameras);
  reader.read("period_s", p.period_s);
}

}  // namespace atlas
