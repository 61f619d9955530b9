// SPDX-License-Identifier: MIT
// Colours and temperatures of what a camera sees: sun and sky, windows, markings, paving, leaves; warm people
// and engines.
#pragma once

#include <cstdint>
#include <vector>

#include "synthetic/camera_view.hpp"

namespace atlas::synthetic {

/// RGB, 3 bytes a pixel.
std::vector<std::uint8_t> paint(const View& view, const CameraView& camera);

/// A thermal picture as the dataset stores it: grey stretched over the frame's own range of temperatures.
struct ThermalPicture {
  double minimum_degc = 0, maximum_degc = 0;  ///< of grey 0 and 255
  std::vector<std::uint8_t> grey;
};
/// `noise_seed` gives the 0.15 deg C of the sensor.
ThermalPicture paintThermal(const View& view, const CameraView& camera, std::uint32_t noise_seed);

}  // namespace atlas::synthetic
