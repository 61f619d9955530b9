// SPDX-License-Identifier: MIT
// atlas_track_kitti --detections DIR --calib DIR --oxts DIR --out DIR: the tracker alone on detections in
// KITTI's format; writes result files of the tracking benchmark.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "track_kitti.hpp"

int main(int argc, char** argv) {
  CLI::App app("Tracks 3D detections in KITTI's format.");
  atlas_loader::TrackKittiOptions options;
  app.add_option("--detections", options.detections,
                 "folder with <class>/0000.txt, ..., 3D and, if any, 2D detections")
      ->required();
  app.add_option("--calib", options.calibration, "folder with 0000.txt, ...")->required();
  app.add_option("--oxts", options.oxts, "folder with 0000.txt, ...: where the vehicle was")->required();
  app.add_option("--out", options.out, "folder for the results")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    const atlas_loader::TrackKittiReport report = atlas_loader::trackKitti(options);
    std::uint64_t frames = 0;
    for (const auto& [name, count] : report.frames) frames += count;
    for (const auto& [name, file] : report.log.files()) {
      for (const auto& [reason, rows] : file.skipped)
        std::printf("%s: %llu rows skipped: %s\n", name.c_str(), static_cast<unsigned long long>(rows),
                    reason.c_str());
    }
    std::printf("%zu sequences, %llu frames, %.0f frames/s\n", report.frames.size(),
                static_cast<unsigned long long>(frames), static_cast<double>(frames) / report.tracking_s);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "atlas_track_kitti: " << error.what() << "\n";
    return 2;
  }
}
