// SPDX-License-Identifier: MIT
#include "atlas/grid/pooling.hpp"

#include <algorithm>
#include <cmath>

#include "atlas/base/check.hpp"

namespace atlas {
namespace {

constexpr float kLeast = 0.02F, kMost = 0.98F;  ///< P(occupied): no moment is surer

float clamped(float p) { return std::min(kMost, std::max(kLeast, p)); }  // NaN becomes kLeast: see add()

}  // namespace

void PooledGrid::reset(std::size_t cells) {
  numerator_.assign(cells, pooling_ == Pooling::kProduct ? 1.0F : 0.0F);
  weight_.assign(cells, pooling_ == Pooling::kProduct ? 1.0F : 0.0F);
  pooled_.resize(cells);
}

void PooledGrid::add(const std::vector<float>& occupied) {
  ATLAS_CHECK(occupied.size() == numerator_.size(), "sensor grid of another size");
  for (std::size_t i = 0; i < occupied.size(); ++i) {
    if (!(occupied[i] >= 0.0F && occupied[i] <= 1.0F) || occupied[i] == 0.5F) continue;
    const float p = clamped(occupied[i]);
    const float says = std::abs(2.0F * p - 1.0F);
    if (pooling_ == Pooling::kProduct) {
      const float both = numerator_[i] * p, neither = weight_[i] * (1.0F - p), sum = both + neither;
      numerator_[i] = both / sum;
      weight_[i] = neither / sum;
    } else {
      numerator_[i] += says * (pooling_ == Pooling::kLog ? std::log(p / (1.0F - p)) : p);
      weight_[i] += says;
    }
  }
}

const std::vector<float>& PooledGrid::result() {
  for (std::size_t i = 0; i < pooled_.size(); ++i) {
    const float n = numerator_[i], w = weight_[i];
    if (pooling_ == Pooling::kProduct) {
      pooled_[i] = clamped(n / (n + w));
    } else if (w == 0.0F) {
      pooled_[i] = 0.5F;
    } else {
      pooled_[i] = clamped(pooling_ == Pooling::kLog ? 1.0F / (1.0F + std::exp(-n / w)) : n / w);
    }
  }
  return pooled_;
}

}  // namespace atlas
