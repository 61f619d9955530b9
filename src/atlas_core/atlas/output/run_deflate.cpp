// SPDX-License-Identifier: MIT
#include "atlas/output/run_deflate.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace atlas {
namespace {

constexpr std::size_t kBlock_bytes = 1U << 17U;  // one set of codes (0.15 KB) for so much data
constexpr std::size_t kLiterals = 256, kShortestRun = 3, kLongestRun = 258;
constexpr std::size_t kEndOfBlock = 256, kFirstLength = 257;  // symbols of RFC 1951, 3.2.5
constexpr std::size_t kSymbols = 286;
constexpr unsigned kLongestCode = 15;

/// What a block is made of: 0..255 a literal, 256 + n a repetition of the byte before it, n + 3 times.
using Token = std::uint16_t;
constexpr std::size_t kTokens = kLiterals + kLongestRun - kShortestRun + 1;

struct Bits {
  std::uint32_t value = 0;
  unsigned count = 0;
};

/// Symbol and extra bits of a run's length.
struct Length {
  std::size_t symbol;
  Bits extra;
};
Length lengthOf(std::size_t run) {
  if (run == kLongestRun) return {kSymbols - 1, {}};
  std::size_t first = kShortestRun, symbol = kFirstLength;
  for (unsigned extra = 0;; ++extra) {  // 8 symbols without extra bits, then 4 for each number of them
    const std::size_t symbols = extra == 0 ? 8 : 4;
    if (run < first + (symbols << extra)) {
      const std::size_t offset = run - first;
      const std::uint32_t rest = static_cast<std::uint32_t>(offset) & ((1U << extra) - 1U);
      return {symbol + (offset >> extra), {rest, extra}};
    }
    first += symbols << extra;
    symbol += symbols;
  }
}

std::vector<Token> tokensOf(const std::uint8_t* data, std::size_t size) {
  std::vector<Token> tokens(size);
  Token* to = tokens.data();
  std::size_t i = 0;
  while (i < size) {
    const std::uint8_t byte = data[i];
    *to++ = byte;
    ++i;
    if (i + kShortestRun > size) continue;
    std::uint32_t four = 0;
    std::memcpy(&four, data + i - 1, sizeof four);
    if (four != byte * 0x01010101U) continue;
    std::size_t end = i + kShortestRun;
    while (end < size && data[end] == byte) ++end;
    while (end - i >= kShortestRun) {
      const std::size_t run = std::min(end - i, kLongestRun);
      *to++ = static_cast<Token>(kLiterals + run - kShortestRun);
      i += run;
    }
  }
  tokens.resize(static_cast<std::size_t>(to - tokens.data()));
  return tokens;
}

/// Lengths of Huffman's codes, 0 for what does not occur; at least two symbols must.
std::array<unsigned, kSymbols> codeLengths(std::array<std::uint32_t, kSymbols> counts) {
  struct Node {
    std::uint32_t count;
    std::size_t parent;
  };
  while (true) {
    std::vector<std::size_t> symbols;
    for (std::size_t s = 0; s < kSymbols; ++s) {
      if (counts[s] > 0) symbols.push_back(s);
    }
    std::stable_sort(symbols.begin(), symbols.end(), [&](auto a, auto b) { return counts[a] < counts[b]; });
    std::vector<Node> nodes;  // leaves, then inner nodes, each part in order of counts
    for (const std::size_t s : symbols) nodes.push_back({counts[s], 0});
    std::size_t leaf = 0, inner = symbols.size();
    const auto smallest = [&] {
      const bool take_leaf =
          leaf < symbols.size() && (inner == nodes.size() || nodes[leaf].count <= nodes[inner].count);
      return take_leaf ? leaf++ : inner++;
    };
    for (std::size_t joined = 1; joined < symbols.size(); ++joined) {
      const std::size_t a = smallest(), b = smallest();
      nodes[a].parent = nodes[b].parent = nodes.size();
      nodes.push_back({nodes[a].count + nodes[b].count, 0});
    }
    std::vector<unsigned> depth(nodes.size(), 0);
    for (std::size_t n = nodes.size() - 1; n-- > 0;) depth[n] = depth[nodes[n].parent] + 1;
    if (*std::max_element(depth.begin(), depth.end()) <= kLongestCode) {
      std::array<unsigned, kSymbols> lengths{};
      for (std::size_t l = 0; l < symbols.size(); ++l) lengths[symbols[l]] = depth[l];
      return lengths;
    }
    for (std::uint32_t& count : counts) count = (count + 1) / 2;  // less uneven, so less deep
  }
}

/// The codes of RFC 1951, 3.2.2, their first bit lowest.
std::array<Bits, kSymbols> codesOf(const std::array<unsigned, kSymbols>& lengths) {
  std::array<Bits, kSymbols> codes;
  std::uint32_t next = 0;
  for (unsigned length = 1; length <= kLongestCode; ++length) {
    for (std::size_t s = 0; s < kSymbols; ++s) {
      if (lengths[s] != length) continue;
      codes[s].count = length;
      for (unsigned bit = 0; bit < length; ++bit) codes[s].value |= (next >> bit & 1U) << (length - 1 - bit);
      ++next;
    }
    next <<= 1U;
  }
  return codes;
}

/// Bits into bytes, the lowest first.
class BitStream {
 public:
  void reserve(std::size_t bytes) { bytes_.resize(size_ + bytes + sizeof held_); }
  /// At most 32 bits; their place must be reserved.
  void put(Bits bits) {
    held_ |= static_cast<std::uint64_t>(bits.value) << count_;
    count_ += bits.count;
    if (count_ < 32) return;
    putByte(0), putByte(8), putByte(16), putByte(24);
    held_ >>= 32U;
    count_ -= 32;
  }
  std::vector<std::uint8_t> take() {
    for (unsigned shift = 0; shift < count_; shift += 8) putByte(shift);
    bytes_.resize(size_);
    return std::move(bytes_);
  }

 private:
  void putByte(unsigned shift) { bytes_[size_++] = static_cast<std::uint8_t>(held_ >> shift); }

  std::vector<std::uint8_t> bytes_;
  std::size_t size_ = 0;
  std::uint64_t held_ = 0;
  unsigned count_ = 0;  ///< of held_
};

/// RFC 1951, 3.2.7. The code lengths have codes themselves: those of 0 to 15 take 4 bits each.
void putCodes(BitStream& stream, const std::array<unsigned, kSymbols>& lengths, bool last) {
  stream.put({last ? 1U : 0U, 1});
  stream.put({2, 2});  // codes of its own
  stream.put({kSymbols - 257, 5});
  stream.put({0, 5});  // one distance
  stream.put({19 - 4, 4});
  for (int symbol = 0; symbol < 19; ++symbol)
    stream.put({symbol < 3 ? 0U : 4U, 3});  // 16, 17, 18, then 0 to 15
  const auto put = [&stream](unsigned length) {
    const unsigned reversed =
        (length & 1U) << 3U | (length & 2U) << 1U | (length & 4U) >> 1U | (length & 8U) >> 3U;
    stream.put({reversed, 4});
  };
  for (const unsigned length : lengths) put(length);
  put(1);  // of the distance
}

void putBlock(BitStream& stream, const std::vector<Token>& tokens, bool last) {
  std::array<std::uint32_t, kTokens> seen{};
  for (const Token token : tokens) ++seen[token];
  std::array<std::uint32_t, kSymbols> counts{};
  std::copy(seen.begin(), seen.begin() + kLiterals, counts.begin());
  counts[0] = std::max(counts[0], 1U);  // a code needs two symbols
  counts[kEndOfBlock] = 1;
  std::array<Length, kTokens - kLiterals> runs{};
  for (std::size_t r = 0; r < runs.size(); ++r) {
    runs[r] = lengthOf(r + kShortestRun);
    counts[runs[r].symbol] += seen[kLiterals + r];
  }
  const auto lengths = codeLengths(counts);
  const auto codes = codesOf(lengths);
  std::array<Bits, kTokens> bits{};
  std::copy(codes.begin(), codes.begin() + kLiterals, bits.begin());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Bits code = codes[runs[r].symbol], extra = runs[r].extra;
    bits[kLiterals + r] = {code.value | extra.value << code.count,
                           code.count + extra.count + 1};  // distance: 0
  }
  constexpr std::size_t kCodes_bytes = 256, kToken_bytes = 3;  // at most 15 + 5 + 1 bits
  stream.reserve(kCodes_bytes + kToken_bytes * tokens.size());
  putCodes(stream, lengths, last);
  for (const Token token : tokens) stream.put(bits[token]);
  stream.put(codes[kEndOfBlock]);
}

}  // namespace

std::vector<std::uint8_t> runDeflate(const std::vector<std::uint8_t>& data) {
  BitStream stream;
  stream.reserve(2);
  stream.put({0x0178, 16});  // deflate, window of 32 KB, fastest
  std::size_t begin = 0;
  do {
    const std::size_t size = std::min(kBlock_bytes, data.size() - begin);
    putBlock(stream, tokensOf(data.data() + begin, size), begin + size == data.size());
    begin += size;
  } while (begin < data.size());
  std::vector<std::uint8_t> bytes = stream.take();
  const auto check = static_cast<std::uint32_t>(adler32_z(1, data.data(), data.size()));
  for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(check >> shift));
  return bytes;
}

}  // namespace atlas
