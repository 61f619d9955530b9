// SPDX-License-Identifier: MIT
// When each point of a scan was measured and by which laser: BUD scans carry neither, so both are rebuilt.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "atlas/sensor/sensor.hpp"
#include "record/open_record.hpp"
#include "record/pcd.hpp"

namespace atlas::record {

struct SweepTiming {
  double duration_s = 0.1;  ///< of the revolution
  RecordOptions::ScanStamp stamp_marks = RecordOptions::ScanStamp::kEnd;
  bool rotating = true;  ///< an HDL-32E, whose layout is looked for; else linear in the file's order
};

/// How long revolutions take: the median of the intervals between scans, when that is 0.05 .. 0.2 s (20 .. 5
/// Hz, the range of the sensor), else the nominal 0.1 s.
double usualRevolution(std::vector<Duration> intervals);
/// The interval to the scan before, when it is one revolution (within 5 % of the usual one: a motor is that
/// steady, a system clock is not), else the usual one.
double revolutionDuration(std::optional<Duration> interval, double usual_s);

struct MadeSweep {
  Sweep sweep;
  std::string remark;  ///< what had to be assumed about time or ring; "" = nothing
};

/// The cloud as a sweep: (0, 0, 0) and what is not finite becomes NaN and stays in its place; time and ring
/// come from the file when it has them, else from the layout: column c of C has time = -duration * (1 - c /
/// C) before the stamp (end) or duration * c / C after it (start). Without a known layout time is linear in
/// the order of the file and ring 0.
MadeSweep makeSweep(PcdCloud cloud, Stamp stamp, const std::string& frame, const SweepTiming& timing);

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
