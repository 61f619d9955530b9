// SPDX-License-Identifier: MIT
// timestamps.txt: which stamp belongs to a frame, whatever the order of the rows.
#include "record/frame_table.hpp"

#include <gtest/gtest.h>

#include "record/stamp_outlier.hpp"
#include "small_record.hpp"

namespace atlas::record {
namespace {

using test::kBegin;

class FrameTables : public ::testing::Test {
 protected:
  FrameTable read(const std::string& text, FrameColumns columns = FrameColumns::kInner,
                  Duration latency = 0) {
    return {folder_.write("timestamps.txt", text), "cam/timestamps.txt", columns, latency, log_};
  }
  const FileReport& report() { return log_->file("cam/timestamps.txt"); }
  std::uint64_t skipped() {
    std::uint64_t sum = 0;
    for (const auto& [reason, rows] : report().skipped) sum += rows;
    return sum;
  }
  test::TemporaryFolder folder_;
  std::shared_ptr<RecordLog> log_ = std::make_shared<RecordLog>();
};

std::string row(Stamp offset, int index, const std::string& rest = ", 5") {
  return std::to_string(kBegin + offset) + "," + std::to_string(index) + rest + "\n";
}

TEST_F(FrameTables, ThreeColumnsOrTwo) {
  const FrameTable table = read(row(0, 0, ", 11851675248") + row(10, 1, ""));
  ASSERT_EQ(table.rows().size(), 2U);
  EXPECT_EQ(table.rows()[0].inner, 11851675248U);
  EXPECT_EQ(table.rows()[1].inner, 0U);
  EXPECT_EQ(table.find(1)->stamp, kBegin + 10);
  EXPECT_EQ(table.find(2), nullptr);
}

TEST_F(FrameTables, TemperaturesOfTheThermalCamera) {
  const FrameTable table = read("1568186745426675402,0,-29.65,20.74\r\n", FrameColumns::kTemperatures);
  ASSERT_EQ(table.rows().size(), 1U);
  EXPECT_EQ(table.rows()[0].minimum_degc, -29.65);
  EXPECT_EQ(table.rows()[0].maximum_degc, 20.74);
  EXPECT_EQ(table.rows()[0].stamp, 1568186745426675402);
}

TEST_F(FrameTables, LatencyIsTakenOff) {
  EXPECT_EQ(read(row(0, 0), FrameColumns::kInner, 7).rows()[0].stamp, kBegin - 7);
}

TEST_F(FrameTables, MisorderedRowsAreSortedByStampAndKeepTheirFrame) {
  FrameTable table = read(row(0, 0) + row(30, 1) + row(10, 2) + row(20, 3));
  ASSERT_EQ(table.rows().size(), 4U);
  EXPECT_EQ(table.rows()[1].index, 2U);
  EXPECT_EQ(table.rows()[3].index, 1U);
  EXPECT_EQ(table.find(1)->stamp, kBegin + 30);
  EXPECT_EQ(table.disorder(), 2U);
  EXPECT_NE(log_->notes().front().find("3 rows out of order"), std::string::npos);
  table.account({});
  EXPECT_EQ(report().used, 4U);
}

TEST_F(FrameTables, RepeatedIndexIsNamed) {
  FrameTable table = read(row(0, 0) + row(10, 1) + row(20, 1));
  table.account({});
  EXPECT_EQ(table.find(1)->stamp, kBegin + 10) << "the first row counts";
  EXPECT_EQ(report().skipped.at("frame index repeated"), 1U);
  EXPECT_EQ(report().examples.front(), "cam/timestamps.txt:3: field 2 (index): repeated: '1'");
  EXPECT_EQ(report().rows, report().used + skipped());
}

TEST_F(FrameTables, GarbledRowsAndOutliersAreBooked) {
  FrameTable table = read(row(0, 0) + "x,1,2\n" + row(10, -1) + row(20, 2, ", -3") + row(30, 3) +
                          "968186745400000000,4,5\n" + row(40, 5));
  table.account({kBegin, kBegin + 40});
  EXPECT_EQ(report().rows, 7U);
  EXPECT_EQ(report().used, 2U);
  EXPECT_EQ(report().skipped.at(kOutlier), 1U);
  EXPECT_EQ(report().skipped.at("not an unsigned integer"), 1U);
  EXPECT_EQ(report().skipped.at(kOutsideSpan), 1U);
  EXPECT_EQ(report().rows, report().used + skipped());
}

TEST_F(FrameTables, FramesTheVideoDoesNotHaveAreGone) {
  FrameTable table = read(row(0, 0) + row(10, 1) + row(20, 2));
  table.limitFrames(2);
  table.account({});
  EXPECT_EQ(table.rows().size(), 2U);
  EXPECT_EQ(table.find(2), nullptr);
  EXPECT_EQ(report().skipped.at("the video has no such frame"), 1U);
  EXPECT_EQ(report().rows, report().used + skipped());
}

TEST_F(FrameTables, UnusedTableBooksEachRowOnce) {
  FrameTable table = read(row(0, 0) + row(10, 1));
  table.accountUnused("nothing asked for");
  table.account({});
  EXPECT_EQ(report().skipped.at("nothing asked for"), 2U);
  EXPECT_EQ(report().used, 0U);
}

TEST_F(FrameTables, EmptyFile) {
  EXPECT_TRUE(read("\r\n").rows().empty());
  EXPECT_EQ(log_->notes().front(), "cam/timestamps.txt: no usable rows");
}

TEST_F(FrameTables, SourceMakesOneEventAFrameInsideTheSpan) {
  const auto table = std::make_shared<FrameTable>(read(row(0, 0) + row(10, 1) + row(20, 2) + row(30, 3)));
  std::vector<std::optional<std::uint32_t>> previous;
  FrameSource source(table, 6, [&](const FrameRow& frame, const FrameRow* before) -> std::optional<Payload> {
    previous.push_back(before ? std::optional(before->index) : std::nullopt);
    if (frame.index == 2) return std::nullopt;
    return TemperatureRange{frame.stamp, 0, 0};
  });
  EXPECT_EQ(source.firstStamp(), kBegin);
  EXPECT_EQ(source.lastStamp(), kBegin + 30);
  source.limit({kBegin + 10, kEndOfTime});
  std::vector<Stamp> stamps;
  while (const auto event = source.next()) {
    EXPECT_EQ(event->stream, 6U);
    stamps.push_back(event->stamp);
  }
  EXPECT_EQ(stamps, (std::vector<Stamp>{kBegin + 10, kBegin + 30}));
  EXPECT_EQ(previous, (std::vector<std::optional<std::uint32_t>>{0, 1, 2}));
}

}  // namespace
}  // namespace atlas::record
