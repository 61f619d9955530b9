// SPDX-License-Identifier: MIT
// Labels and results of the KITTI tracking benchmark, made ready for the scores: which objects and tracks are
// ignored is decided as in its development kit, the similarity is the overlap of the boxes in 3D (AB3DMOT).
#pragma once

#include <filesystem>
#include <string>

#include "synthetic/tracking_score.hpp"

namespace atlas::synthetic {

/// Frames of one sequence for a class ("Car", "Pedestrian", "Cyclist"). Throws std::runtime_error naming the
/// file and the line.
[[nodiscard]] std::vector<ScoredFrame> readKittiTracks(const std::filesystem::path& labels,
                                                       const std::filesystem::path& results,
                                                       const std::string& kitti_class);

}  // namespace atlas::synthetic
