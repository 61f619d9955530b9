// SPDX-License-Identifier: MIT
// When each point of a scan was measured and by which laser: BUD scans carry neither, so both are rebuilt.
#pragma once

#include <optional>
#include <string>

#include "atlas/sensor/sensor.hpp"
#include "record/open_record.hpp"
#include "record/pcd.hpp"

namespace atlas::record {

/// Velodyne HDL-32E: lasers fire together in columns of 32.
constexpr std::size_t kLasersHdl32 = 32;

struct SweepTiming {
  double duration_s = 0.1;  ///< of the revolution
  RecordOptions::ScanStamp stamp_marks = RecordOptions::ScanStamp::kEnd;
  bool rotating = true;  ///< HDL-32E order when the size is a multiple of 32; else linear in the file's order
};

/// The interval to the scan before, when it is one revolution (0.05 .. 0.2 s, nominal 0.1 s), else 0.1 s.
double revolutionDuration(std::optional<Duration> interval);

/// The cloud as a sweep: (0, 0, 0) becomes NaN and stays in its place; time and ring come from the file when
/// it has them, else column c of C has time = -duration * (1 - c / C) before the stamp (end) or duration * c
/// / C after it (start).
Sweep makeSweep(PcdCloud cloud, Stamp stamp, const std::string& frame, const SweepTiming& timing);

/// Inner clock of a BUD Velodyne: high 32 bits Unix seconds, low 32 bits microseconds since the hour. Around
/// second boundaries the two are sometimes off by 1 s against each other; `system` (stamp of the same packet)
/// decides.
struct InnerTime {
  Stamp time = 0;
  bool repaired = false;
};
/// nullopt when it is not within 2 s of `system`.
std::optional<InnerTime> decodeInnerTime(std::uint64_t inner, Stamp system);

}  // namespace atlas::record
