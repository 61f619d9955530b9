// SPDX-License-Identifier: MIT
// For tests of the sensor monitor: when an anomaly began, and how long after the fault that was.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "atlas/monitor/findings.hpp"

namespace atlas::test {

constexpr Stamp kStart = 1'600'000'000 * kSecond;
inline Stamp at(double time_s) { return kStart + fromSeconds(time_s); }

/// When the anomaly that is there began, s after kStart; nullopt without it.
inline std::optional<double> beganAt(const Findings& findings, Anomaly anomaly) {
  for (const SensorAnomaly& a : findings.list()) {
    if (a.name == infoOf(anomaly).name && findings.has(anomaly)) return toSeconds(a.since - kStart);
  }
  return std::nullopt;
}

/// The anomaly is there, and began no later than `within_s` after the fault at `fault_s`.
inline void expectSeen(const Findings& findings, Anomaly anomaly, double fault_s, double within_s) {
  const auto began = beganAt(findings, anomaly);
  ASSERT_TRUE(began) << infoOf(anomaly).parameter << " was not seen";
  constexpr double kRounding_s = 1e-6;
  EXPECT_GE(*began, fault_s - kRounding_s) << infoOf(anomaly).parameter;
  EXPECT_LE(*began, fault_s + within_s + kRounding_s) << infoOf(anomaly).parameter;
}

inline void expectClean(const Findings& findings) {
  for (const SensorAnomaly& a : findings.list())
    ADD_FAILURE() << a.name << " " << a.value << " " << a.unit << " at " << toSeconds(a.since - kStart)
                  << " s";
  for (std::size_t i = 0; i < kAnomalies; ++i)
    EXPECT_EQ(findings.begun()[i], 0U) << infoOf(static_cast<Anomaly>(i)).parameter;
}

}  // namespace atlas::test
