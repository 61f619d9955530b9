// SPDX-License-Identifier: MIT
// Class of an object by Bayes' rule over what a detector confuses. Classes are few: a detector's 80 are
// gathered in groups by the configuration.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "atlas/fusion/track_filter.hpp"

namespace atlas {

struct ClassParams {
  /// "name=COCO indices"; the first index stands for the class in outputs.
  std::vector<std::string> classes = {"person=0", "bicycle=1", "motorcycle=3", "car=2", "bus=5", "truck=7"};
  /// Share of an object's detections that carry the class of the column, one row per true class; empty: 0.88
  /// on the diagonal, and people on bicycles are often detected as people.
  std::vector<double> confusion;
  double detections_independent = 0.5;  ///< weight of one detection: a detector repeats its errors
  double none_prior = 0.5;              ///< of an object whose class no camera has told
};
void validate(const ClassParams& params);

/// Size and liveliness that a class suggests.
struct ClassPhysics {
  Eigen::Vector3d size = {2.0, 1.0, 1.5}, size_sigma = {3.0, 1.5, 1.0};  ///< m
  bool steers = true;  ///< has a length axis along which it moves
  MotionProfile motion;
};
[[nodiscard]] ClassPhysics physicsOf(std::int32_t coco_class);

class ClassModel {
 public:
  explicit ClassModel(const ClassParams& params);
  [[nodiscard]] std::size_t classes() const { return names_.size(); }
  [[nodiscard]] const std::string& name(std::size_t i) const { return names_[i]; }
  [[nodiscard]] std::int32_t coco(std::size_t i) const { return coco_[i].front(); }
  /// Index of the group that a COCO index belongs to; classes() when none.
  [[nodiscard]] std::size_t groupOf(std::int32_t coco_class) const;
  /// Before any detection; the last entry is "none of them".
  [[nodiscard]] std::vector<double> prior() const;
  /// Bayes' rule with one detection of this class; a class that belongs to no group says nothing.
  void update(std::vector<double>& belief, std::int32_t coco_class, double confidence) const;
  /// Likeliest class: index, classes() = none of them. Of equal ones the first.
  [[nodiscard]] static std::size_t likeliest(const std::vector<double>& belief);
  [[nodiscard]] const ClassPhysics& physics(std::size_t i) const { return physics_[i]; }

 private:
  ClassParams params_;
  std::vector<std::string> names_;
  std::vector<std::vector<std::int32_t>> coco_;
  std::vector<double> confusion_;      ///< (classes + 1) x classes, the last row for "none of them"
  std::vector<ClassPhysics> physics_;  ///< of each class, then of "none of them"
};

}  // namespace atlas
