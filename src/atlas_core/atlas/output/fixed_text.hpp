// SPDX-License-Identifier: MIT
// Numbers for text files: always a decimal point and a given count of decimals, whatever the process locale
// is.
#pragma once

#include <string>

namespace atlas {

/// "1.500" for (1.5, 3); "nan", "inf", "-inf" for what is not finite.
std::string fixedText(double value, int decimals);

}  // namespace atlas
