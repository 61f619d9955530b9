// SPDX-License-Identifier: MIT
#include "record/bud_camera.hpp"

#include <stdexcept>

#include "record/detection_file.hpp"
#include "record/video_source.hpp"

namespace atlas::record {
namespace {
namespace fs = std::filesystem;

std::string size(std::uint32_t width, std::uint32_t height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

struct Camera {
  fs::path record;
  std::string name;
  bool thermal = false;
  std::shared_ptr<FrameTable> table;
  std::unique_ptr<VideoFile> video;
  std::optional<CameraInfo> info;
  std::string video_fault;  ///< why there is no video
};

void openVideo(Camera& camera, RecordLog& log) {
  const fs::path path = camera.record / camera.name / "video.mp4";
  std::error_code error;
  if (!fs::exists(path, error)) {
    camera.video_fault = "no video.mp4";
    log.note(camera.name + ": no video.mp4, no pictures");
    return;
  }
  try {
    camera.video = std::make_unique<VideoFile>(path);
  } catch (const std::runtime_error& failure) {
    camera.video_fault = "video unreadable";
    log.note(camera.name + "/video.mp4: no pictures: " + failure.what());
    return;
  }
  const std::uint32_t frames = camera.video->frames();
  const std::size_t rows = camera.table->rows().size();
  if (frames != rows) {
    log.note(camera.name + ": video has " + std::to_string(frames) + " frames, timestamps.txt " +
             std::to_string(rows) + " rows, the smaller number counts");
  }
  if (camera.video->missingFrames() > 0) {
    log.note(camera.name + "/video.mp4: cut, " + std::to_string(camera.video->missingFrames()) +
             " frames missing");
  }
  camera.table->limitFrames(frames);
}

void findInfo(Camera& camera, const RigFiles& rig, RecordLog& log) {
  const auto it = rig.cameras.find(camera.name);
  if (it == rig.cameras.end()) {
    log.note(camera.name + ": no calibration, no camera_info");
    return;
  }
  CameraInfo info = it->second;
  if (info.width == 0 || info.height == 0) {
    if (!camera.video) {
      log.note(camera.name + ": image size neither in the calibration nor in a video, no camera_info");
      return;
    }
    info.width = camera.video->width();
    info.height = camera.video->height();
  }
  if (camera.video && (camera.video->width() != info.width || camera.video->height() != info.height)) {
    log.note(camera.name + ": video is " + size(camera.video->width(), camera.video->height()) +
             ", calibration is for " + size(info.width, info.height) + ", camera_info is not scaled");
  }
  camera.info = info;
}

void addPictures(Camera& camera, const RecordOptions& options, StreamSet& streams, RecordParts& parts) {
  const bool packets = options.images == RecordOptions::Images::kPackets;
  const bool encode = options.images == RecordOptions::Images::kEncoded;
  const std::string topic = camera.name + (packets  ? "/packets"
                                           : encode ? "/image_raw/compressed"
                                                    : "/image_raw");
  const StreamKind kind = packets  ? StreamKind::kVideoPackets
                          : encode ? StreamKind::kCompressedImage
                                   : StreamKind::kImage;
  const auto stream = streams.add(topic, kind, camera.table->rows().size());
  if (!stream) return;
  const std::string name = camera.name + "/video.mp4";
  if (!camera.video) {  // as many pictures as timestamps.txt says are missing
    const std::uint64_t pictures = camera.table->rows().size();
    parts.log->file(name).rows = pictures;
    parts.log->skip(name, camera.video_fault, "", pictures);
    return;
  }
  VideoOfCamera video{std::move(camera.video), camera.table, name, camera.name, *stream};
  if (packets) {
    parts.sources.push_back(std::make_unique<PacketSource>(std::move(video), parts.log));
  } else {
    const auto pixels = camera.thermal ? VideoDecoder::Pixels::kMono8 : VideoDecoder::Pixels::kBgr8;
    parts.sources.push_back(std::make_unique<ImageSource>(std::move(video), pixels, encode, parts.log));
  }
}

ImageSize imageSize(const Camera& camera) {
  if (camera.video) return {camera.video->width(), camera.video->height()};
  if (camera.info) return {camera.info->width, camera.info->height};
  return {};
}

void addDetections(const Camera& camera, const ImageSize& image, StreamSet& streams, RecordParts& parts) {
  const std::string name = "yolo/" + camera.name + ".txt";
  std::error_code error;
  if (!fs::exists(camera.record / name, error)) return;
  const auto stream =
      streams.add(camera.name + "/detections", StreamKind::kDetections, camera.table->rows().size());
  if (!stream) return;
  auto file = std::make_shared<DetectionFile>(camera.record / name, name, image, parts.log);
  const auto make = [file, frame = camera.name](const FrameRow& row, const FrameRow*) -> Payload {
    return Detections{row.stamp, frame, row.index, file->boxes(row.index)};
  };
  parts.sources.push_back(std::make_unique<FrameSource>(
      camera.table, *stream, make,
      [file, table = camera.table](const TimeSpan& span) { file->account(*table, span); }));
}
}  // namespace

void addBudCamera(const fs::path& record, const std::string& name, const RigFiles& rig,
                  const RecordOptions& options, StreamSet& streams, RecordParts& parts) {
  std::error_code error;
  const fs::path timestamps = record / name / "timestamps.txt";
  if (!fs::exists(timestamps, error)) {
    if (fs::is_directory(record / name, error)) parts.log->note(name + ": no timestamps.txt, sensor skipped");
    return;
  }
  if (!streams.wantsAnyOf(name)) return;
  const std::size_t sources_before = parts.sources.size();
  Camera camera;
  camera.record = record;
  camera.name = name;
  camera.thermal = name == "camera_ir";
  camera.table = std::make_shared<FrameTable>(
      timestamps, name + "/timestamps.txt",
      camera.thermal ? FrameColumns::kTemperatures : FrameColumns::kInner, 0, parts.log);
  openVideo(camera, *parts.log);
  findInfo(camera, rig, *parts.log);
  const ImageSize image = imageSize(camera);
  const std::uint64_t frames = camera.table->rows().size();
  if (camera.info) {
    const auto stream = streams.add(name + "/camera_info", StreamKind::kCameraInfo, frames);
    const auto make = [info = *camera.info](const FrameRow& row, const FrameRow*) -> Payload {
      CameraInfo stamped = info;
      stamped.stamp = row.stamp;
      return stamped;
    };
    if (stream) parts.sources.push_back(std::make_unique<FrameSource>(camera.table, *stream, make));
  }
  if (camera.thermal) {
    const auto stream = streams.add(name + "/temperature_range", StreamKind::kTemperatureRange, frames);
    const auto make = [](const FrameRow& row, const FrameRow*) -> Payload {
      return TemperatureRange{row.stamp, row.minimum_degc, row.maximum_degc};
    };
    if (stream) parts.sources.push_back(std::make_unique<FrameSource>(camera.table, *stream, make));
  }
  addPictures(camera, options, streams, parts);
  addDetections(camera, image, streams, parts);
  if (parts.sources.size() == sources_before) camera.table->accountUnused("nothing of this camera is read");
}

}  // namespace atlas::record
