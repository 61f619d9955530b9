// SPDX-License-Identifier: MIT
#include "atlas/output/fixed_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <locale>

namespace atlas {
namespace {

TEST(FixedText, decimals) {
  EXPECT_EQ(fixedText(1.5, 3), "1.500");
  EXPECT_EQ(fixedText(-1234567.891, 2), "-1234567.89");
  EXPECT_EQ(fixedText(2.0, 0), "2");
}

TEST(FixedText, whatIsNotFiniteIsNamed) {
  EXPECT_EQ(fixedText(std::nan(""), 3), "nan");
  EXPECT_EQ(fixedText(std::numeric_limits<double>::infinity(), 3), "inf");
  EXPECT_EQ(fixedText(-std::numeric_limits<double>::infinity(), 3), "-inf");
}

struct CommaLocale : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(FixedText, theLocaleHasNoInfluence) {
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new CommaLocale));
  const std::string text = fixedText(1234567.5, 2);
  std::locale::global(before);
  EXPECT_EQ(text, "1234567.50");
}

}  // namespace
}  // namespace atlas
