// SPDX-License-Identifier: MIT
#include "atlas/monitor/lidar_check.hpp"

#include <algorithm>

namespace atlas {
namespace {
constexpr int kScansToLearn = 10;
constexpr double kGain = 0.05;  // per scan, of the usual values
constexpr std::size_t kLeastBeams = 8;
constexpr double kDeadShare = 0.05;        // of the returns of the beams beside it
constexpr double kLeastNeighbours = 20.0;  // returns of a beam beside it in a second
constexpr double kLostShare = 0.2;         // of the usual returns of a sector
constexpr double kFreeShare = 0.3;         // of the median sector: one that the vehicle does not cover
constexpr int kPoorScans = 3;
constexpr double kSectorWidth_deg = 360.0 / static_cast<double>(kScanSectors);
}  // namespace

void LidarCheck::add(Stamp stamp, const ScanSummary& scan, Findings& findings) {
  findings.measure(Anomaly::kScanEmpty, stamp, scan.returns == 0 ? 1.0 : 0.0);
  if (scan.returns == 0) return;
  findings.measure(Anomaly::kScanFrozen, stamp, same_.add(stamp, scan.fingerprint));
  measureCount(stamp, scan, findings);
  measureBeams(stamp, scan, findings);
  measureSectors(stamp, scan, findings);
  scans_ = std::min(scans_ + 1, kScansToLearn);
}

void LidarCheck::measureCount(Stamp stamp, const ScanSummary& scan, Findings& findings) {
  const bool learning = scans_ < kScansToLearn;
  if (!learning) findings.measure(Anomaly::kFewPoints, stamp, scan.returns / usual_returns_);
  if (!learning && findings.has(Anomaly::kFewPoints)) return;  // it must not become usual
  usual_returns_ += (learning ? 1.0 / (scans_ + 1) : kGain) * (scan.returns - usual_returns_);
}

void LidarCheck::measureBeams(Stamp stamp, const ScanSummary& scan, Findings& findings) {
  if (rings_begin_ == kBeginOfTime) rings_begin_ = stamp;
  for (std::size_t r = 0; r < kScanRings; ++r) ring_sum_[r] += scan.by_ring[r];
  if (stamp - rings_begin_ < kSecond) return;
  rings_begin_ = stamp;
  std::array<std::uint32_t, kScanRings> sum{};
  std::swap(sum, ring_sum_);
  std::size_t beams = kScanRings;
  while (beams > 0 && sum[beams - 1] == 0) --beams;
  if (beams < kLeastBeams) return;
  int dead = 0;
  for (std::size_t r = 0; r < beams; ++r) {
    const std::size_t below = r == 0 ? 2 : r - 1, above = r + 1 < beams ? r + 1 : r - 2;
    const double beside = 0.5 * (static_cast<double>(sum[below]) + sum[above]);
    const bool known =
        std::find(dead_rings_.begin(), dead_rings_.end(), static_cast<int>(r)) != dead_rings_.end();
    if (!known && beside >= kLeastNeighbours && sum[r] < kDeadShare * beside) ++dead;
  }
  findings.measure(Anomaly::kDeadBeams, stamp, dead);
}

void LidarCheck::measureSectors(Stamp stamp, const ScanSummary& scan, Findings& findings) {
  const bool learning = scans_ < kScansToLearn;
  std::array<double, kScanSectors> sorted = usual_sector_;
  std::nth_element(sorted.begin(), sorted.begin() + kScanSectors / 2, sorted.end());
  const double free = kFreeShare * sorted[kScanSectors / 2];
  double blocked_deg = 0.0;
  for (std::size_t s = 0; s < kScanSectors; ++s) {
    const double returns = scan.by_sector[s];
    const bool poor = !learning && usual_sector_[s] >= free && returns < kLostShare * usual_sector_[s];
    poor_scans_[s] = poor ? poor_scans_[s] + 1 : 0;
    if (poor_scans_[s] >= kPoorScans) blocked_deg += kSectorWidth_deg;
    if (!poor)  // a blockage must not become usual
      usual_sector_[s] += (learning ? 1.0 / (scans_ + 1) : kGain) * (returns - usual_sector_[s]);
  }
  if (!learning) findings.measure(Anomaly::kBlocked, stamp, blocked_deg);
}

}  // namespace atlas
