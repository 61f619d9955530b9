// SPDX-License-Identifier: MIT
// A value that goes into a message and back is unchanged, bit by bit; what is unknown stays unknown; nonsense
// is refused.
#include "atlas_ros/conversions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

namespace {

constexpr atlas::Stamp kStamp = 1568186745408734467;
const double kNaN = std::numeric_limits<double>::quiet_NaN();

atlas::Pose somePose() {
  return {Eigen::Quaterniond(0.3, -0.1, 0.7, 0.2).normalized(), {12345.678901234, -0.1, 1.0 / 3.0}};
}

TEST(Time, RoundTripsEveryNanosecond) {
  EXPECT_EQ(atlas_ros::fromTime(atlas_ros::toTime(kStamp)), kStamp);
  EXPECT_EQ(atlas_ros::toTime(kStamp).nsec, 408734467U);
}

TEST(Time, RefusesWhatRosCannotSay) {
  EXPECT_THROW(atlas_ros::toTime(-1), std::invalid_argument);
  EXPECT_THROW(atlas_ros::toTime(atlas::kEndOfTime), std::invalid_argument);
}

TEST(Imu, RoundTripIsExact) {
  atlas::ImuSample sample;
  sample.stamp = kStamp;
  sample.angular_velocity_radps = {0.1, -1e-300, 3.0};
  sample.linear_acceleration_mps2 = {1.0 / 3.0, 0.0, 9.80665};
  sample.orientation = somePose().rotation;
  const auto back = atlas_ros::fromMsg(atlas_ros::toMsg(sample));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp, sample.stamp);
  EXPECT_EQ(back->angular_velocity_radps, sample.angular_velocity_radps);
  EXPECT_EQ(back->linear_acceleration_mps2, sample.linear_acceleration_mps2);
  EXPECT_EQ(back->orientation->coeffs(), sample.orientation->coeffs());
}

TEST(Imu, MissingOrientationStaysMissing) {
  atlas::ImuSample sample;
  sample.stamp = kStamp;
  const auto msg = atlas_ros::toMsg(sample);
  EXPECT_EQ(msg.orientation_covariance[0], -1.0);  // REP-145
  EXPECT_FALSE(atlas_ros::fromMsg(msg)->orientation.has_value());
  sensor_msgs::Imu zeros;  // a driver that leaves the quaternion at zero and says nothing about it
  EXPECT_FALSE(atlas_ros::fromMsg(zeros)->orientation.has_value());
}

TEST(Imu, RefusesNaNAndBadQuaternions) {
  sensor_msgs::Imu msg;
  msg.angular_velocity.y = kNaN;
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kNotFinite);
  sensor_msgs::Imu long_quaternion;
  long_quaternion.orientation.w = 2.0;
  EXPECT_EQ(atlas_ros::fromMsg(long_quaternion).reason(), atlas::Reason::kNotNormalized);
}

TEST(GnssFix, KeepsFrameAndCovariance) {
  atlas::GnssFix fix;
  fix.stamp = kStamp;
  fix.position = {49.22810527, 16.57547959, 281.368};
  fix.frame = "gnss_rear";
  EXPECT_FALSE(atlas_ros::fromMsg(atlas_ros::toMsg(fix))->covariance_enu_m2.has_value());
  fix.covariance_enu_m2 = std::array<double, 9>{4e-4, 1e-5, 0, 1e-5, 4e-4, 0, 0, 0, 1.6e-3};
  const auto back = atlas_ros::fromMsg(atlas_ros::toMsg(fix));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->position.latitude_deg, fix.position.latitude_deg);
  EXPECT_EQ(back->position.longitude_deg, fix.position.longitude_deg);
  EXPECT_EQ(back->position.altitude_m, fix.position.altitude_m);
  EXPECT_EQ(back->frame, "gnss_rear");
  EXPECT_EQ(*back->covariance_enu_m2, *fix.covariance_enu_m2);
}

TEST(GnssFix, NoFixIsNoPosition) {
  sensor_msgs::NavSatFix msg;
  msg.status.status = sensor_msgs::NavSatStatus::STATUS_NO_FIX;
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kEmpty);
}

TEST(GnssHeading, KeepsYawToRoundingAndVariance) {
  for (const double yaw : {-3.1, -1.0, 0.0, 0.5, 3.14}) {
    const atlas::GnssHeading heading{kStamp, yaw, 0.01};
    const auto back = atlas_ros::headingFromMsg(atlas_ros::toMsg(heading));
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->yaw_rad, yaw, 1e-15);
    EXPECT_EQ(*back->variance_rad2, 0.01);
  }
  EXPECT_FALSE(atlas_ros::headingFromMsg(atlas_ros::toMsg(atlas::GnssHeading{kStamp, 1.0, {}}))
                   ->variance_rad2.has_value());
}

TEST(Odometry, RoundTripIsExact) {
  atlas::Odometry odometry;
  odometry.stamp = kStamp;
  odometry.T_map_imu = somePose();
  odometry.velocity_imu_mps = {10.1, 0.2, -0.3};
  for (std::size_t i = 0; i < 36; ++i) odometry.pose_covariance[i] = 1e-3 / static_cast<double>(i + 1);
  const auto back = atlas_ros::fromMsg(atlas_ros::toMsg(odometry));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->T_map_imu.rotation.coeffs(), odometry.T_map_imu.rotation.coeffs());
  EXPECT_EQ(back->T_map_imu.translation, odometry.T_map_imu.translation);
  EXPECT_EQ(back->velocity_imu_mps, odometry.velocity_imu_mps);
  EXPECT_EQ(back->pose_covariance, odometry.pose_covariance);
}

TEST(PointBatches, RoundTripIsExactWithNaNPoints) {
  auto sweep = std::make_shared<atlas::Sweep>();
  sweep->stamp = kStamp;
  sweep->frame = "lidar_left";
  sweep->points.resize(5);
  sweep->points[1] = {1.5F, -2.5F, 0.25F, 7.0F, -0.05F, 31, 0};
  sweep->points[2].x = std::numeric_limits<float>::quiet_NaN();
  atlas::BatchedSweep batched;
  batched.stamp = kStamp;
  batched.frame = sweep->frame;
  batched.sweep = sweep;
  batched.batches = {{0, 3, kStamp - 5, somePose()}, {3, 2, kStamp, somePose()}};
  batched.T_map_lidar = somePose();
  const auto back = atlas_ros::fromMsg(atlas_ros::toMsg(batched));
  ASSERT_TRUE(back);
  ASSERT_EQ((*back)->sweep->points.size(), 5U);
  EXPECT_EQ(std::memcmp((*back)->sweep->points.data(), sweep->points.data(), 5 * sizeof(atlas::LidarPoint)),
            0);
  ASSERT_EQ((*back)->batches.size(), 2U);
  EXPECT_EQ((*back)->batches[1].first, 3U);
  EXPECT_EQ((*back)->batches[0].stamp, kStamp - 5);
  EXPECT_EQ((*back)->batches[0].T_map_lidar.translation, somePose().translation);
}

TEST(PointBatches, RefusesBatchesBeyondThePoints) {
  atlas::BatchedSweep batched;
  batched.stamp = kStamp;
  batched.sweep = std::make_shared<atlas::Sweep>();
  batched.batches = {{0, 1, kStamp, somePose()}};
  EXPECT_EQ(atlas_ros::fromMsg(atlas_ros::toMsg(batched)).reason(), atlas::Reason::kBadLayout);
}

TEST(Image, KeepsPixelsAndRefusesShortData) {
  atlas::Image image;
  image.stamp = kStamp;
  image.format = "bgr8";
  image.pixels = cv::Mat(3, 5, CV_8UC3);
  for (int i = 0; i < 45; ++i) image.pixels.data[i] = static_cast<unsigned char>(i);
  auto msg = atlas_ros::toImageMsg(image);
  const auto back = atlas_ros::fromMsg(msg);
  ASSERT_TRUE(back);
  EXPECT_EQ(cv::norm((*back)->pixels, image.pixels), 0.0);
  msg.data.resize(10);
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kBadLayout);
}

TEST(Frustums, RoundTripIsExact) {
  atlas::Frustums frustums;
  frustums.stamp = kStamp;
  frustums.camera = "camera_left_front";
  frustums.image_index = 17;
  frustums.frustums.resize(1);
  atlas::Frustum& f = frustums.frustums[0];
  f.detection = {1.25, 2.5, 30.75, 40.0, 2, 0.8189};
  f.distance_m = 1.0 / 3.0;
  f.corners[7] = {1, 2, 3.3};
  const atlas::Frustums back = atlas_ros::fromMsg(atlas_ros::toMsg(frustums));
  ASSERT_EQ(back.frustums.size(), 1U);
  EXPECT_EQ(back.frustums[0].distance_m, f.distance_m);
  EXPECT_EQ(back.frustums[0].detection.confidence, f.detection.confidence);
  EXPECT_EQ(back.frustums[0].corners[7], f.corners[7]);
  EXPECT_EQ(back.image_index, 17U);
}

atlas::Lines someLines() {
  atlas::Line line;
  line.kind = atlas::LineKind::kMarking;
  line.from = {1.0 / 3.0, -2.0, 3.3};
  line.to = {12345.678901234, 0.1, -0.2};
  line.ring = 31;
  line.points = 70000;
  line.rms_m = 0.1 / 3.0;
  line.intensity = 60.7;
  return {kStamp, "lidar_left", {{}, line}};
}

TEST(Lines, RoundTripIsExact) {
  const atlas::Lines lines = someLines();
  const auto back = atlas_ros::fromMsg(atlas_ros::toMsg(lines));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->stamp, kStamp);
  EXPECT_EQ(back->frame, "lidar_left");
  ASSERT_EQ(back->lines.size(), 2U);
  EXPECT_EQ(back->lines[0].kind, atlas::LineKind::kSurface);
  const atlas::Line &in = lines.lines[1], &out = back->lines[1];
  EXPECT_EQ(out.kind, in.kind);
  EXPECT_EQ(out.from, in.from);
  EXPECT_EQ(out.to, in.to);
  EXPECT_EQ(out.ring, in.ring);
  EXPECT_EQ(out.points, in.points);
  EXPECT_EQ(out.rms_m, in.rms_m);
  EXPECT_EQ(out.intensity, in.intensity);
}

TEST(Lines, RefusesUnknownKindsAndNaN) {
  auto msg = atlas_ros::toMsg(someLines());
  msg.lines[1].kind = atlas_msgs::Line::MARKING + 1;
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kBadLayout);
  msg = atlas_ros::toMsg(someLines());
  msg.lines[0].end.z = kNaN;
  EXPECT_EQ(atlas_ros::fromMsg(msg).reason(), atlas::Reason::kNotFinite);
}

}  // namespace
