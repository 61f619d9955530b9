// SPDX-License-Identifier: MIT
// A list that grows without growing in memory: blocks that were not used for longest go to a SpillFile and
// come back when they are asked for. Made for passes over all elements in order, forwards or backwards.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "atlas/base/check.hpp"
#include "atlas/base/spill_file.hpp"

namespace atlas {

struct SpillParams {
  std::filesystem::path folder;           ///< of the temporary file; "" = everything stays in memory
  std::size_t memory_bytes = 16'000'000;  ///< of one list; a few blocks are the least
  static constexpr std::size_t kBlock_bytes = 256'000;
};

/// T: plain data, stored byte by byte. A reference is valid until an element of another block is asked for,
/// and that one's until the next but one: two neighbours can be held at a time. For one thread, also when it
/// only reads.
template <class T>
class SpilledList {
  static_assert(std::is_trivially_destructible_v<T>, "elements are stored byte by byte");

 public:
  explicit SpilledList(SpillParams params = {})
      : params_(std::move(params)),
        resident_most_(std::max<std::size_t>(3, params_.memory_bytes / sizeof(Elements))) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  T& append() {
    if (size_ % kPerBlock == 0) blocks_.emplace_back();
    return *::new (static_cast<void*>(&change(size_++))) T;  // as if it had never been another one
  }
  [[nodiscard]] const T& operator[](std::size_t i) const { return (*resident(i / kPerBlock))[i % kPerBlock]; }
  /// The same, to be changed.
  [[nodiscard]] T& change(std::size_t i) {
    Elements& elements = *resident(i / kPerBlock);
    blocks_[i / kPerBlock].changed = true;
    return elements[i % kPerBlock];
  }
  /// Forgets all elements and frees memory and file.
  void clear() {
    size_ = 0;
    blocks_.clear();
    order_.clear();
    file_.reset();
  }
  [[nodiscard]] bool spilled() const { return file_.has_value(); }

 private:
  static constexpr std::size_t kPerBlock = std::max<std::size_t>(1, SpillParams::kBlock_bytes / sizeof(T));
  using Elements = std::array<T, kPerBlock>;
  struct Slot {
    std::unique_ptr<Elements> elements;  ///< none: in the file
    bool changed = false;                ///< since it was written to the file
    bool in_file = false;
  };

  Elements* resident(std::size_t block) const {
    ATLAS_CHECK(block < blocks_.size(), "list: no such element");
    if (!order_.empty() && order_.back() == block) return blocks_[block].elements.get();
    const auto known = std::find(order_.begin(), order_.end(), block);
    if (known != order_.end()) {
      std::rotate(known, known + 1, order_.end());
    } else {
      load(block);
      order_.push_back(block);
    }
    return blocks_[block].elements.get();
  }
  void load(std::size_t block) const {
    Slot& slot = blocks_[block];
    if (!params_.folder.empty() && order_.size() >= resident_most_) {
      slot.elements = takeOldest();
    } else {
      slot.elements = std::make_unique<Elements>();
    }
    if (slot.in_file) file_->read(block * sizeof(Elements), slot.elements.get(), sizeof(Elements));
  }
  std::unique_ptr<Elements> takeOldest() const {
    Slot& oldest = blocks_[order_.front()];
    if (oldest.changed) {
      if (!file_) file_.emplace(params_.folder);
      file_->write(order_.front() * sizeof(Elements), oldest.elements.get(), sizeof(Elements));
      oldest.changed = false;
      oldest.in_file = true;
    }
    order_.erase(order_.begin());
    return std::move(oldest.elements);
  }

  SpillParams params_;
  std::size_t resident_most_;  ///< blocks
  std::size_t size_ = 0;
  // What is in memory and what in the file is no part of the list's value.
  mutable std::vector<Slot> blocks_;
  mutable std::vector<std::size_t> order_;  ///< of the blocks in memory: the one used last is at the end
  mutable std::optional<SpillFile> file_;
};

}  // namespace atlas
