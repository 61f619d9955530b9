// SPDX-License-Identifier: MIT
// A file of stamped rows as a stream: sorted within a window, each row booked.
#include "record/row_source.hpp"

#include <gtest/gtest.h>

#include "record/stamp_outlier.hpp"
#include "small_record.hpp"

namespace atlas::record {
namespace {

using test::kBegin;
using test::TemporaryFolder;

struct Delivered {
  std::shared_ptr<RecordLog> log = std::make_shared<RecordLog>();
  std::vector<Event> events;
  std::optional<Stamp> first, last;
  FileReport report;
};

/// Two streams of each row, as of gnss/pose.txt: 3 and 4.
Delivered deliver(const std::string& text, const TimeSpan& span = {}, Duration latency = 0) {
  const TemporaryFolder folder;
  Delivered result;
  const auto parser = [latency](RowFields& fields, std::vector<Event>& events) {
    fields.expect(2);
    const Stamp stamp = fields.stamp(0) - latency;
    const double value = fields.number(1, "value");
    events.push_back({stamp, 3, ScalarSample{stamp, value}});
    events.push_back({stamp, 4, ScalarSample{stamp, value}});
    return stamp;
  };
  RowSource source({folder.write("f.txt", text), "f.txt", latency, parser, {}}, result.log);
  result.first = source.firstStamp();
  result.last = source.lastStamp();
  source.limit(span);
  while (auto event = source.next()) result.events.push_back(*event);
  result.report = result.log->file("f.txt");
  std::uint64_t skipped = 0;
  for (const auto& [reason, rows] : result.report.skipped) skipped += rows;
  EXPECT_EQ(result.report.rows, result.report.used + skipped);
  for (std::size_t i = 1; i < result.events.size(); ++i) {
    const auto key = [&](std::size_t k) {
      return std::make_pair(result.events[k].stamp, result.events[k].stream);
    };
    EXPECT_LE(key(i - 1), key(i));
  }
  return result;
}

std::string row(Stamp offset, const std::string& value = "1") {
  return std::to_string(kBegin + offset) + ", " + value + "\n";
}

double valueOf(const Event& event) { return std::get<ScalarSample>(event.payload).value; }

TEST(RowSource, DeliversRowsAndKnowsItsSpan) {
  const Delivered r = deliver(row(0, "1") + row(10, "2") + "\n  \n" + row(20, "3"), {}, 5);
  EXPECT_EQ(r.report.rows, 3U) << "blank lines are no rows";
  EXPECT_EQ(r.events.size(), 6U);
  EXPECT_EQ(r.first, kBegin - 5);
  EXPECT_EQ(r.last, kBegin + 15);
  EXPECT_EQ(valueOf(r.events.back()), 3.0);
}

TEST(RowSource, SortsRowsOutOfOrderAndSaysSo) {
  const Delivered r = deliver(row(0, "1") + row(30, "4") + row(10, "2") + row(20, "3"));
  EXPECT_EQ(r.report.used, 4U);
  ASSERT_EQ(r.events.size(), 8U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(valueOf(r.events[2 * i]), static_cast<double>(i + 1));
  EXPECT_EQ(r.log->notes().front(), "f.txt: 2 rows out of order, sorted by stamp");
}

TEST(RowSource, EqualStampsStayInOrderOfStreams) {
  const Delivered r = deliver(row(0, "1") + row(0, "2"));
  ASSERT_EQ(r.events.size(), 4U);
  EXPECT_EQ(r.events[0].stream, 3U);
  EXPECT_EQ(r.events[1].stream, 3U);
  EXPECT_EQ(valueOf(r.events[0]), 1.0) << "rows of one stamp keep their order";
  EXPECT_EQ(r.log->notes().front(), "f.txt: 1 rows repeat the stamp before them");
}

TEST(RowSource, RowBehindTheWindowIsSkippedWithAReason) {
  std::string text;
  for (std::size_t i = 0; i < RowSource::kReorderRows + 10; ++i) text += row(1000 + static_cast<Stamp>(i));
  const Delivered r = deliver(text + row(0));
  EXPECT_EQ(r.report.skipped.at(kBeyondReorder), 1U);
  EXPECT_NE(r.report.examples.front().find("f.txt:" + std::to_string(RowSource::kReorderRows + 11)),
            std::string::npos);
}

TEST(RowSource, GarbledRowsAreCountedByReason) {
  const Delivered r = deliver(row(0) + "garbage\n" + row(10, "nan") + row(20, "1, 2") +
                              std::to_string(kBegin + 30) + "\n" + row(40));
  EXPECT_EQ(r.report.rows, 6U);
  EXPECT_EQ(r.report.used, 2U);
  EXPECT_EQ(r.report.skipped.at("not finite"), 1U);
  EXPECT_EQ(r.report.skipped.at("too many fields"), 1U);
  EXPECT_EQ(r.report.skipped.at("too few fields"), 2U);
}

TEST(RowSource, StampYearsAwayNeitherMovesTheBeginNorEndsTheStream) {
  std::string text = "968186745400000000, 7\n";  // the year 2000, as if a digit were lost
  for (int i = 0; i < 10; ++i) text += row(10 * i);
  text += "3968186745400000000, 7\n";  // 2095
  const Delivered r = deliver(text);
  EXPECT_EQ(r.first, kBegin);
  EXPECT_EQ(r.last, kBegin + 90);
  EXPECT_EQ(r.report.skipped.at(kOutlier), 2U);
  EXPECT_NE(r.report.examples.front().find("f.txt:1: field 1 (stamp)"), std::string::npos);
  EXPECT_TRUE(r.log->notes().empty()) << "an outlier makes no inversions of the others";
}

TEST(RowSource, SpanIsHalfOpen) {
  const Delivered r = deliver(row(0) + row(10) + row(20) + row(30), {kBegin + 10, kBegin + 30});
  EXPECT_EQ(r.report.used, 2U);
  EXPECT_EQ(r.report.skipped.at(kOutsideSpan), 2U);
  EXPECT_EQ(r.events.front().stamp, kBegin + 10);
}

TEST(RowSource, EmptyFileOfTheDatasetIsOneLineEnd) {
  const Delivered r = deliver("\r\n");
  EXPECT_EQ(r.report.rows, 0U);
  EXPECT_FALSE(r.first);
  EXPECT_EQ(r.log->notes().front(), "f.txt: empty");
}

TEST(CountRows, CountsWhatIsNotBlank) {
  const TemporaryFolder folder;
  EXPECT_EQ(countRows(folder.write("f.txt", "a\r\n\r\nb")), 2U);
  EXPECT_EQ(countRows(folder / "missing"), 0U);
}

}  // namespace
}  // namespace atlas::record
