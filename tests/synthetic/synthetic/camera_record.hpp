// SPDX-License-Identifier: MIT
// One camera's folder of the record: video.mp4, timestamps.txt, its detections, and the truth of boxes and
// depth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "synthetic/world.hpp"

namespace atlas::synthetic {

/// RGB: a grid of 100 099 800 ns. IR: 30 Hz with the jitter of the real stamps.
std::vector<Stamp> frameStamps(const World& world, const std::string& camera);

/// Returns the number of frames. Throws std::invalid_argument for an unknown camera.
std::uint64_t writeCamera(const World& world, const std::string& name, const std::filesystem::path& record,
                          const std::function<void(const std::string&, double)>& progress);

}  // namespace atlas::synthetic
