// SPDX-License-Identifier: MIT
#include "atlas/grid/pooling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace atlas {
namespace {

float pooled(Pooling pooling, const std::vector<float>& sensors) {
  PooledGrid grid(pooling);
  grid.reset(1);
  for (const float p : sensors) grid.add({p});
  return grid.result()[0];
}

TEST(Pooling, TheProductMultipliesOdds) {
  // 0.8 : 0.2 and 0.7 : 0.3 make 0.56 : 0.06
  EXPECT_NEAR(pooled(Pooling::kProduct, {0.8F, 0.7F}), 0.56 / 0.62, 1e-6);
  EXPECT_NEAR(pooled(Pooling::kProduct, {0.8F, 0.2F}), 0.5, 1e-6);
}

TEST(Pooling, PoolsAreNoSurerThanTheSurestSensor) {
  for (const Pooling pooling : {Pooling::kLog, Pooling::kLinear}) {
    EXPECT_NEAR(pooled(pooling, {0.8F, 0.8F, 0.8F}), 0.8, 1e-5);
    const float both = pooled(pooling, {0.9F, 0.6F});
    EXPECT_GT(both, 0.6F);
    EXPECT_LT(both, 0.9F);
  }
  // weights 0.8 and 0.2: 0.8 * 0.9 + 0.2 * 0.6
  EXPECT_NEAR(pooled(Pooling::kLinear, {0.9F, 0.6F}), 0.84, 1e-5);
}

TEST(Pooling, WhoKnowsNothingHasNoPart) {
  for (const Pooling pooling : {Pooling::kProduct, Pooling::kLog, Pooling::kLinear}) {
    EXPECT_FLOAT_EQ(pooled(pooling, {}), 0.5F);
    EXPECT_FLOAT_EQ(pooled(pooling, {0.5F, 0.5F}), 0.5F);
    EXPECT_NEAR(pooled(pooling, {0.5F, 0.7F, 0.5F}), 0.7, 1e-6);
    EXPECT_NEAR(pooled(pooling, {std::numeric_limits<float>::quiet_NaN(), 0.7F, 1.5F}), 0.7, 1e-6);
  }
}

TEST(Pooling, NoOneVetoesForEverAndTheOrderDoesNotMatter) {
  for (const Pooling pooling : {Pooling::kProduct, Pooling::kLog, Pooling::kLinear}) {
    const float p = pooled(pooling, {0.0F, 1.0F});
    EXPECT_NEAR(p, 0.5, 1e-5);
    const float a = pooled(pooling, {0.9F, 0.3F, 0.6F}), b = pooled(pooling, {0.6F, 0.9F, 0.3F});
    EXPECT_NEAR(a, b, 1e-6);
  }
}

}  // namespace
}  // namespace atlas
