// SPDX-License-Identifier: MIT
#include "atlas/output/run_deflate.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <random>
#include <string>

namespace atlas {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// What zlib makes of it; one byte more than expected if it is longer.
Bytes inflated(const Bytes& stream, std::size_t expected) {
  Bytes bytes(expected + 1);
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(bytes.data(), &size, stream.data(), stream.size()), Z_OK);
  bytes.resize(size);
  return bytes;
}
void expectBack(const Bytes& data, const std::string& what) {
  EXPECT_EQ(inflated(runDeflate(data), data.size()), data) << what;
}

TEST(RunDeflate, RunsOfAnyLength) {
  Bytes data;
  for (std::size_t run = 1; run < 800; ++run)
    data.insert(data.end(), run, static_cast<std::uint8_t>(run % 3));
  expectBack(data, "1 to 799");
  expectBack(Bytes(1'000'000, 7), "one byte, many blocks");
}

TEST(RunDeflate, NoiseAndShortInputs) {
  std::mt19937 random(5);
  for (const std::size_t size : {0, 1, 2, 3, 4, 5, 255, 131'071, 131'072, 131'073, 300'000}) {
    for (const unsigned values : {1, 2, 5, 256}) {
      Bytes data(size);
      for (auto& byte : data) byte = static_cast<std::uint8_t>(random() % values);
      expectBack(data, std::to_string(size) + " bytes of " + std::to_string(values) + " values");
    }
  }
}

// Counts that grow like Fibonacci's numbers make Huffman's codes as long as possible; deflate allows 15 bits.
TEST(RunDeflate, CodesThatWouldBeTooLong) {
  Bytes data;
  std::size_t count = 1, before = 1;
  for (int value = 0; value < 22; ++value) {
    for (std::size_t i = 0; i < count; ++i) data.push_back(static_cast<std::uint8_t>(2 * value));
    const std::size_t next = count + before;
    before = count;
    count = next;
  }
  data.resize(131'072);
  std::shuffle(data.begin(), data.end(), std::mt19937(1));
  expectBack(data, "counts from 1 to 28657 and one larger");
}

TEST(RunDeflate, NearlyAsSmallAsZlibsOwnRuns) {
  std::mt19937 random(3);
  Bytes data(500'000);
  std::uint8_t value = 0;
  for (auto& byte : data) {
    if (random() % 4 == 0) value = static_cast<std::uint8_t>(random() % 16 * (random() % 16));
    byte = value;
  }
  Bytes zlibs(compressBound(data.size()));
  z_stream z{};
  ASSERT_EQ(deflateInit2(&z, 1, Z_DEFLATED, 15, 8, Z_RLE), Z_OK);
  z.next_in = data.data();
  z.avail_in = static_cast<uInt>(data.size());
  z.next_out = zlibs.data();
  z.avail_out = static_cast<uInt>(zlibs.size());
  ASSERT_EQ(deflate(&z, Z_FINISH), Z_STREAM_END);
  EXPECT_LT(static_cast<double>(runDeflate(data).size()), 1.01 * static_cast<double>(z.total_out));
  deflateEnd(&z);
}

}  // namespace
}  // namespace atlas
