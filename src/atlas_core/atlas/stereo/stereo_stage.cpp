// SPDX-License-Identifier: MIT
#include "atlas/stereo/stereo_stage.hpp"

#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>

#include "atlas/sensor/same_calibration.hpp"

namespace atlas {
namespace {

void need(bool condition, const std::string& what, double value) {
  if (!condition) throw std::invalid_argument("stereo: " + what + ", got " + std::to_string(value));
}

/// Intrinsics of the same camera with images of another width.
CameraInfo scaled(CameraInfo info, int width_px) {
  if (width_px == 0 || info.width == 0) return info;
  const double scale = static_cast<double>(width_px) / info.width;
  info.height = static_cast<std::uint32_t>(std::lround(scale * info.height));
  info.width = static_cast<std::uint32_t>(width_px);
  for (const std::size_t i : {0U, 1U, 4U}) info.K[i] *= scale;
  for (const std::size_t i : {2U, 5U})
    info.K[i] = scale * (info.K[i] + 0.5) - 0.5;  // the image begins at -1/2
  for (const std::size_t i : {0U, 1U, 3U, 5U, 7U}) info.P[i] *= scale;
  if (info.P[10] != 0.0) {
    for (const std::size_t i : {2U, 6U}) info.P[i] = scale * (info.P[i] + 0.5) - 0.5;
  }
  return info;
}

bool sameRectification(const CameraInfo& a, const CameraInfo& b) {
  return sameCalibration(a, b) && a.R == b.R && a.P == b.P;
}

cv::Mat resized(const cv::Mat& pixels, const CameraInfo& info) {
  const cv::Size size(static_cast<int>(info.width), static_cast<int>(info.height));
  cv::Mat grey = pixels, small;
  if (pixels.channels() == 3) cv::cvtColor(pixels, grey, cv::COLOR_BGR2GRAY);
  if (grey.size() == size) return grey;
  cv::resize(grey, small, size, 0, 0, cv::INTER_AREA);
  return small;
}

/// Axes of the ground (x ahead, y left, z up) in an optical frame (x right, y down, z ahead).
Pose groundInOptical() {
  Eigen::Matrix3d R;
  R << 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0;
  return {Eigen::Quaterniond(R), Eigen::Vector3d::Zero()};
}

GroundCells groundCells(const StereoStageParams& p) {
  const int columns = static_cast<int>(std::lround(p.ground_ahead_m / p.ground_cell_m));
  const int rows = static_cast<int>(std::lround(p.ground_width_m / p.ground_cell_m));
  return {0.0, -0.5 * rows * p.ground_cell_m, p.ground_cell_m, columns, rows};
}

ImagePtr greyImage(const Image& left, const cv::Mat& pixels) {
  auto image = std::make_shared<Image>();
  image->stamp = left.stamp;
  image->frame = left.frame;
  image->format = "mono8";
  image->pixels = pixels;
  return image;
}

}  // namespace

void validate(const StereoStageParams& p) {
  if (p.name.empty() || p.left_camera.empty() || p.right_camera.empty())
    throw std::invalid_argument("stereo: name, left_camera and right_camera must not be empty");
  if (p.left_camera == p.right_camera)
    throw std::invalid_argument("stereo: left_camera and right_camera are both " + p.left_camera);
  need(p.max_stamp_difference_s >= 0.0 && p.max_stamp_difference_s < 1.0,
       "max_stamp_difference_s must lie in [0, 1)", p.max_stamp_difference_s);
  need(p.width_px == 0 || (p.width_px >= 64 && p.width_px <= 8192), "width_px must be 0 or lie in 64..8192",
       p.width_px);
  validate(p.matcher);
  validate(p.u_disparity);
  need(p.ground_cell_m > 0.0, "ground_cell_m must be positive", p.ground_cell_m);
  validate(groundCells(p));
}

StereoStage::StereoStage(const StereoStageParams& params)
    : Stage(params.name,
            {"tf_static", params.left_camera + "/camera_info", params.right_camera + "/camera_info",
             params.left_camera + "/image", params.right_camera + "/image"}),
      params_(params),
      tolerance_(fromSeconds(params.max_stamp_difference_s)) {
  validate(params);
}

void StereoStage::push(Stamp stamp, const StaticTransforms& transforms) {
  enqueue(kTfStatic, stamp, [this, transforms] { rig_.add(transforms); });
}
void StereoStage::pushInfo(Input input, const CameraInfo& info) {
  enqueue(input, info.stamp, [this, input, info] { (input == kLeftInfo ? left_info_ : right_info_) = info; });
}
void StereoStage::pushImage(Input input, const ImagePtr& image) {
  enqueue(input, image->stamp,
          [this, input, image] { (input == kLeft ? lefts_ : rights_).push_back(image); });
}

Stamp StereoStage::heldBackFrom() const { return lefts_.empty() ? kEndOfTime : lefts_.front()->stamp; }

void StereoStage::answerUpTo(Stamp known) {
  while (!lefts_.empty()) {
    const ImagePtr left = lefts_.front();
    if (known != kEndOfTime && known < left->stamp + tolerance_) return;
    lefts_.pop_front();
    answer(left, takeRight(left->stamp));
  }
  while (known != kEndOfTime && !rights_.empty() && rights_.front()->stamp + tolerance_ < known) {
    counters_.add("right images without a left one");
    rights_.pop_front();
  }
}

/// The one nearest in time, null when none is near enough; those before it belong to no left image.
ImagePtr StereoStage::takeRight(Stamp left) {
  ImagePtr best;
  while (!rights_.empty() && rights_.front()->stamp <= left + tolerance_) {
    const ImagePtr& right = rights_.front();
    const Duration difference = std::abs(right->stamp - left);
    if (best && difference >= std::abs(best->stamp - left)) break;
    if (best) counters_.add("right images without a left one");
    if (difference <= tolerance_)
      best = right;
    else
      counters_.add("right images without a left one");
    rights_.pop_front();
  }
  return best;
}

StereoStage::Setup::Setup(const StereoStageParams& p, const CameraInfo& left_info,
                          const CameraInfo& right_info, const std::optional<Pose>& T_left_right)
    : left(left_info),
      right(right_info),
      rectifier(scaled(left, p.width_px), scaled(right, p.width_px), T_left_right),
      matcher(rectifier.rig(), p.matcher),
      u_disparity(rectifier.rig(), p.matcher.range_px, p.u_disparity),
      ground(rectifier.rig(), p.matcher.range_px, p.u_disparity, groundCells(p)) {}

/// Makes everything that depends on the calibration; throws std::invalid_argument when the two cameras cannot
/// be a pair.
std::optional<Reason> StereoStage::prepare() {
  if (!left_info_ || !right_info_ || left_info_->K[0] == 0.0 || right_info_->K[0] == 0.0)
    return Reason::kMissingIntrinsics;
  if (setup_ && sameRectification(setup_->left, *left_info_) &&
      sameRectification(setup_->right, *right_info_))
    return std::nullopt;
  const Outcome<Pose> left = rig_.T_imu(left_info_->frame), right = rig_.T_imu(right_info_->frame);
  std::optional<Pose> T_left_right;
  if (left && right) T_left_right = left->inverse() * *right;
  setup_ = std::make_unique<Setup>(params_, *left_info_, *right_info_, T_left_right);
  return std::nullopt;
}

void StereoStage::answer(const ImagePtr& left, const ImagePtr& right) {
  if (!right) return answerNothing(*left, Reason::kEmpty);
  if (const auto reason = prepare()) return answerNothing(*left, *reason);
  const auto fits = [](const Image& image, const CameraInfo& info) {
    return image.pixels.cols == static_cast<int>(info.width) &&
           image.pixels.rows == static_cast<int>(info.height);
  };
  if (!fits(*left, setup_->left) || !fits(*right, setup_->right))
    return answerNothing(*left, Reason::kBadLayout);
  const cv::Mat l = setup_->rectifier.left(resized(left->pixels, scaled(setup_->left, params_.width_px)));
  const cv::Mat r = setup_->rectifier.right(resized(right->pixels, scaled(setup_->right, params_.width_px)));
  counters_.add("pairs");
  tell(*left, setup_->matcher.match(l, r));
}

void StereoStage::answerNothing(const Image& left, Reason reason) {
  counters_.skip("pair", reason);
  auto disparity = std::make_shared<StereoDisparity>();
  disparity->stamp = left.stamp;
  disparity->frame = left.frame;
  if (on_disparity) on_disparity(disparity);
  if (on_surface) on_surface(greyImage(left, {}));
  if (on_u_disparity) on_u_disparity(greyImage(left, {}));
  auto ground = std::make_shared<SensorGrid>();
  ground->stamp = left.stamp;
  ground->frame = left.frame;
  if (on_ground) on_ground(ground);
}

void StereoStage::tell(const Image& left, const DisparityImage& image) {
  const StereoRig& rig = setup_->rectifier.rig();
  auto disparity = std::make_shared<StereoDisparity>();
  *disparity = {left.stamp, left.frame, rig, params_.matcher.range_px, image};
  if (on_disparity) on_disparity(disparity);
  cv::Mat surface(image.surface.size(), CV_8UC1, cv::Scalar(0));
  surface.setTo(127, image.surface == static_cast<int>(SurfaceLabel::kObstacle));
  surface.setTo(255, image.surface == static_cast<int>(SurfaceLabel::kRoad));
  if (on_surface) on_surface(greyImage(left, surface));
  auto ground = std::make_shared<SensorGrid>();
  ground->stamp = left.stamp;
  ground->frame = left.frame;
  cv::Mat u_picture;
  if (image.road) {
    const UDisparityGrid& u = setup_->u_disparity.compute(image);
    u_picture.create(u.bins, u.columns, CV_8UC1);
    for (int bin = 0; bin < u.bins; ++bin) {
      const std::uint16_t* from =
          u.occupancy.data() + static_cast<std::size_t>(bin) * static_cast<std::size_t>(u.columns);
      std::uint8_t* to = u_picture.ptr<std::uint8_t>(bin);
      for (int column = 0; column < u.columns; ++column)
        to[column] = static_cast<std::uint8_t>((from[column] * 255 + kProbabilityOne / 2) / kProbabilityOne);
    }
    const GroundCells cells = groundCells(params_);
    ground->T_sensor_grid = rig.T_left_rectified * groundInOptical();
    ground->origin_x_m = cells.origin_x_m;
    ground->origin_y_m = cells.origin_y_m;
    ground->cell_m = cells.cell_m;
    ground->columns = cells.columns;
    ground->rows = cells.rows;
    ground->occupied = setup_->ground.fill(u);
  } else {
    counters_.add("pairs without a road: no ground");
  }
  if (on_u_disparity) on_u_disparity(greyImage(left, u_picture));
  if (on_ground) on_ground(ground);
}

}  // namespace atlas
