// SPDX-License-Identifier: MIT
// The error-state filter takes IMU samples and fixes without the heap: what it needs it has from the start.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "stage_run.hpp"

namespace {
std::atomic<bool> counting{false};
std::atomic<int> allocations{0};

void* allocate(std::size_t size) {
  if (counting) ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t size) { return allocate(size); }
void* operator new[](std::size_t size) { return allocate(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace atlas::test {
namespace {

TEST(EskfAllocation, NonePerSample) {
  std::mt19937 random(1);
  const DriveParams d = cityDrive(40.0);
  const Recording recording = record(drive(d), d, realisticErrors(random), random);
  Counters counters;
  const auto filter = makePositioningFilter("eskf", {}, d.lever_arm_imu, kBrno, counters);
  const LocalEnu map(kBrno);
  std::size_t fix = 0, heading = 0;
  int poses = 0;
  for (const ImuSample& sample : recording.imu) {
    counting = toSeconds(sample.stamp - recording.imu.front().stamp) >
               12.0;  // it stood and drove: every counter is there
    for (; fix < recording.fixes.size() && recording.fixes[fix].stamp <= sample.stamp; ++fix)
      filter->update(recording.fixes[fix].stamp, map.toMap(recording.fixes[fix].position),
                     4e-4 * Eigen::Matrix3d::Identity());
    for (; heading < recording.headings.size() && recording.headings[heading].stamp <= sample.stamp;
         ++heading)
      filter->updateHeading(recording.headings[heading].stamp, recording.headings[heading].yaw_rad, 3e-3);
    if (filter->propagate(sample) && counting) ++poses;
  }
  counting = false;
  EXPECT_GT(poses, 2000);
  EXPECT_GT(counters.get("fix used"), 100u);
  EXPECT_EQ(allocations, 0);
}

}  // namespace
}  // namespace atlas::test
