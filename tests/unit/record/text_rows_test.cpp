// SPDX-License-Identifier: MIT
// Lines and fields as the Brno Urban Dataset has them: mixed line ends, blanks, nothing trusted.
#include "record/text_rows.hpp"

#include <gtest/gtest.h>

#include "record/stamp_outlier.hpp"
#include "temporary_folder.hpp"

namespace atlas::record {
namespace {

std::vector<std::string> linesOf(const std::string& bytes) {
  const test::TemporaryFolder folder;
  LineReader reader(folder.write("file.txt", bytes));
  std::vector<std::string> lines;
  while (const auto line = reader.next()) lines.emplace_back(line->text);
  return lines;
}

RowFields fieldsOf(const std::string& text, char delimiter = ',') {
  static std::string kept;
  kept = text;
  RowFields fields("imu/imu.txt", delimiter);
  fields.assign(Line{kept, 17, 0, false});
  return fields;
}

TEST(LineReader, TakesBothLineEndsAndALastLineWithoutOne) {
  EXPECT_EQ(linesOf("a\r\nb\nc"), (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(linesOf("a\n\r\n"), (std::vector<std::string>{"a", ""}));
  EXPECT_TRUE(linesOf("").empty());
}

TEST(LineReader, ByteOrderMarkIsNoPartOfTheFirstRow) {
  EXPECT_EQ(linesOf("\xef\xbb\xbf"
                    "1,2\n3"),
            (std::vector<std::string>{"1,2", "3"}));
}

TEST(LineReader, CutsALineThatIsTooLongAndGoesOnBehindIt) {
  const test::TemporaryFolder folder;
  const std::string huge(3 * LineReader::kMaxLine, 'x');
  LineReader reader(folder.write("file.txt", huge + "\nnext\n"));
  const auto first = reader.next();
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->too_long);
  EXPECT_EQ(first->text.size(), LineReader::kMaxLine);
  const auto second = reader.next();
  ASSERT_TRUE(second);
  EXPECT_EQ(second->text, "next");
  EXPECT_EQ(second->number, 2U);
}

TEST(LineReader, SeeksBackAndForth) {
  const test::TemporaryFolder folder;
  std::string bytes;
  for (int i = 0; i < 20000; ++i) bytes += std::to_string(i) + "\n";  // more than one chunk
  LineReader reader(folder.write("file.txt", bytes));
  std::uint64_t offset = 0;
  for (int i = 0; i < 100; ++i) offset = reader.next()->offset;
  for (int i = 100; i < 19000; ++i) reader.next();
  reader.seek(offset, 100);
  const auto line = reader.next();
  EXPECT_EQ(line->text, "99");
  EXPECT_EQ(line->number, 100U);
  EXPECT_EQ(line->offset, offset);
}

TEST(LineReader, FolderOrMissingFileIsNotOpened) {
  const test::TemporaryFolder folder;
  EXPECT_FALSE(LineReader(folder.path()).opened());
  LineReader missing(folder / "no.txt");
  EXPECT_FALSE(missing.opened());
  EXPECT_FALSE(missing.next());
}

TEST(RowFields, TrimsBlanksAroundFields) {
  auto fields = fieldsOf("1568186745439000000,0, 11851675248 ");
  EXPECT_EQ(fields.size(), 3U);
  EXPECT_EQ(fields.stamp(0), 1'568'186'745'439'000'000);
  EXPECT_EQ(fields.unsignedInteger(2, "inner"), 11851675248U);
  EXPECT_TRUE(fields.ok());
}

TEST(RowFields, CommaAtTheEndIsNoField) {
  EXPECT_EQ(fieldsOf("1, 2, 3,").size(), 3U);
  EXPECT_EQ(fieldsOf("1, , 3").size(), 3U);
}

TEST(RowFields, FaultNamesFileLineFieldAndValue) {
  auto fields = fieldsOf("1568186745439000000, 0.1, abc");
  fields.number(2, "ay");
  EXPECT_FALSE(fields.ok());
  EXPECT_EQ(fields.reason(), "not a number");
  EXPECT_EQ(fields.example(), "imu/imu.txt:17: field 3 (ay): not a number: 'abc'");
}

TEST(RowFields, FirstFaultStays) {
  auto fields = fieldsOf("x, nan");
  fields.stamp(0);
  fields.number(1, "ax");
  EXPECT_NE(fields.example().find("field 1 (stamp)"), std::string::npos);
}

TEST(RowFields, RefusesWhatIsNoFiniteNumber) {
  for (const char* text : {"nan", "-inf", "1e999", "0x10", "1.5.2", "", "--1", "+-1", "1,5"}) {
    auto fields = fieldsOf(std::string("1, ") + text);
    if (std::string(text) == "1,5") continue;  // a comma is another field
    fields.number(1, "ax");
    EXPECT_FALSE(fields.ok()) << "'" << text << "'";
  }
  EXPECT_DOUBLE_EQ(*toDouble(" -2.43261e-06 "), -2.43261e-06);
  EXPECT_DOUBLE_EQ(*toDouble("+3"), 3.0);
}

TEST(RowFields, StampHasToBeUnixTimeInNanoseconds) {
  for (const char* text :
       {"0", "-5", "1568186745", "1568186745439.5", "99999999999999999999", "15681867454390000000"}) {
    auto fields = fieldsOf(text);
    fields.stamp(0);
    EXPECT_FALSE(fields.ok()) << text;
  }
}

TEST(RowFields, ExampleIsPrintableAndShort) {
  auto fields = fieldsOf("\x01\xff" + std::string(500, 'q'));
  fields.number(0, "x");
  EXPECT_LT(fields.example().size(), 120U);
  EXPECT_EQ(fields.example().find('\x01'), std::string::npos);
}

TEST(RowFields, IntegerMayBeWrittenAsReal) {
  EXPECT_EQ(fieldsOf("3.0").integer(0, "class", 0, 80), 3);
  auto fraction = fieldsOf("3.5");
  fraction.integer(0, "class", 0, 80);
  EXPECT_EQ(fraction.reason(), "not an integer");
  auto beyond = fieldsOf("81");
  beyond.integer(0, "class", 0, 80);
  EXPECT_EQ(beyond.reason(), "out of range");
}

TEST(Calendar, IsUnixTime) {
  EXPECT_EQ(fromCalendar(1970, 1, 1, 0, 0, 0, 0), 0);
  EXPECT_EQ(fromCalendar(2019, 9, 11, 7, 25, 45, 403'600'000),
            1'568'186'745'403'600'000);  // date -u -d ... +%s
  EXPECT_EQ(*fromCalendar(2020, 3, 1, 0, 0, 0, 0) - *fromCalendar(2020, 2, 28, 0, 0, 0, 0),
            2 * 86400 * kSecond);
  EXPECT_EQ(*fromCalendar(2100, 3, 1, 0, 0, 0, 0) - *fromCalendar(2100, 2, 28, 0, 0, 0, 0), 86400 * kSecond);
  EXPECT_FALSE(fromCalendar(2019, 13, 1, 0, 0, 0, 0));
  EXPECT_FALSE(fromCalendar(2019, 2, 29, 0, 0, 0, 0));
  EXPECT_FALSE(fromCalendar(2019, 1, 1, 24, 0, 0, 0));
}

TEST(StampOutlier, IsJudgedAgainstTheMedian) {
  const Stamp t = 1'568'186'745'000'000'000;
  const auto typical = typicalStamp({t, t + 1, 1'000'000'000'000'000'000, t + 2, t + 3});
  ASSERT_TRUE(typical);
  EXPECT_TRUE(isOutlier(1'000'000'000'000'000'000, typical));
  EXPECT_FALSE(isOutlier(t + 3600 * kSecond, typical));
  EXPECT_FALSE(isOutlier(t + kLongestRecord, t)) << "exactly at the bound";
  EXPECT_TRUE(isOutlier(t + kLongestRecord + 1, t));
  EXPECT_FALSE(isOutlier(t, std::nullopt));
  EXPECT_FALSE(typicalStamp(std::vector<Stamp>{}));
}

}  // namespace
}  // namespace atlas::record
