// SPDX-License-Identifier: MIT
// Voxels numbered in the order in which they are first met. The numbers, not the hash table, are what results
// are made from: no result depends on a hash function. Open addressing with linear probing at a load of at
// most one half.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace atlas {

struct VoxelKey {
  std::int32_t x = 0, y = 0, z = 0;
  bool operator==(const VoxelKey& o) const { return x == o.x && y == o.y && z == o.z; }
};

class VoxelIndex {
 public:
  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

  explicit VoxelIndex(std::size_t expected = 0) { rehash(expected); }

  /// The number of the voxel; a new one gets the next number, starting at 0.
  std::uint32_t insert(const VoxelKey& key) {
    if (2 * (keys_.size() + 1) > slots_.size()) rehash(2 * keys_.size());
    std::uint32_t& slot = slots_[slotOf(key)];
    if (slot == kNone) {
      slot = static_cast<std::uint32_t>(keys_.size());
      keys_.push_back(key);
    }
    return slot;
  }
  /// Starts to fetch what insert() or find() of this voxel will look at: worth it some dozen voxels ahead.
  void expect(const VoxelKey& key) const { __builtin_prefetch(&slots_[firstSlotOf(key)]); }
  /// kNone when the voxel was never inserted.
  [[nodiscard]] std::uint32_t find(const VoxelKey& key) const { return slots_[slotOf(key)]; }
  /// By number.
  [[nodiscard]] const std::vector<VoxelKey>& keys() const { return keys_; }
  [[nodiscard]] std::size_t size() const { return keys_.size(); }

 private:
  [[nodiscard]] static std::uint64_t hashOf(const VoxelKey& key) {
    // multiplication by odd constants and folding of the high half: neighbours spread over the table
    std::uint64_t h = static_cast<std::uint32_t>(key.x) * 0x9E3779B97F4A7C15ULL;
    h ^= static_cast<std::uint32_t>(key.y) * 0xC2B2AE3D27D4EB4FULL;
    h ^= static_cast<std::uint32_t>(key.z) * 0x165667B19E3779F9ULL;
    return (h ^ (h >> 32)) * 0xD6E8FEB86659FD93ULL;
  }
  [[nodiscard]] std::size_t firstSlotOf(const VoxelKey& key) const {
    return static_cast<std::size_t>(hashOf(key) >> 32) & mask_;
  }
  [[nodiscard]] std::size_t slotOf(const VoxelKey& key) const {
    std::size_t slot = firstSlotOf(key);
    while (slots_[slot] != kNone && !(keys_[slots_[slot]] == key)) slot = (slot + 1) & mask_;
    return slot;
  }
  void rehash(std::size_t expected) {
    std::size_t slots = 64;
    while (slots < 2 * (expected + 1)) slots *= 2;
    slots_.assign(slots, kNone);
    mask_ = slots - 1;
    for (std::size_t i = 0; i < keys_.size(); ++i) slots_[slotOf(keys_[i])] = static_cast<std::uint32_t>(i);
  }

  std::vector<VoxelKey> keys_;
  std::vector<std::uint32_t> slots_;
  std::size_t mask_ = 0;
};

/// The same for a large index and many points that fall on the same voxels again soon: remembers where some
/// of the last ones are, as every look into the large table waits for memory.
class CachedVoxelIndex {
 public:
  explicit CachedVoxelIndex(std::size_t expected = 0) : index_(expected), recent_(kRecent) {}

  std::uint32_t insert(const VoxelKey& key) {
    Recent& recent = recent_[placeOf(key)];
    if (recent.number == VoxelIndex::kNone || !(recent.key == key)) recent = {key, index_.insert(key)};
    return recent.number;
  }
  void expect(const VoxelKey& key) const {
    const Recent& recent = recent_[placeOf(key)];
    if (recent.number == VoxelIndex::kNone || !(recent.key == key)) index_.expect(key);
  }
  [[nodiscard]] const std::vector<VoxelKey>& keys() const { return index_.keys(); }
  [[nodiscard]] std::size_t size() const { return index_.size(); }

 private:
  static constexpr std::size_t kRecent = 2048;  ///< 32 kB
  struct Recent {
    VoxelKey key;
    std::uint32_t number = VoxelIndex::kNone;
  };
  /// Neighbours do not replace each other.
  static std::size_t placeOf(const VoxelKey& key) {
    const auto x = static_cast<std::uint32_t>(key.x), y = static_cast<std::uint32_t>(key.y),
               z = static_cast<std::uint32_t>(key.z);
    return (x + 37 * y + 1031 * z) % kRecent;
  }

  VoxelIndex index_;
  std::vector<Recent> recent_;
};

}  // namespace atlas
