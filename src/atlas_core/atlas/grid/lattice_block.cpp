// SPDX-License-Identifier: MIT
#include "atlas/grid/lattice_block.hpp"

#include "atlas/base/avx2_clones.hpp"

namespace atlas {
namespace {

using Lanes = LatticeBlock::Lanes;
constexpr int kGroups = LatticeBlock::kGroups;
constexpr float kTiny = 1e-6F;  ///< less than that is nothing: no velocity is told

/// Predicted belief: each velocity with its exchange with the four next ones.
ATLAS_AVX2_CLONES
void predict(const VelocityLattice& lattice, const LatticeRates& rates, int group, LatticeBlock& block) {
  const int side = lattice.side, standing = lattice.standing();
  const float accelerate = rates.accelerate;
  const Lanes* belief = reinterpret_cast<const Lanes*>(block.belief.data()) + group;
  Lanes* next = reinterpret_cast<Lanes*>(block.next.data());
  for (int ky = 0, k = 0; ky < side; ++ky) {
    for (int kx = 0; kx < side; ++kx, ++k) {
      const Lanes own = belief[k * kGroups];
      Lanes around = kx > 0 ? belief[(k - 1) * kGroups] : own;
      around += kx + 1 < side ? belief[(k + 1) * kGroups] : own;
      around += ky > 0 ? belief[(k - side) * kGroups] : own;
      around += ky + 1 < side ? belief[(k + side) * kGroups] : own;
      next[k] = own + accelerate * (around - 4.0F * own);
    }
  }
  // Between standing and slow things go other rates, by which standing ones are the more frequent.
  const Lanes stood = belief[standing * kGroups];
  for (const int slow : {standing - side, standing - 1, standing + 1, standing + side}) {
    const Lanes kept =
        (accelerate - rates.start) * stood - (accelerate - rates.stop) * belief[slow * kGroups];
    next[slow] -= kept;
    next[standing] += kept;
  }
  Lanes moving{};
  for (int k = 0; k < standing; ++k) moving += next[k];
  for (int k = standing + 1; k < side * side; ++k) moving += next[k];
  block.predicted_moving = moving;
  block.predicted_standing = next[standing];
}

/// What the measurement makes of the predicted sums.
ATLAS_AVX2_CLONES
void correct(const LatticeRates& rates, float one_velocity, int group, LatticeBlock& block) {
  const Lanes zero{}, one = zero + 1.0F;
  const Lanes L = reinterpret_cast<const Lanes*>(block.occupied)[group];
  Lanes* stored_empty = reinterpret_cast<Lanes*>(block.empty) + group;
  Lanes says = 2.0F * L - one;
  const Lanes nothing_came = says < zero ? zero : says;  // births only where something is seen
  says = says < zero ? -says : says;
  const Lanes silent = one - says;

  const Lanes arrived = block.predicted_moving + block.predicted_standing;
  const Lanes fit = arrived > one ? one / arrived : one;
  const Lanes keep_moving = fit * (one - silent * rates.forget_moving);
  const Lanes keep_standing = fit * (one - silent * rates.forget_static);
  const Lanes moving = keep_moving * block.predicted_moving,
              standing = keep_standing * block.predicted_standing;
  const Lanes room = one - moving - standing;
  Lanes empty = *stored_empty < room ? *stored_empty : room;
  empty = empty > zero ? empty * (one - silent * rates.forget_free) : zero;
  Lanes unknown = room - empty;
  unknown = unknown > zero ? unknown : zero;

  const Lanes resolved = 0.5F * says * unknown;  // to either side
  unknown -= 2.0F * resolved;
  const Lanes came = empty * nothing_came * rates.birth;
  const Lanes stays = one - says * rates.vanish;
  empty += resolved - came + (one - stays) * (moving + standing);

  const Lanes occupied = stays * (moving + standing) + resolved + came;
  const Lanes evidence = L * occupied + (one - L) * empty + 0.5F * unknown;
  const Lanes likely = L / evidence;
  const Lanes new_moving = (1.0F - rates.static_share) * resolved + (1.0F - rates.static_share_free) * came +
                           rates.change * stays * moving;
  block.scale_moving = keep_moving * stays * (1.0F - rates.change) * likely;
  block.scale_standing = keep_standing * stays * likely;
  block.add_moving = new_moving * likely * one_velocity;
  block.add_standing = (rates.static_share * resolved + rates.static_share_free * came) * likely;
  *stored_empty = empty * (one - L) / evidence;
  reinterpret_cast<Lanes*>(block.unknown)[group] = 0.5F * unknown / evidence;
}

/// The new belief, and its moments.
ATLAS_AVX2_CLONES
void settle(const VelocityLattice& lattice, int group, LatticeBlock& block) {
  const int side = lattice.side, standing = lattice.standing();
  const float* speeds = lattice.speeds.data();
  const Lanes zero{}, one = zero + 1.0F, tiny = zero + kTiny;
  const Lanes scale = block.scale_moving, add = block.add_moving;
  Lanes* belief = reinterpret_cast<Lanes*>(block.belief.data()) + group;
  Lanes* next = reinterpret_cast<Lanes*>(block.next.data());
  const Lanes stands = next[standing] * block.scale_standing + block.add_standing;
  for (int k = 0; k < side * side; ++k) belief[k * kGroups] = next[k] * scale + add;
  belief[standing * kGroups] = zero;
  Lanes sum{}, x{}, y{}, xx{}, xy{}, yy{}, edge{};
  for (int ky = 0; ky < side; ++ky) {
    Lanes row{}, row_x{}, row_xx{};
    const Lanes* of_row = belief + static_cast<std::ptrdiff_t>(ky) * side * kGroups;
    for (int kx = 0; kx < side; ++kx) {
      const Lanes J = of_row[kx * kGroups], flow = speeds[kx] * J;
      row += J;
      row_x += flow;
      row_xx += speeds[kx] * flow;
    }
    sum += row;
    x += row_x;
    xx += row_xx;
    y += speeds[ky] * row;
    yy += speeds[ky] * speeds[ky] * row;
    xy += speeds[ky] * row_x;
    edge += ky == 0 || ky == side - 1 ? row : of_row[0] + of_row[(side - 1) * kGroups];
  }
  belief[standing * kGroups] = stands;

  const auto out = [group](float* cells) { return reinterpret_cast<Lanes*>(cells) + group; };
  const Lanes per = sum > tiny ? one / sum : zero, occupied = sum + stands;
  const Lanes vx = per * x, vy = per * y, var_xx = per * xx - vx * vx, var_yy = per * yy - vy * vy;
  const Lanes probability = occupied + 0.5F * *out(block.unknown);
  *out(block.probability) = probability < one ? probability : one;
  *out(block.static_share) = occupied > tiny ? stands / occupied : zero;
  *out(block.moving) = sum;
  *out(block.saturation) = per * edge;
  *out(block.vx) = vx;
  *out(block.vy) = vy;
  *out(block.xx) = var_xx > zero ? var_xx : zero;
  *out(block.xy) = per * xy - vx * vy;
  *out(block.yy) = var_yy > zero ? var_yy : zero;
}

constexpr float kCounts = 65535.0F;

}  // namespace

void estimateLanes(const VelocityLattice& lattice, const LatticeRates& rates, int group,
                   LatticeBlock& block) {
  predict(lattice, rates, group, block);
  correct(rates, 1.0F / static_cast<float>(lattice.velocities() - 1), group, block);
  settle(lattice, group, block);
}

ATLAS_AVX2_CLONES
void fromCounts(const std::uint16_t* counts, int cells, float* probabilities) {
  for (int i = 0; i < cells; ++i) probabilities[i] = static_cast<float>(counts[i]) * (1.0F / kCounts);
}

ATLAS_AVX2_CLONES
void toCounts(const float* probabilities, int cells, std::uint16_t* counts) {
  for (int i = 0; i < cells; ++i)
    counts[i] = static_cast<std::uint16_t>(static_cast<std::int32_t>(probabilities[i] * kCounts + 0.5F));
}

}  // namespace atlas
