// SPDX-License-Identifier: MIT
// The bodies of cars, trucks, buses, people and cyclists, each a few primitives around the bottom centre.
#include "synthetic/scene.hpp"

namespace atlas::synthetic {
namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kCarColours[] = {{180, 30, 30},   {40, 70, 150}, {200, 200, 205}, {60, 60, 65},
                                  {235, 235, 230}, {30, 100, 60}, {160, 140, 60},  {110, 115, 125}};
constexpr Colour kClothes[] = {{170, 40, 50},  {40, 60, 120}, {60, 60, 60},
                               {200, 170, 60}, {70, 120, 70}, {150, 90, 140}};

void add(Object& object, Shape shape, Material material, const Eigen::Vector3d& centre,
         const Eigen::Vector3d& half, Colour colour, std::uint32_t variant = 0) {
  object.parts.push_back({shape, material, centre, half, 0.0, colour, variant, object.id});
}

void addHuman(Object& object, double x, double bottom, double height, Colour clothes) {
  const double legs = 0.47 * height, torso = 0.36 * height, head = 0.12;
  add(object, Shape::kCylinder, Material::kCloth, {x, 0.0, bottom + 0.5 * legs}, {0.14, 0.14, 0.5 * legs},
      {50, 50, 70});
  add(object, Shape::kCylinder, Material::kCloth, {x, 0.0, bottom + legs + 0.5 * torso},
      {0.22, 0.22, 0.5 * torso}, clothes);
  add(object, Shape::kEllipsoid, Material::kSkin, {x, 0.0, bottom + height - 0.15}, {head, head, 0.15},
      {215, 170, 140});
}

}  // namespace

std::string toString(ObjectClass object_class) {
  switch (object_class) {
    case ObjectClass::kPerson:
      return "person";
    case ObjectClass::kBicycle:
      return "bicycle";
    case ObjectClass::kCar:
      return "car";
    case ObjectClass::kBus:
      return "bus";
    case ObjectClass::kTruck:
      return "truck";
  }
  return "unknown";
}

Object makeCar(int id, std::uint32_t variant) {
  Object car;
  car.id = id;
  car.object_class = ObjectClass::kCar;
  const double length = 4.0 + 0.12 * (variant % 6), width = 1.74 + 0.02 * (variant % 5),
               height = 1.44 + 0.04 * (variant % 4);
  car.size = {length, width, height};
  const Colour colour = kCarColours[variant % 8];
  const double belt = 0.88;  // m: the lower box ends here
  add(car, Shape::kBox, Material::kCarBody, {0.0, 0.0, 0.5 * (belt + 0.2)},
      {0.5 * length, 0.5 * width, 0.5 * (belt - 0.2)}, colour);
  add(car, Shape::kBox, Material::kCarGlass, {-0.06 * length, 0.0, 0.5 * (belt + height)},
      {0.28 * length, 0.44 * width, 0.5 * (height - belt)}, colour);
  for (const double x : {-0.31, 0.31}) {  // two axles with wheels
    add(car, Shape::kBox, Material::kMetal, {x * length, 0.0, 0.28}, {0.29, 0.5 * width + 0.01, 0.28},
        {25, 25, 25}, 1);
  }
  return car;
}

Object makeTruck(int id) {
  Object truck;
  truck.id = id;
  truck.object_class = ObjectClass::kTruck;
  truck.size = {7.4, 2.4, 3.4};
  add(truck, Shape::kBox, Material::kCarGlass, {2.8, 0.0, 1.5}, {0.9, 1.15, 1.1}, {200, 120, 40});
  add(truck, Shape::kBox, Material::kCarBody, {-0.95, 0.0, 2.0}, {2.75, 1.2, 1.4}, {225, 225, 220});
  for (const double x : {-2.3, 2.6}) {
    add(truck, Shape::kBox, Material::kMetal, {x, 0.0, 0.45}, {0.45, 1.15, 0.45}, {25, 25, 25}, 1);
  }
  return truck;
}

Object makeBus(int id) {
  Object bus;
  bus.id = id;
  bus.object_class = ObjectClass::kBus;
  bus.size = {11.8, 2.55, 3.1};
  add(bus, Shape::kBox, Material::kCarBody, {0.0, 0.0, 0.85}, {5.9, 1.275, 0.55}, {190, 40, 40});
  add(bus, Shape::kBox, Material::kCarGlass, {0.0, 0.0, 2.25}, {5.9, 1.275, 0.85}, {215, 205, 190});
  for (const double x : {-3.6, 3.6}) {
    add(bus, Shape::kBox, Material::kMetal, {x, 0.0, 0.48}, {0.48, 1.24, 0.48}, {25, 25, 25}, 1);
  }
  return bus;
}

Object makePerson(int id, std::uint32_t variant) {
  Object person;
  person.id = id;
  person.object_class = ObjectClass::kPerson;
  const double height = 1.6 + 0.05 * (variant % 6);
  person.size = {0.44, 0.44, height};
  addHuman(person, 0.0, 0.0, height, kClothes[variant % 6]);
  return person;
}

Object makeCyclist(int id) {
  Object cyclist;
  cyclist.id = id;
  cyclist.object_class = ObjectClass::kBicycle;
  cyclist.size = {1.75, 0.5, 1.85};
  for (const double x : {-0.53, 0.53}) {  // wheels, frame, handlebar
    add(cyclist, Shape::kBox, Material::kBicycle, {x, 0.0, 0.33}, {0.33, 0.025, 0.33}, {30, 30, 30});
  }
  add(cyclist, Shape::kBox, Material::kBicycle, {0.0, 0.0, 0.62}, {0.45, 0.03, 0.14}, {200, 60, 20});
  add(cyclist, Shape::kBox, Material::kBicycle, {0.5, 0.0, 1.0}, {0.04, 0.25, 0.03}, {30, 30, 30});
  addHuman(cyclist, -0.1, 0.25, 1.6, kClothes[3]);
  return cyclist;
}

Primitive placed(const Primitive& part, const ObjectState& state) {
  Primitive result = part;
  const double c = std::cos(state.yaw), s = std::sin(state.yaw);
  result.centre = {state.x + c * part.centre.x() - s * part.centre.y(),
                   state.y + s * part.centre.x() + c * part.centre.y(), state.z + part.centre.z()};
  result.yaw = state.yaw + part.yaw;
  return result;
}

}  // namespace atlas::synthetic
