// SPDX-License-Identifier: MIT
// Numbers as people read them, independent of the locale.
#pragma once

#include <cstdint>
#include <string>

namespace atlas::report {

/// 1234567 -> "1 234 567".
std::string countText(std::uint64_t count);
/// Four significant digits, never an exponent within 1e-4 .. 1e7; "n/a" for what is not finite.
std::string valueText(double value);
/// "horizontal_rms_m" -> {"horizontal rms", "m"}: the unit suffix of the house style taken apart from the
/// name.
struct NameAndUnit {
  std::string name, unit;
};
NameAndUnit splitUnit(const std::string& key);

}  // namespace atlas::report
