// SPDX-License-Identifier: MIT
#include "report/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

namespace atlas::report {

std::string countText(std::uint64_t count) {
  std::string digits = std::to_string(count);
  for (int at = static_cast<int>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), " ");
  return digits;
}

std::string valueText(double value) {
  if (!std::isfinite(value)) return "n/a";
  const double magnitude = std::abs(value);
  char text[64];
  if (magnitude != 0 && (magnitude < 1e-4 || magnitude >= 1e7)) {
    std::snprintf(text, sizeof text, "%.3e", value);
    return text;
  }
  const int exponent = magnitude == 0 ? 0 : static_cast<int>(std::floor(std::log10(magnitude)));
  std::snprintf(text, sizeof text, "%.*f", std::clamp(3 - exponent, 0, 7), value);
  std::string result = text;
  if (result.find('.') != std::string::npos) {
    result.erase(result.find_last_not_of('0') + 1);
    if (result.back() == '.') result.pop_back();
  }
  return result;
}

NameAndUnit splitUnit(const std::string& key) {
  static const std::map<std::string, std::string> kUnits{
      {"m", "m"},       {"s", "s"},     {"ms", "ms"},     {"ns", "ns"}, {"hz", "Hz"},      {"rad", "rad"},
      {"deg", "deg"},   {"mps", "m/s"}, {"mps2", "m/s²"}, {"px", "px"}, {"mb", "MB"},      {"degc", "°C"},
      {"percent", "%"}, {"mm", "mm"},   {"cm", "cm"},     {"m2", "m²"}, {"radps", "rad/s"}};
  NameAndUnit result{key, ""};
  const std::size_t cut = key.rfind('_');
  if (cut != std::string::npos && cut > 0) {
    const auto unit = kUnits.find(key.substr(cut + 1));
    if (unit != kUnits.end()) result = {key.substr(0, cut), unit->second};
  }
  std::replace(result.name.begin(), result.name.end(), '_', ' ');
  return result;
}

}  // namespace atlas::report
