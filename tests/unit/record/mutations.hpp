// SPDX-License-Identifier: MIT
// Damage to a file, chosen by a seed: the same seed gives the same bytes on every machine.
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace atlas::test {

class Mutations {
 public:
  explicit Mutations(std::uint32_t seed) : random_(seed) {}

  /// 0 .. bound - 1. (std::uniform_int_distribution differs between libraries.)
  std::size_t below(std::size_t bound) { return bound == 0 ? 0 : random_() % bound; }

  /// One to four changes: bytes flipped, cut off, repeated, swapped, or replaced by what parsers trip over.
  std::string spoil(std::string bytes) {
    const std::size_t changes = 1 + below(4);
    for (std::size_t i = 0; i < changes; ++i) spoilOnce(bytes);
    return bytes;
  }

 private:
  void spoilOnce(std::string& bytes) {
    if (bytes.empty()) bytes = "\r\n";
    const std::size_t at = below(bytes.size());
    const std::size_t length = 1 + below(std::min<std::size_t>(64, bytes.size() - at));
    switch (below(8)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        bytes.resize(at);
        break;
      case 2:
        bytes.insert(at, bytes.substr(below(bytes.size()), length));
        break;
      case 3:
        bytes.erase(at, length);
        break;
      case 4:
        for (std::size_t i = 0; i < length; ++i) bytes[at + i] = static_cast<char>(below(256));
        break;
      case 5:
        bytes.insert(at, odd());
        break;
      case 6:
        bytes.replace(at, length, odd());
        break;
      default:
        std::swap(bytes[at], bytes[below(bytes.size())]);
    }
  }

  const char* odd() {
    static constexpr const char* kOdd[] = {"nan",  "-1",   "1e999", "99999999999999999999",
                                           "\n\n", "\r",   ",,,,",  "\"",
                                           "-inf", "0x1p", "\xff",  "1e-320",
                                           "[[",   "{",    ":",     "&a *a",
                                           "0",    "-0",   "\t",    "4294967296",
                                           "..",   "#",    "!!",    "- -"};
    return kOdd[below(std::size(kOdd))];
  }

  std::mt19937 random_;
};

}  // namespace atlas::test
