// SPDX-License-Identifier: MIT
// A model in ONNX format, written byte by byte: it finds red and blue squares. Input 1 x 3 x 32 x 32, RGB;
// each cell of 8 x 8 px is a box of that size, whose scores are the means of red - green (class 0) and of
// blue - green (class 1).
#pragma once

#include <string>

namespace atlas {

constexpr int kTinySide = 32;  // px
enum class Layout { kV5, kV8 };
/// Bytes of the file. v5: 1 x 16 x 7, objectness 1; v8: 1 x 6 x 16.
std::string tinyModel(Layout layout);

}  // namespace atlas
