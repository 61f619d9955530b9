// SPDX-License-Identifier: MIT
#include "synthetic/camera_record.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

#include "synthetic/boxes2d.hpp"
#include "synthetic/camera_view.hpp"
#include "synthetic/shading.hpp"
#include "synthetic/text_file.hpp"
#include "synthetic/video_encoder.hpp"

namespace atlas::synthetic {
namespace {

using Path = std::filesystem::path;

constexpr Duration kRgbPhase = 45'654'259, kRgbPeriod = 100'099'800;  // ns, grid of the real sample
constexpr Duration kIrPhase = 18'941'222, kIrPeriod = 33'430'000, kIrJitter = 2'800'000;
constexpr std::int64_t kCameraClock = 11'851'675'248;  // ns on the camera's own clock at the first frame

Camera cameraNamed(const std::string& name, double rgb_scale) {
  for (const Camera& camera : rigCameras(rgb_scale)) {
    if (camera.name == name) return camera;
  }
  throw std::invalid_argument("DriveOptions: cameras has no \"" + name + "\"");
}

/// Writes one camera's files, frame after frame.
class CameraFolder {
 public:
  CameraFolder(const World& world, const Camera& camera, const Path& record)
      : world_(world),
        view_(camera),
        record_(record),
        timestamps_(record / camera.name / "timestamps.txt",
                    camera.thermal() ? TextFile::LineEnd::kDos : TextFile::LineEnd::kUnix),
        boxes_(record / "truth" / "boxes2d" / (camera.name + ".csv"), TextFile::LineEnd::kUnix),
        random_(world.options().seed, camera.name) {
    boxes_.print("stamp_ns,frame,object,class,x1,y1,x2,y2,visible_fraction,depth,range\n");
    if (!camera.thermal())
      yolo_ = std::make_unique<TextFile>(record / "yolo" / (camera.name + ".txt"), TextFile::LineEnd::kUnix);
    if (world.options().video) {
      video_ = std::make_unique<VideoEncoder>(record / camera.name / "video.mp4", camera.width, camera.height,
                                              camera.thermal() ? 30 : 10);
    }
  }

  void add(int frame, Stamp stamp) {
    const Camera& camera = view_.camera();
    const double t = world_.routeTime(stamp);
    const Pose T_city_camera = world_.ego().T_city_imu(t) * T_imu_sensor(camera.name);
    const View view = view_.look(world_.scene(), T_city_camera, t);
    if (camera.thermal()) {
      addThermal(frame, stamp, view);
    } else {
      const auto clock_jitter = static_cast<std::int64_t>(random_.uniform(-150e3, 150e3));
      timestamps_.print("%lld,%d, %lld\n", static_cast<long long>(stamp), frame,
                        static_cast<long long>(kCameraClock + frame * kRgbPeriod + clock_jitter));
      if (video_) video_->addRgb(paint(view, view_));
    }
    addBoxes(frame, stamp, view);
    const int every = world_.options().truth_depth_every;
    if (video_ && every > 0 && frame % every == 0) writeDepth(frame, view);
  }

  void close() {
    if (video_) video_->close();
  }

 private:
  void addThermal(int frame, Stamp stamp, const View& view) {
    const ThermalPicture picture = paintThermal(view, view_, static_cast<std::uint32_t>(frame));
    timestamps_.print("%lld,%d,%.2f,%.2f\n", static_cast<long long>(stamp), frame, picture.minimum_degc,
                      picture.maximum_degc);
    if (video_) video_->addGrey(picture.grey);
  }

  void addBoxes(int frame, Stamp stamp, const View& view) {
    const Camera& camera = view_.camera();
    const std::vector<TruthBox2d> boxes = visibleBoxes(view, view_, world_.scene());
    for (const TruthBox2d& b : boxes) {
      boxes_.print("%lld,%d,%d,%d,%.1f,%.1f,%.1f,%.1f,%.4f,%.4f,%.4f\n", static_cast<long long>(stamp), frame,
                   b.object, b.class_id, b.x1, b.y1, b.x2, b.y2, b.visible_fraction, b.depth_m, b.range_m);
    }
    if (!yolo_) return;
    for (const FakeDetection& d : detect(boxes, camera, world_.options().noise, random_)) {
      // Layout B: centre and size, by width and height; the left edge of the image is pixel -1/2.
      yolo_->print("%d, %.4f, %.4f, %.4f, %.4f, %.4f, %d\n", frame,
                   (0.5 * (d.x1 + d.x2) + 0.5) / camera.width, (0.5 * (d.y1 + d.y2) + 0.5) / camera.height,
                   (d.x2 - d.x1) / camera.width, (d.y2 - d.y1) / camera.height, d.confidence, d.class_id);
    }
  }

  void writeDepth(int frame, const View& view) const {
    const Camera& camera = view_.camera();
    cv::Mat depth(camera.height, camera.width, CV_16UC1);
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const auto at = static_cast<std::size_t>(v * camera.width + u);
        const long value =
            view.hit[at] == kHitNothing ? 0 : std::lround(256.0 * static_cast<double>(view.depth[at]));
        depth.at<std::uint16_t>(v, u) = value > 65535 ? std::uint16_t{0} : static_cast<std::uint16_t>(value);
      }
    }
    const Path folder = record_ / "truth" / "depth" / camera.name;
    std::filesystem::create_directories(folder);
    char name[32];
    std::snprintf(name, sizeof name, "%06d.png", frame);
    if (!cv::imwrite((folder / name).string(), depth))
      throw std::runtime_error("cannot write " + (folder / name).string());
  }

  const World& world_;
  CameraView view_;
  Path record_;
  TextFile timestamps_, boxes_;
  std::unique_ptr<TextFile> yolo_;
  std::unique_ptr<VideoEncoder> video_;
  Random random_;
};

}  // namespace

std::vector<Stamp> frameStamps(const World& world, const std::string& camera) {
  std::vector<Stamp> stamps;
  const Stamp start = world.options().start;
  if (camera != "camera_ir") {
    for (Stamp stamp = start + kRgbPhase; stamp < world.end(); stamp += kRgbPeriod) stamps.push_back(stamp);
    return stamps;
  }
  Random random(world.options().seed, "camera_ir stamps");
  for (Stamp grid = start + kIrPhase; grid < world.end() - kIrJitter; grid += kIrPeriod) {
    stamps.push_back(grid +
                     static_cast<Duration>(random.uniform(-1.0, 1.0) * static_cast<double>(kIrJitter)));
  }
  return stamps;
}

std::uint64_t writeCamera(const World& world, const std::string& name, const Path& record,
                          const std::function<void(const std::string&, double)>& progress) {
  const Camera camera = cameraNamed(name, world.options().rgb_scale);
  const std::vector<Stamp> stamps = frameStamps(world, name);
  CameraFolder folder(world, camera, record);
  for (int frame = 0; frame < static_cast<int>(stamps.size()); ++frame) {
    folder.add(frame, stamps[frame]);
    if (progress) progress(name, (frame + 1.0) / static_cast<double>(stamps.size()));
  }
  folder.close();
  return stamps.size();
}

}  // namespace atlas::synthetic
