// SPDX-License-Identifier: MIT
// make_drive OUT --seed N --duration S ...: writes a synthetic record with truth. See synthetic/drive.hpp.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "synthetic/drive.hpp"

namespace {

using atlas::synthetic::DriveOptions;

int run(int argc, char** argv) {
  DriveOptions options;
  std::string out, scans = "zip";
  bool no_video = false, no_lidar = false, quiet = false, no_cameras = false;
  CLI::App app(
      "Writes a synthetic drive in the layout of the Brno Urban Dataset, with exact truth in OUT/truth");
  app.add_option("OUT", out, "folder of the record")->required();
  app.add_option("--seed", options.seed, "the same seed gives the same bytes")->capture_default_str();
  app.add_option("--duration", options.duration_s, "s")->capture_default_str();
  app.add_option("--skip", options.skip_s, "begin this many seconds into the route (12 = before the turn)")
      ->capture_default_str();
  app.add_option("--stop-at", options.stop_at_s, "with --stop-for: from this second of the route on")
      ->capture_default_str();
  app.add_option("--stop-for", options.stop_for_s, "the first standstill lasts so many seconds longer")
      ->capture_default_str();
  app.add_option("--rgb-scale", options.rgb_scale, "size of the RGB images, of 1920x1200")
      ->capture_default_str();
  app.add_option("--cameras", options.cameras, "camera_left_front,...")->delimiter(',');
  app.add_flag("--no-cameras", no_cameras, "no camera at all");
  app.add_flag("--no-video", no_video, "no mp4 and no depth pictures; boxes and detections all the same");
  app.add_flag("--no-lidar", no_lidar, "no lidars");
  app.add_option("--scans", scans, "zip or folder")
      ->check(CLI::IsMember({"zip", "folder"}))
      ->capture_default_str();
  app.add_option("--truth-points", options.truth_points_every, "truth of every Nth scan, 0 = none")
      ->capture_default_str();
  app.add_option("--truth-depth", options.truth_depth_every, "depth picture of every Nth frame, 0 = none")
      ->capture_default_str();
  app.add_option("--imu-latency", options.imu_latency_s, "s from measurement to stamp")
      ->capture_default_str();
  app.add_option("--gnss-latency", options.gnss_latency_s, "s from measurement to stamp")
      ->capture_default_str();
  app.add_flag("-q,--quiet", quiet, "no progress");
  CLI11_PARSE(app, argc, argv);
  options.video = !no_video;
  options.lidar = !no_lidar;
  options.scans_zip = scans == "zip";
  if (no_cameras) options.cameras.clear();
  std::string shown;
  int percent = -1;
  const auto progress = [&](const std::string& what, double part) {
    const int now = std::min(100, static_cast<int>(100.0 * part));
    if (quiet || (what == shown && now == percent)) return;
    shown = what;
    percent = now;
    std::fprintf(stderr, "\r%-24s %3d %%", what.c_str(), now);
  };
  const auto counts = atlas::synthetic::writeDrive(options, out, progress);
  if (!quiet) std::fprintf(stderr, "\r%-40s\r", "");
  std::printf("%s:", out.c_str());
  for (const auto& [name, count] : counts)
    std::printf(" %s %llu", name.c_str(), static_cast<unsigned long long>(count));
  std::printf("\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_drive: %s\n", error.what());
    return 1;
  }
}
