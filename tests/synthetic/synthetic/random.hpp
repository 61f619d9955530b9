// SPDX-License-Identifier: MIT
// Random numbers that are the same on every machine: std::mt19937_64 is specified bit by bit, the
// distributions of the standard library are not, so they are written out here. Each stream has its own
// generator, made from (seed, name), so that switching one sensor off leaves the noise of the others as it
// was.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string_view>

namespace atlas::synthetic {

class Random {
 public:
  Random(std::uint64_t seed, std::string_view stream) : engine_(mix(seed, stream)) {}

  /// In [0, 1).
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// In [0, n).
  int integer(int n) { return static_cast<int>(uniform() * n); }
  bool chance(double probability) { return uniform() < probability; }
  /// Standard normal (Box and Muller 1958), both values of a pair are used.
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    const double angle = 2.0 * M_PI * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

 private:
  static std::uint64_t mix(std::uint64_t seed,
                           std::string_view stream) {  // FNV-1a over the name, then the seed
    std::uint64_t hash = 14695981039346656037ULL;
    for (const char c : stream) hash = (hash ^ static_cast<std::uint8_t>(c)) * 1099511628211ULL;
    return hash ^ (seed * 0x9E3779B97F4A7C15ULL);
  }
  std::mt19937_64 engine_;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// First-order Gauss-Markov process of standard deviation sigma and correlation time tau (Gelb 1974,
/// section 3.8).
class GaussMarkov {
 public:
  GaussMarkov(double sigma, double tau_s, Random& random)
      : sigma_(sigma), tau_s_(tau_s), value_(sigma * random.normal()) {}
  double step(double dt_s, Random& random) {
    const double keep = std::exp(-dt_s / tau_s_);
    value_ = keep * value_ + sigma_ * std::sqrt(1.0 - keep * keep) * random.normal();
    return value_;
  }
  [[nodiscard]] double value() const { return value_; }

 private:
  double sigma_, tau_s_, value_;
};

}  // namespace atlas::synthetic
