// SPDX-License-Identifier: MIT
#include "atlas/grid/cluster_track.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace atlas {
namespace {

constexpr double kPositionSigma_m = 0.2;    ///< of a side, from cells of 0.2 m and beams that miss corners
constexpr double kHiddenSigma_m = 1.5;      ///< of the middle of a part whose ends are hidden
constexpr double kVelocitySigma_mps = 0.8;  ///< least, of the mean of cells: they err together
constexpr double kIndependentCells = 4.0;   ///< of a cluster, at most
constexpr double kFirstSpeedSigma_mps = 5.0;
constexpr double kCorrelatedUpdates = 6.0;  ///< in so many steps cells err in the same way
constexpr double kStands = 0.8;             ///< static share of a thing that surely stands
constexpr double kHeadingSpeed_mps = 1.2;   ///< slower things do not show where their front is
constexpr double kShrink = 0.98;            ///< of a size that is not seen any more, each update
constexpr double kSmooth = 0.3;             ///< weight of the newest size and direction of standing things
constexpr std::size_t kRecent = 16;
constexpr double kDefaultHeight_m = 1.6;

struct Mean {
  Eigen::Vector2d velocity = Eigen::Vector2d::Zero();
  double variance = 0, static_share = 0;
};

Mean meanOf(const Cluster& cells) {
  Mean mean;
  double sum = 0;
  for (const ClusterCell& cell : cells) {
    mean.velocity += cell.weight * cell.velocity;
    mean.variance += cell.weight * cell.variance;
    mean.static_share += cell.weight * cell.static_share;
    sum += cell.weight;
  }
  mean.velocity /= sum;
  mean.variance /= sum;
  mean.static_share /= sum;
  return mean;
}

/// Middle along one axis of the seen part [low, high], and how far it can be believed. A side is an end of
/// the object where the ground beyond it is seen free; where it is hidden the object goes on.
struct Middle {
  double at = 0, sigma_m = kPositionSigma_m;
};
Middle middleAlong(double low, double high, bool low_ends, bool high_ends, double size) {
  if (low_ends == high_ends) return {0.5 * (low + high), low_ends ? kPositionSigma_m : kHiddenSigma_m};
  const double whole = std::max(size, high - low);
  return {low_ends ? low + 0.5 * whole : high - 0.5 * whole, kPositionSigma_m};
}

/// Whether the ground beyond a side of a box is free: at three places along the side.
bool endsAt(const GroundBox& box, const Eigen::Vector2d& outwards, double half_out, double half_side,
            double cell_m, const std::function<bool(const Eigen::Vector2d&)>& seen_free) {
  const Eigen::Vector2d side(-outwards.y(), outwards.x());
  int free = 0;
  for (const double along : {-0.6, 0.0, 0.6}) {
    const Eigen::Vector2d near = box.center + (half_out + cell_m) * outwards + along * half_side * side;
    free += seen_free(near) || seen_free(near + cell_m * outwards) ? 1 : 0;
  }
  return free >= 2;
}

}  // namespace

ClusterTrack::ClusterTrack(std::uint32_t id, Stamp stamp, const Cluster& cells,
                           const Eigen::Vector2d& seen_from_map, double cell_m)
    : id_(id), stamp_(stamp), first_seen_(stamp), last_seen_(stamp) {
  const GroundBox box = outlineBox(cells, seen_from_map, cell_m);
  const Mean mean = meanOf(cells);
  state_ << box.center, mean.velocity;
  covariance_.setZero();
  covariance_.diagonal().head<2>().setConstant(4.0 * kPositionSigma_m * kPositionSigma_m);
  covariance_.diagonal().tail<2>().setConstant(
      std::min(kFirstSpeedSigma_mps * kFirstSpeedSigma_mps, 1.0 + mean.variance));
  yaw_rad_ = box.yaw_rad;
  length_ = box.length;
  width_ = box.width;
  static_share_ = mean.static_share;
  cells_ = cells.size();
  recent_.push_back(true);
}

void ClusterTrack::predict(Stamp stamp, double acceleration_mps2) {
  const double dt = toSeconds(stamp - stamp_), q = acceleration_mps2 * acceleration_mps2;
  stamp_ = stamp;
  Eigen::Matrix4d A = Eigen::Matrix4d::Identity(), Q = Eigen::Matrix4d::Zero();
  A(0, 2) = A(1, 3) = dt;
  Q(0, 0) = Q(1, 1) = q * dt * dt * dt * dt / 4.0;
  Q(0, 2) = Q(2, 0) = Q(1, 3) = Q(3, 1) = q * dt * dt * dt / 2.0;
  Q(2, 2) = Q(3, 3) = q * dt * dt;
  state_ = A * state_;
  covariance_ = A * covariance_ * A.transpose() + Q;
}

bool ClusterTrack::headingKnown() const {
  const double speed = velocity().norm();
  return speed > kHeadingSpeed_mps && speed * speed > 9.0 * std::max(covariance_(2, 2), covariance_(3, 3));
}

void ClusterTrack::turnBox(const Cluster& cells, const Eigen::Vector2d& seen_from_map, double cell_m) {
  if (headingKnown()) {
    const double heading = std::atan2(state_(3), state_(2));
    if (!by_heading_) {
      const GroundBox fresh = boxAlong(cells, heading, cell_m);
      length_ = fresh.length;
      width_ = fresh.width;
    }
    by_heading_ = true;
    yaw_rad_ = heading;
    const GroundBox seen = boxAlong(cells, yaw_rad_, cell_m);
    length_ = std::max(kShrink * length_, seen.length);
    width_ = std::max(kShrink * width_, seen.width);
    return;
  }
  if (by_heading_) {  // stopped: it keeps its direction
    const GroundBox seen = boxAlong(cells, yaw_rad_, cell_m);
    length_ = std::max(kShrink * length_, seen.length);
    width_ = std::max(kShrink * width_, seen.width);
    return;
  }
  const GroundBox seen = outlineBox(cells, seen_from_map, cell_m);
  const double turn = std::remainder(seen.yaw_rad - yaw_rad_, M_PI);
  yaw_rad_ += std::abs(turn) < M_PI / 4.0 ? kSmooth * turn : turn;
  length_ += kSmooth * (seen.length - length_);
  width_ += kSmooth * (seen.width - width_);
}

void ClusterTrack::update(const Cluster& cells, const Eigen::Vector2d& seen_from_map, double cell_m,
                          const std::function<bool(const Eigen::Vector2d&)>& seen_free) {
  Cluster seen;
  for (const ClusterCell& cell : cells) {
    if (cell.seen) seen.push_back(cell);
  }
  const Cluster& used = seen.empty() ? cells : seen;
  const Mean mean = meanOf(used);
  turnBox(used, seen_from_map, cell_m);
  const GroundBox box = boxAlong(used, yaw_rad_, cell_m);
  const Eigen::Vector2d along(std::cos(yaw_rad_), std::sin(yaw_rad_)), across(-along.y(), along.x());
  const auto middle = [&](const Eigen::Vector2d& axis, double half, double half_side, double size) {
    const double at = box.center.dot(axis);
    return middleAlong(at - half, at + half, endsAt(box, -axis, half, half_side, cell_m, seen_free),
                       endsAt(box, axis, half, half_side, cell_m, seen_free), size);
  };
  const Middle x = middle(along, 0.5 * box.length, 0.5 * box.width, length_),
               y = middle(across, 0.5 * box.width, 0.5 * box.length, width_);
  Eigen::Vector4d z;
  z << x.at * along + y.at * across, mean.velocity;
  Eigen::Matrix4d R = Eigen::Matrix4d::Zero();
  R.topLeftCorner<2, 2>() =
      x.sigma_m * x.sigma_m * along * along.transpose() + y.sigma_m * y.sigma_m * across * across.transpose();
  R.diagonal().tail<2>().setConstant(
      kCorrelatedUpdates * (kVelocitySigma_mps * kVelocitySigma_mps + mean.variance / kIndependentCells));
  const Eigen::Matrix4d S = covariance_ + R, K = covariance_ * S.inverse(),
                        I_K = Eigen::Matrix4d::Identity() - K;
  state_ += K * (z - state_);
  covariance_ = I_K * covariance_ * I_K.transpose() + K * R * K.transpose();
  static_share_ += kSmooth * (mean.static_share - static_share_);
  for (const ClusterCell& cell : used) {
    if (cell.top_m == cell.top_m) height_m_ = std::max<double>(height_m_.value_or(0.0), cell.top_m);
  }
  cells_ = cells.size();
  last_seen_ = stamp_;
  detectability_ = 1.0;
  recent_.push_back(true);
  if (recent_.size() > kRecent) recent_.pop_front();
}

void ClusterTrack::miss(double detectability) {
  detectability_ = detectability;
  recent_.push_back(false);
  if (recent_.size() > kRecent) recent_.pop_front();
}

void ClusterTrack::absorb(const ClusterTrack& other) {
  // The boxes' middles are those of parts: the whole's middle is that of both, its velocity the better known.
  Cluster corners;
  for (const GroundBox& part : {box(), other.box()}) {
    const Eigen::Vector2d along(std::cos(part.yaw_rad), std::sin(part.yaw_rad)),
        across(-along.y(), along.x());
    for (const double a : {-0.5, 0.5}) {
      for (const double b : {-0.5, 0.5}) {
        corners.emplace_back();
        corners.back().position = part.center + a * part.length * along + b * part.width * across;
      }
    }
  }
  const GroundBox whole = boxAlong(corners, yaw_rad_, 0.0);
  const Eigen::Matrix2d mine = covariance_.bottomRightCorner<2, 2>(),
                        theirs = other.covariance_.bottomRightCorner<2, 2>();
  const Eigen::Matrix2d weight = theirs * (mine + theirs).inverse();
  state_.tail<2>() = weight * velocity() + (Eigen::Matrix2d::Identity() - weight) * other.velocity();
  state_.head<2>() = whole.center;
  covariance_.topLeftCorner<2, 2>().diagonal().array() += kPositionSigma_m * kPositionSigma_m;
  length_ = whole.length;
  width_ = whole.width;
  if (other.height_m_) height_m_ = std::max(height_m_.value_or(0.0), *other.height_m_);
  first_seen_ = std::min(first_seen_, other.first_seen_);
  last_seen_ = std::max(last_seen_, other.last_seen_);
  confirmed_ = confirmed_ || other.confirmed_;
}

GroundBox ClusterTrack::box() const { return {state_.head<2>(), yaw_rad_, length_, width_}; }

GroundBox ClusterTrack::region(double margin_m) const {
  GroundBox region = box();
  const double more = margin_m + 3.0 * std::sqrt(std::max(covariance_(0, 0), covariance_(1, 1)));
  region.length += 2.0 * more;
  region.width += 2.0 * more;
  return region;
}

void ClusterTrack::confirm(int hits, int of) {
  int count = 0;
  const std::size_t last = std::min(recent_.size(), static_cast<std::size_t>(of));
  for (std::size_t i = recent_.size() - last; i < recent_.size(); ++i) count += recent_[i] ? 1 : 0;
  confirmed_ = confirmed_ || count >= hits;
}

bool ClusterTrack::isStatic(double static_speed_mps) const {
  const double speed = velocity().norm();
  const double sigma = std::sqrt(std::max(covariance_(2, 2), covariance_(3, 3)));
  return static_share_ > kStands || speed < static_speed_mps || speed < 2.0 * sigma;
}

Object ClusterTrack::report(double road_m, double static_speed_mps) const {
  Object object;
  object.id = id_;
  object.class_probability = 1.0;  // of "none of the known classes"
  object.class_probabilities = {1.0};
  const auto observed = static_cast<double>(std::count(recent_.begin(), recent_.end(), true));
  object.existence = observed / static_cast<double>(recent_.size());
  const double height = height_m_.value_or(kDefaultHeight_m);
  object.position = {state_(0), state_(1), road_m + 0.5 * height};
  object.size = {length_, width_, height};
  object.z_variance_m2 = height_m_ ? 0.01 : 0.25 * kDefaultHeight_m * kDefaultHeight_m;
  object.yaw_rad = wrapAngle(yaw_rad_);
  object.heading_known = by_heading_;
  object.yaw_variance_rad2 = by_heading_ ? 0.02 : 0.2;
  object.velocity_mps = {state_(2), state_(3), 0.0};
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) object.covariance[static_cast<std::size_t>(5 * r + c)] = covariance_(r, c);
  }
  object.covariance[24] = 1.0;  // rad^2/s^2: the rate of turn is not estimated
  object.static_probability = static_share_;
  object.is_static = isStatic(static_speed_mps);
  object.age_s = toSeconds(stamp_ - first_seen_);
  object.unseen_s = unseenFor_s();
  object.detectability = detectability_;
  object.score = object.existence;
  return object;
}

double gapBetween(const GroundBox& a, const GroundBox& b) {
  const Eigen::Vector2d d = b.center - a.center;
  const double distance = d.norm();
  if (distance < 1e-6) return 0.0;
  const auto reach = [&](const GroundBox& box) {
    const double c =
        std::abs(d.dot(Eigen::Vector2d(std::cos(box.yaw_rad), std::sin(box.yaw_rad)))) / distance;
    const double s = std::sqrt(std::max(0.0, 1.0 - c * c));
    return 0.5 * std::min(box.length / std::max(c, 1e-6), box.width / std::max(s, 1e-6));
  };
  return std::max(0.0, distance - reach(a) - reach(b));
}

bool contains(const GroundBox& box, const Eigen::Vector2d& point) {
  const Eigen::Vector2d d = point - box.center, along(std::cos(box.yaw_rad), std::sin(box.yaw_rad));
  return std::abs(d.dot(along)) <= 0.5 * box.length &&
         std::abs(along.x() * d.y() - along.y() * d.x()) <= 0.5 * box.width;
}

}  // namespace atlas
