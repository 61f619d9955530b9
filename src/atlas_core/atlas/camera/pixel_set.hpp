// SPDX-License-Identifier: MIT
// Which pixels of an image hold something, one bit each: passes over a large image with few points take the
// time of the points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace atlas {

class PixelSet {
 public:
  PixelSet(int width, int height)
      : height_(height),
        words_((static_cast<std::size_t>(width) + 63) / 64),
        bits_(words_ * static_cast<std::size_t>(height), 0) {}

  void add(int row, int column) { word(row, column) |= bit(column); }
  void remove(int row, int column) { word(row, column) &= ~bit(column); }
  void add(const PixelSet& other) {
    for (std::size_t i = 0; i < bits_.size(); ++i) bits_[i] |= other.bits_[i];
  }
  void clear() { bits_.assign(bits_.size(), 0); }

  /// Calls visit(column) for those of a row, from left to right; it may change pixels at or left of column.
  template <class Visit>
  void forEachInRow(int row, Visit&& visit) const {
    const std::size_t first = static_cast<std::size_t>(row) * words_;
    for (std::size_t w = 0; w < words_; ++w) {
      for (std::uint64_t left = bits_[first + w]; left != 0; left &= left - 1)
        visit(static_cast<int>(64 * w) + __builtin_ctzll(left));
    }
  }
  /// The same for those whose neighbour above (side -1) or below (+1) holds nothing or is not in the image.
  template <class Visit>
  void forEachEndInRow(int row, int side, Visit&& visit) const {
    const int beside = row + side;
    const std::size_t first = static_cast<std::size_t>(row) * words_;
    const std::size_t other = static_cast<std::size_t>(beside) * words_;
    const bool inside = beside >= 0 && beside < height_;
    for (std::size_t w = 0; w < words_; ++w) {
      const std::uint64_t covered = inside ? bits_[other + w] : 0;
      for (std::uint64_t left = bits_[first + w] & ~covered; left != 0; left &= left - 1)
        visit(static_cast<int>(64 * w) + __builtin_ctzll(left));
    }
  }
  /// Calls visit(row, column), row by row.
  template <class Visit>
  void forEach(Visit&& visit) const {
    for (int row = 0; row < height_; ++row) forEachInRow(row, [&](int column) { visit(row, column); });
  }

 private:
  [[nodiscard]] static std::uint64_t bit(int column) {
    return std::uint64_t{1} << (static_cast<unsigned>(column) % 64U);
  }
  [[nodiscard]] std::uint64_t& word(int row, int column) {
    return bits_[static_cast<std::size_t>(row) * words_ + static_cast<std::size_t>(column) / 64];
  }

  int height_;
  std::size_t words_;  ///< a row
  std::vector<std::uint64_t> bits_;
};

}  // namespace atlas
