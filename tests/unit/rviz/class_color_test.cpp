// SPDX-License-Identifier: MIT
// Every COCO class of the road has the colour that people know from the published program.
#include "class_color.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <tuple>

#include "atlas/output/coco_names.hpp"

namespace {

using atlas_rviz::ClassGroup;

TEST(ClassGroup, EveryNameIsInItsGroup) {
  const std::map<std::string, ClassGroup> road = {{"person", ClassGroup::kPedestrian},
                                                  {"bicycle", ClassGroup::kBike},
                                                  {"motorcycle", ClassGroup::kBike},
                                                  {"car", ClassGroup::kVehicle},
                                                  {"bus", ClassGroup::kVehicle},
                                                  {"train", ClassGroup::kVehicle},
                                                  {"truck", ClassGroup::kVehicle},
                                                  {"boat", ClassGroup::kVehicle},
                                                  {"bird", ClassGroup::kAnimal},
                                                  {"cat", ClassGroup::kAnimal},
                                                  {"dog", ClassGroup::kAnimal},
                                                  {"horse", ClassGroup::kAnimal},
                                                  {"sheep", ClassGroup::kAnimal},
                                                  {"cow", ClassGroup::kAnimal},
                                                  {"elephant", ClassGroup::kAnimal},
                                                  {"bear", ClassGroup::kAnimal},
                                                  {"zebra", ClassGroup::kAnimal},
                                                  {"giraffe", ClassGroup::kAnimal},
                                                  {"traffic light", ClassGroup::kTraffic},
                                                  {"stop sign", ClassGroup::kTraffic}};
  ASSERT_EQ(atlas::cocoNames().size(), 80U);
  for (int id = 0; id < 80; ++id) {
    const auto known = road.find(atlas::className(id));
    EXPECT_EQ(atlas_rviz::classGroup(id), known == road.end() ? ClassGroup::kOther : known->second)
        << atlas::className(id);
  }
}

TEST(ClassGroup, UnknownNumbersAreOther) {
  for (const int id : {-1, 80, 1000}) EXPECT_EQ(atlas_rviz::classGroup(id), ClassGroup::kOther) << id;
}

TEST(GroupColor, RedPedestriansBlueVehiclesAndAllDiffer) {
  const auto red = atlas_rviz::groupColor(ClassGroup::kPedestrian);
  EXPECT_EQ(std::make_tuple(red.r, red.g, red.b, red.a), std::make_tuple(1.F, 0.F, 0.F, 1.F));
  const auto blue = atlas_rviz::groupColor(ClassGroup::kVehicle);
  EXPECT_GT(blue.b, blue.r + blue.g);
  std::set<std::tuple<float, float, float>> colors;
  for (const ClassGroup group : {ClassGroup::kPedestrian, ClassGroup::kBike, ClassGroup::kVehicle,
                                 ClassGroup::kAnimal, ClassGroup::kTraffic, ClassGroup::kOther}) {
    const auto c = atlas_rviz::groupColor(group);
    EXPECT_EQ(c.a, 1.F);
    colors.emplace(c.r, c.g, c.b);
  }
  EXPECT_EQ(colors.size(), 6U);
}

}  // namespace
