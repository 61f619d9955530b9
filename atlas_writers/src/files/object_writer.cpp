// SPDX-License-Identifier: MIT
#include "files/object_writer.hpp"

#include "atlas/output/objects_text.hpp"

namespace atlas {
namespace {

/// T_camera_imu of a camera in base_link that looks forward.
Pose forwardCamera() {
  Eigen::Matrix3d R;
  R << 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0;
  return {Eigen::Quaterniond(R), Eigen::Vector3d::Zero()};
}

}  // namespace

ObjectWriter::ObjectWriter(const std::filesystem::path& out)
    : csv_(std::make_unique<OutputFile>(out / "objects" / "objects.csv")),
      kitti_(std::make_unique<OutputFile>(out / "objects" / "kitti.txt")) {
  csv_->write(objectsCsvHeader());
}

void ObjectWriter::write(const Objects& objects) {
  csv_->write(objectsCsvRows(objects));
  const std::uint32_t frame = frame_++;
  if (!objects.T_map_imu) return;
  const KittiCamera camera{forwardCamera() * objects.T_map_imu->inverse(), std::nullopt};
  for (const Object& object : objects.objects) {
    if (const auto row = kittiTrackingRow(frame, object, camera)) kitti_->write(*row);
  }
}

void ObjectWriter::close() {
  if (csv_) csv_->commit();
  if (kitti_) kitti_->commit();
  csv_.reset();
  kitti_.reset();
}

}  // namespace atlas
