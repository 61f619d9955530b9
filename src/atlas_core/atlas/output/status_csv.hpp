// SPDX-License-Identifier: MIT
// Sensor status as CSV: stamp_ns,sensor,score,anomalies - anomalies as name=value (in the unit of the table
// in the README of atlas_loader), with ; between them.
#pragma once

#include <string>

#include "atlas/sensor/products.hpp"

namespace atlas {

std::string statusCsvHeader();
std::string statusCsvRow(const SensorStatus& status);

}  // namespace atlas
