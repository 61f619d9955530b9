// SPDX-License-Identifier: MIT
// What stands and moves in the synthetic city: primitives (boxes, vertical cylinders and ellipsoids, all with
// a vertical axis) grouped into objects. Everything is in the `city` frame, m; the city is a function of the
// seed alone.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "atlas/base/geometry.hpp"
#include "synthetic/ego_motion.hpp"

namespace atlas::synthetic {

enum class Shape : std::uint8_t { kBox, kCylinder, kEllipsoid };
enum class Material : std::uint8_t {
  kNothing,
  kRoad,
  kSidewalk,
  kKerb,
  kBuilding,
  kMetal,
  kTrunk,
  kCrown,
  kCarBody,
  kCarGlass,
  kCloth,
  kSkin,
  kBicycle
};

/// A solid whose axis is vertical. Cylinders and ellipsoids have radius half.x() = half.y().
struct Primitive {
  Shape shape = Shape::kBox;
  Material material = Material::kNothing;
  Eigen::Vector3d centre =
      Eigen::Vector3d::Zero();  ///< city frame; for parts of a moving object: in the object's frame
  Eigen::Vector3d half = Eigen::Vector3d::Zero();  ///< m
  double yaw = 0.0;                                ///< rad
  std::array<std::uint8_t, 3> colour{};            ///< RGB
  std::uint32_t variant = 0;                       ///< for textures
  int object = 0;                                  ///< object id; 0 for houses, poles and trees
};

/// Classes with their COCO-80 index.
enum class ObjectClass : int { kPerson = 0, kBicycle = 1, kCar = 2, kBus = 5, kTruck = 7 };
std::string toString(ObjectClass object_class);

/// Pose and velocity of an object's bottom centre at an instant, city frame.
struct ObjectState {
  double x = 0, y = 0, z = 0, yaw = 0;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
};

/// A car, person, ...: parts around its bottom centre (x forward), and how it moves.
struct Object {
  enum class Motion : std::uint8_t { kStill, kLine, kRoute };
  int id = 0;
  ObjectClass object_class = ObjectClass::kCar;
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< length, width, height, m
  std::vector<Primitive> parts;
  Motion motion = Motion::kStill;
  double x = 0, y = 0, yaw = 0;      ///< at time_s (kStill: always)
  double speed = 0;                  ///< m/s along yaw, kLine
  double time_s = 0;                 ///< kLine: when it is at (x, y)
  double from_s = -1e9, to_s = 1e9;  ///< exists in this interval
  double lead_s = 0, lead_m = 0;     ///< kRoute: drives the ego's route this much ahead in time and distance
};

class Scene {
 public:
  /// The city along the ego's route over [-1, duration_s].
  Scene(std::uint64_t seed, const EgoMotion& ego, double duration_s);

  [[nodiscard]] const std::vector<Primitive>& statics() const {
    return statics_;
  }  ///< includes parts of still objects
  [[nodiscard]] const std::vector<Object>& objects() const { return objects_; }
  [[nodiscard]] ObjectState stateAt(const Object& object, double t_s) const;
  [[nodiscard]] static bool exists(const Object& object, double t_s) {
    return t_s >= object.from_s && t_s <= object.to_s;
  }
  [[nodiscard]] const Object* find(int id) const;

  /// Primitives whose bounding sphere comes within `radius_m` (ground plane) of a point at t_s, moving ones
  /// placed for t_s. `velocity` (same length) is how they move.
  struct Snapshot {
    std::vector<Primitive> primitives;
    std::vector<Eigen::Vector3d> velocity;
  };
  [[nodiscard]] Snapshot snapshot(const Eigen::Vector3d& p_city, double radius_m, double t_s) const;

 private:
  const EgoMotion& ego_;
  std::vector<Primitive> statics_;
  std::vector<Object> objects_;  ///< ordered by id
};

/// Placed part of an object: from the object's frame to the city frame.
Primitive placed(const Primitive& part, const ObjectState& state);

/// Bodies (parts and size filled in; place and motion are the caller's).
Object makeCar(int id, std::uint32_t variant);
Object makeTruck(int id);
Object makeBus(int id);
Object makePerson(int id, std::uint32_t variant);
Object makeCyclist(int id);

/// Houses, pavement furniture and parked cars of one block; ids of the cars are derived from the block.
void buildBlock(std::uint64_t seed, int block_x, int block_y, std::vector<Primitive>& statics,
                std::vector<Object>& objects);
/// Moving objects along the route; those that would come too near to the ego or to each other are left out.
void buildTraffic(std::uint64_t seed, const EgoMotion& ego, double duration_s, std::vector<Object>& objects);

}  // namespace atlas::synthetic
