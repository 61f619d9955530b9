// SPDX-License-Identifier: MIT
#include "atlas/fusion/class_belief.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace atlas {
namespace {

TEST(ClassBelief, BayesByHand) {
  ClassParams params;
  params.classes = {"person=0", "car=2"};
  params.confusion = {0.9, 0.1, 0.2, 0.8};
  params.detections_independent = 1.0;
  params.none_prior = 0.5;
  const ClassModel model(params);
  std::vector<double> belief = model.prior();
  EXPECT_EQ(belief, (std::vector<double>{0.25, 0.25, 0.5}));
  model.update(belief, 2, 1.0);
  // 0.25 * 0.1, 0.25 * 0.8, 0.5 * 0.5 * 0.1
  const double sum = 0.025 + 0.2 + 0.025;
  EXPECT_NEAR(belief[0], 0.025 / sum, 1e-12);
  EXPECT_NEAR(belief[1], 0.2 / sum, 1e-12);
  EXPECT_NEAR(belief[2], 0.025 / sum, 1e-12);
  EXPECT_EQ(ClassModel::likeliest(belief), 1U);
}

TEST(ClassBelief, AClassThatBelongsToNoGroupSaysNothing) {
  const ClassModel model({});
  std::vector<double> belief = model.prior();
  const auto before = belief;
  for (const std::int32_t unknown : {-1, 4, 79, 1000000}) model.update(belief, unknown, 1.0);
  EXPECT_EQ(belief, before);
  EXPECT_EQ(model.groupOf(2), 3U);
  EXPECT_EQ(model.groupOf(42), model.classes());
}

TEST(ClassBelief, ARiderIsABicycleThoughOftenDetectedAsAPerson) {
  const ClassModel model({});
  std::vector<double> rider = model.prior(), walker = model.prior();
  for (int i = 0; i < 5; ++i) {
    model.update(rider, 1, 0.9);
    model.update(rider, 0, 0.85);
    model.update(walker, 0, 0.9);
  }
  EXPECT_EQ(model.coco(ClassModel::likeliest(rider)), 1);
  EXPECT_EQ(model.coco(ClassModel::likeliest(walker)), 0);
}

TEST(ClassBelief, WrongDetectionsAreOutvotedAndNothingIsCertain) {
  const ClassModel model({});
  std::vector<double> belief = model.prior();
  for (int i = 0; i < 200; ++i) model.update(belief, 7, 0.9);
  EXPECT_LT(belief[5], 1.0);
  for (int i = 0; i < 20; ++i) model.update(belief, 2, 0.9);
  EXPECT_EQ(model.coco(ClassModel::likeliest(belief)), 2);
  EXPECT_NEAR(std::accumulate(belief.begin(), belief.end(), 0.0), 1.0, 1e-9);
}

TEST(ClassBelief, RefusesWhatMakesNoSense) {
  const auto refused = [](auto change) {
    ClassParams params;
    change(params);
    EXPECT_THROW(validate(params), std::invalid_argument);
  };
  refused([](ClassParams& p) { p.classes.clear(); });
  refused([](ClassParams& p) { p.classes = {"car"}; });
  refused([](ClassParams& p) { p.classes = {"car=two"}; });
  refused([](ClassParams& p) { p.classes = {"car="}; });
  refused([](ClassParams& p) { p.confusion = {0.5, 0.5}; });
  refused([](ClassParams& p) { p.none_prior = 1.0; });
  refused([](ClassParams& p) { p.detections_independent = 0.0; });
}

}  // namespace
}  // namespace atlas
