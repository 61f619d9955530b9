// SPDX-License-Identifier: MIT
// One block of the city: houses around its four sides, trees and lamp posts on the pavement, parked cars at
// the kerb.
#include <cmath>

#include "synthetic/ground.hpp"
#include "synthetic/random.hpp"
#include "synthetic/scene.hpp"

namespace atlas::synthetic {
namespace {

constexpr double kSide = kBlockPitch - 2.0 * kHalfCarriageway;  // m, kerb to kerb

/// One side of a block: `along` runs from its start, `inward` points into the block, both from the kerb
/// corner.
struct Side {
  double x, y, yaw;  ///< corner and direction of `along`; inward is to the left
  [[nodiscard]] Eigen::Vector2d at(double along, double inward) const {
    const double c = std::cos(yaw), s = std::sin(yaw);
    return {x + along * c - inward * s, y + along * s + inward * c};
  }
};

void addHouses(const Side& side, Random& random, std::vector<Primitive>& statics) {
  double along = kSidewalkWidth;
  while (along < kSide - 14.0) {
    const double width = std::min(random.uniform(12.0, 24.0), kSide - 14.0 - along);
    const double depth = random.uniform(9.0, 12.0), height = random.uniform(6.0, 19.0);
    const double setback = kSidewalkWidth + 0.5 * random.integer(3);
    const bool gap = random.chance(0.12) || width < 6.0;
    const auto shade = static_cast<std::uint32_t>(random.integer(1 << 16));
    const Eigen::Vector2d middle = side.at(along + 0.5 * width, setback + 0.5 * depth);
    along += width;
    if (gap) continue;
    Primitive house;
    house.material = Material::kBuilding;
    const double ground = roadSurface(middle.x(), middle.y()).height;
    house.centre = {middle.x(), middle.y(), ground + 0.5 * height - 1.0};
    house.half = {0.5 * width - 0.02, 0.5 * depth,
                  0.5 * height + 1.0};  // 2 m of foundation, as the ground slopes
    house.yaw = side.yaw;
    house.variant = shade;
    const int warm = static_cast<int>(shade % 60);
    house.colour = {static_cast<std::uint8_t>(150 + warm), static_cast<std::uint8_t>(135 + (shade / 60) % 55),
                    static_cast<std::uint8_t>(110 + (shade / 3300) % 60)};
    statics.push_back(house);
  }
}

void addTree(const Eigen::Vector2d& p, Random& random, std::vector<Primitive>& statics) {
  const double ground = groundHeight(p.x(), p.y());
  const double trunk = random.uniform(2.2, 3.0), radius = random.uniform(1.3, 2.1),
               tall = random.uniform(1.5, 2.4);
  Primitive stem;
  stem.shape = Shape::kCylinder;
  stem.material = Material::kTrunk;
  stem.centre = {p.x(), p.y(), ground + 0.5 * (trunk + 0.5) - 0.2};
  stem.half = {0.16, 0.16, 0.5 * (trunk + 0.9)};
  stem.colour = {92, 70, 50};
  statics.push_back(stem);
  Primitive crown;
  crown.shape = Shape::kEllipsoid;
  crown.material = Material::kCrown;
  crown.centre = {p.x(), p.y(), ground + trunk + tall};
  crown.half = {radius, radius, tall};
  crown.colour = {static_cast<std::uint8_t>(50 + random.integer(30)),
                  static_cast<std::uint8_t>(100 + random.integer(40)), 45};
  statics.push_back(crown);
}

void addPost(const Eigen::Vector2d& p, std::vector<Primitive>& statics) {
  Primitive post;
  post.shape = Shape::kCylinder;
  post.material = Material::kMetal;
  post.centre = {p.x(), p.y(), groundHeight(p.x(), p.y()) + 3.0};
  post.half = {0.09, 0.09, 3.2};
  post.colour = {120, 122, 125};
  statics.push_back(post);
}

void addFurniture(const Side& side, Random& random, std::vector<Primitive>& statics) {
  for (double along = 9.0; along < kSide - 6.0; along += random.uniform(9.0, 15.0)) {
    const Eigen::Vector2d p = side.at(along, 0.8);
    if (random.chance(0.6)) addTree(p, random, statics);
  }
  for (double along = 5.0; along < kSide; along += 28.0) addPost(side.at(along, 0.45), statics);
}

void addParkedCars(const Side& side, int& next_id, Random& random, std::vector<Object>& objects) {
  for (double along = 14.0; along < kSide - 14.0; along += 6.3) {
    const bool taken = random.chance(0.55), lorry = random.chance(0.04), turned = random.chance(0.1);
    const auto variant = static_cast<std::uint32_t>(random.integer(1 << 12));
    const double jitter = random.uniform(-0.4, 0.4), gap = random.uniform(0.2, 0.45),
                 skew = random.uniform(-0.03, 0.03);
    if (!taken) continue;
    Object car = lorry ? makeTruck(next_id) : makeCar(next_id, variant);
    ++next_id;
    if (lorry) along += 3.0;
    const Eigen::Vector2d p = side.at(along + jitter, -gap - 0.5 * car.size.y());
    car.x = p.x();
    car.y = p.y();
    car.yaw = wrapAngle(side.yaw + skew + (turned ? M_PI : 0.0));
    objects.push_back(car);
  }
}

}  // namespace

void buildBlock(std::uint64_t seed, int block_x, int block_y, std::vector<Primitive>& statics,
                std::vector<Object>& objects) {
  Random random(seed, "block " + std::to_string(block_x) + " " + std::to_string(block_y));
  // Ids of a block: 256 numbers of its own above those of the moving objects; rows of 64 blocks.
  int next_id = 10000 + ((block_y + 4) * 64 + (block_x + 4)) * 256;
  const double x0 = block_x * kBlockPitch + kHalfCarriageway, y0 = block_y * kBlockPitch + kHalfCarriageway;
  const double x1 = x0 + kSide, y1 = y0 + kSide;
  const Side sides[4] = {{x0, y0, 0.0}, {x1, y0, M_PI / 2.0}, {x1, y1, M_PI}, {x0, y1, -M_PI / 2.0}};
  for (const Side& side : sides) {
    addHouses(side, random, statics);
    addFurniture(side, random, statics);
    addParkedCars(side, next_id, random, objects);
  }
}

}  // namespace atlas::synthetic
