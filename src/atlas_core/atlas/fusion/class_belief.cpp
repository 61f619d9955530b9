// SPDX-License-Identifier: MIT
#include "atlas/fusion/class_belief.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace atlas {
namespace {

constexpr std::int32_t kPerson = 0, kBicycle = 1, kCar = 2, kMotorcycle = 3, kBus = 5, kTrain = 6, kTruck = 7;
constexpr double kRight = 0.88;          ///< share of detections with the right class
constexpr double kRiderAsPerson = 0.45;  ///< of the detections on a bicycle and its rider
constexpr double kLeastBelief = 1e-3;    ///< an object can turn out to be something else

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument("objects: " + what); }

std::vector<std::int32_t> cocoIndices(const std::string& entry) {
  const std::size_t equals = entry.find('=');
  if (equals == std::string::npos || equals == 0)
    refuse("classes must read name=index,..., got '" + entry + "'");
  std::vector<std::int32_t> indices;
  std::istringstream list(entry.substr(equals + 1));
  for (std::string field; std::getline(list, field, ',');) {
    const bool digits =
        !field.empty() && field.size() <= 3 && field.find_first_not_of("0123456789") == std::string::npos;
    if (!digits) refuse("classes must hold COCO indices, got '" + entry + "'");
    indices.push_back(std::stoi(field));
  }
  if (indices.empty()) refuse("classes must hold COCO indices, got '" + entry + "'");
  return indices;
}

/// Rows are true classes; what is not on the diagonal is shared among the others.
std::vector<double> usualConfusion(const std::vector<std::vector<std::int32_t>>& coco) {
  const std::size_t n = coco.size();
  std::vector<double> rows((n + 1) * n, 1.0 / static_cast<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const double other = n > 1 ? (1.0 - kRight) / static_cast<double>(n - 1) : 0.0;
    for (std::size_t j = 0; j < n; ++j) rows[i * n + j] = i == j ? kRight : other;
    const bool ridden = coco[i].front() == kBicycle || coco[i].front() == kMotorcycle;
    for (std::size_t j = 0; j < n && ridden; ++j) {
      if (coco[j].front() != kPerson) continue;
      rows[i * n + j] = kRiderAsPerson;
      rows[i * n + i] = kRight + other - kRiderAsPerson;
    }
  }
  return rows;
}

ClassPhysics bodyOf(const Eigen::Vector3d& size, const Eigen::Vector3d& sigma,
                    const std::vector<double>& weights, double acceleration, double turn) {
  ClassPhysics physics;
  physics.size = size;
  physics.size_sigma = sigma;
  physics.motion.weights = weights;
  physics.motion.noise = {acceleration, turn};
  return physics;
}

}  // namespace

ClassPhysics physicsOf(std::int32_t coco_class) {
  switch (coco_class) {
    case kPerson: {
      ClassPhysics person = bodyOf({0.6, 0.6, 1.7}, {0.2, 0.2, 0.2}, {0.3, 0.7, 0.0}, 0.8, 0.5);
      person.steers = false;
      return person;
    }
    case kBicycle:
    case kMotorcycle:
      return bodyOf({1.8, 0.6, 1.7}, {0.2, 0.2, 0.2}, {0.3, 0.5, 0.2}, 1.2, 0.5);
    case kCar:
      return bodyOf({4.3, 1.8, 1.55}, {0.4, 0.15, 0.2}, {0.7, 0.2, 0.1}, 1.8, 0.4);
    case kBus:
    case kTrain:
      return bodyOf({11.0, 2.55, 3.1}, {1.5, 0.15, 0.3}, {0.5, 0.35, 0.15}, 1.2, 0.2);
    case kTruck:
      return bodyOf({7.5, 2.4, 3.1}, {1.5, 0.2, 0.5}, {0.5, 0.35, 0.15}, 1.2, 0.25);
    default:
      return bodyOf({2.0, 1.0, 1.5}, {3.0, 1.5, 1.0}, {0.85, 0.12, 0.03}, 1.5, 0.4);
  }
}

void validate(const ClassParams& p) {
  if (p.classes.empty()) refuse("classes must name at least one class");
  for (const std::string& entry : p.classes) (void)cocoIndices(entry);
  const std::size_t n = p.classes.size();
  if (!p.confusion.empty() && p.confusion.size() != n * n)
    refuse("confusion must hold " + std::to_string(n * n) + " shares, got " +
           std::to_string(p.confusion.size()));
  for (const double share : p.confusion) {
    if (!(share > 0.0 && share <= 1.0))
      refuse("confusion must hold shares in (0, 1], got " + std::to_string(share));
  }
  if (!(p.detections_independent > 0.0 && p.detections_independent <= 1.0))
    refuse("detections_independent must lie in (0, 1], got " + std::to_string(p.detections_independent));
  if (!(p.none_prior > 0.0 && p.none_prior < 1.0))
    refuse("none_prior must lie in (0, 1), got " + std::to_string(p.none_prior));
}

ClassModel::ClassModel(const ClassParams& params) : params_(params) {
  validate(params);
  for (const std::string& entry : params.classes) {
    names_.push_back(entry.substr(0, entry.find('=')));
    coco_.push_back(cocoIndices(entry));
    physics_.push_back(physicsOf(coco_.back().front()));
  }
  physics_.push_back(physicsOf(-1));
  confusion_ = usualConfusion(coco_);
  std::copy(params.confusion.begin(), params.confusion.end(), confusion_.begin());
}

std::size_t ClassModel::groupOf(std::int32_t coco_class) const {
  for (std::size_t i = 0; i < coco_.size(); ++i) {
    if (std::find(coco_[i].begin(), coco_[i].end(), coco_class) != coco_[i].end()) return i;
  }
  return classes();
}

std::vector<double> ClassModel::prior() const {
  std::vector<double> belief(classes() + 1, (1.0 - params_.none_prior) / static_cast<double>(classes()));
  belief.back() = params_.none_prior;
  return belief;
}

void ClassModel::update(std::vector<double>& belief, std::int32_t coco_class, double confidence) const {
  const std::size_t seen = groupOf(coco_class), n = classes();
  if (seen == n) return;
  const double trust = std::clamp(confidence, 0.0, 1.0), chance = 1.0 / static_cast<double>(n);
  for (std::size_t i = 0; i <= n; ++i) {
    // what is none of the classes is rarely detected as one
    const double likelihood =
        trust * confusion_[i * n + seen] * (i == n ? 0.1 : 1.0) + (1.0 - trust) * chance;
    belief[i] *= std::pow(likelihood, params_.detections_independent);
  }
  const double sum = std::accumulate(belief.begin(), belief.end(), 0.0);
  for (double& p : belief) p = std::max(p / sum, kLeastBelief);
  const double again = std::accumulate(belief.begin(), belief.end(), 0.0);
  for (double& p : belief) p /= again;
}

std::size_t ClassModel::likeliest(const std::vector<double>& belief) {
  return static_cast<std::size_t>(std::max_element(belief.begin(), belief.end()) - belief.begin());
}

}  // namespace atlas
