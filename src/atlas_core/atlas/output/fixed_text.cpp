// SPDX-License-Identifier: MIT
#include "atlas/output/fixed_text.hpp"

#include <cmath>
#include <locale>
#include <sstream>

namespace atlas {

std::string fixedText(double value, int decimals) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text.setf(std::ios::fixed);
  text.precision(decimals);
  text << value;
  return text.str();
}

}  // namespace atlas
