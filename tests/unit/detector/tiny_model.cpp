// SPDX-License-Identifier: MIT
#include "tiny_model.hpp"

#include <cstdint>
#include <cstring>
#include <vector>

namespace atlas {
namespace {

// Protocol buffers: a field is a key (number x 8 + kind) and a number or a length with bytes.
std::string varint(std::uint64_t value) {
  std::string bytes;
  while (value >= 0x80) {
    bytes.push_back(static_cast<char>((value & 0x7FU) | 0x80U));
    value >>= 7U;
  }
  bytes.push_back(static_cast<char>(value));
  return bytes;
}
std::string field(unsigned number, std::uint64_t value) { return varint(number * 8) + varint(value); }
std::string field(unsigned number, const std::string& bytes) {
  return varint(number * 8 + 2) + varint(bytes.size()) + bytes;
}

template <class T>
std::string tensor(const std::string& name, const std::vector<int>& shape, const std::vector<T>& values,
                   int type) {
  std::string bytes, raw(values.size() * sizeof(T), '\0');
  std::memcpy(raw.data(), values.data(), raw.size());
  for (const int size : shape) bytes += field(1, static_cast<std::uint64_t>(size));
  return bytes + field(2, static_cast<std::uint64_t>(type)) + field(8, name) + field(9, raw);
}
std::string floats(const std::string& name, const std::vector<int>& shape, const std::vector<float>& values) {
  return tensor(name, shape, values, 1);
}
std::string ints(const std::string& name, const std::vector<std::uint64_t>& values) {
  std::string bytes = field(1, name);
  for (const std::uint64_t value : values) bytes += field(8, value);
  return field(5, bytes + field(20, 7));
}
std::string node(const std::string& type, const std::vector<std::string>& inputs, const std::string& output,
                 const std::string& attributes = "") {
  std::string bytes;
  for (const std::string& input : inputs) bytes += field(1, input);
  return field(1, bytes + field(2, output) + field(3, output) + field(4, type) + attributes);
}
std::string value(const std::string& name, const std::vector<int>& shape) {
  std::string dims;
  for (const int size : shape) dims += field(1, field(1, static_cast<std::uint64_t>(size)));
  return field(1, name) + field(2, field(1, field(1, 1) + field(2, dims)));
}

constexpr int kCell = 8, kCells = 16;

/// Centre, size and, for v5, objectness of every cell; scores 0.
std::vector<float> boxes(Layout layout, int fields) {
  std::vector<float> values(static_cast<std::size_t>(fields) * kCells, 0.0F);
  for (int cell = 0; cell < kCells; ++cell) {
    const std::vector<float> box = {static_cast<float>(kCell * (cell % 4)) + 4.0F,
                                    static_cast<float>(kCell * (cell / 4)) + 4.0F, 8.0F, 8.0F, 1.0F};
    const int known = layout == Layout::kV5 ? 5 : 4;
    for (int f = 0; f < known; ++f) {
      const int at = layout == Layout::kV5 ? cell * fields + f : f * kCells + cell;
      values[static_cast<std::size_t>(at)] = box[static_cast<std::size_t>(f)];
    }
  }
  return values;
}

/// Channel: mean of `plus` minus mean of green.
std::vector<float> weights(int fields) {
  constexpr int kPlane = kCell * kCell;
  std::vector<float> values(static_cast<std::size_t>(fields) * 3 * kPlane, 0.0F);
  for (int score = 0; score < 2; ++score) {
    const int channel = fields - 2 + score, plus = score == 0 ? 0 : 2;
    for (int i = 0; i < kPlane; ++i) {
      values[static_cast<std::size_t>((channel * 3 + plus) * kPlane + i)] = 1.0F / kPlane;
      values[static_cast<std::size_t>((channel * 3 + 1) * kPlane + i)] = -1.0F / kPlane;
    }
  }
  return values;
}

}  // namespace

std::string tinyModel(Layout layout) {
  const bool v5 = layout == Layout::kV5;
  const int fields = v5 ? 7 : 6;
  const std::vector<int> shape =
      v5 ? std::vector<int>{1, kCells, fields} : std::vector<int>{1, fields, kCells};
  std::string graph =
      node("Conv", {"images", "weights"}, "cells", ints("kernel_shape", {8, 8}) + ints("strides", {8, 8}));
  graph += node("Reshape", {"cells", "table_shape"}, "table");
  if (v5) graph += node("Transpose", {"table"}, "rows", ints("perm", {0, 2, 1}));
  graph += node("Add", {v5 ? "rows" : "table", "boxes"}, "output0");
  graph += field(2, std::string("tiny"));
  graph += field(5, floats("weights", {fields, 3, kCell, kCell}, weights(fields)));
  graph += field(5, tensor("table_shape", {3}, std::vector<std::int64_t>{1, fields, kCells}, 7));
  graph += field(5, floats("boxes", shape, boxes(layout, fields)));
  graph += field(11, value("images", {1, 3, kTinySide, kTinySide}));
  graph += field(12, value("output0", shape));
  return field(1, 7) + field(8, field(2, 11)) + field(7, graph);
}

}  // namespace atlas
