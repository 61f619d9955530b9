// SPDX-License-Identifier: MIT
// Packets and pictures of a video, whole and damaged. Frame k is told by its grey.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "drained.hpp"
#include "record/video_decoder.hpp"
#include "record/video_file.hpp"
#include "record/video_source.hpp"
#include "small_video.hpp"

namespace atlas::record {
namespace {

using test::greyOfFrame;
using test::kBegin;

constexpr int kFrames = 45;  // keyframes at 0 and 30
constexpr Duration kPeriod = 100 * kMillisecond;

double greyOf(const ImagePtr& image) { return cv::mean(image->pixels)[0]; }

class Videos : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    common_ = new test::TemporaryFolder;
    test::writeGreyVideo(*common_ / "video.mp4", kFrames);
  }
  static void TearDownTestSuite() {
    delete common_;
    common_ = nullptr;
  }
  static std::filesystem::path video() { return *common_ / "video.mp4"; }

  /// A source over the video with the given rows; stream 2.
  VideoOfCamera camera(const std::filesystem::path& file, std::vector<FrameRow> rows) {
    log_->file("t").rows += rows.size();
    return {std::make_unique<VideoFile>(file), std::make_shared<FrameTable>(std::move(rows), "t", log_),
            "c/video.mp4", "c", 2};
  }
  static std::vector<FrameRow> rows(int count) {
    std::vector<FrameRow> rows(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      rows[static_cast<std::size_t>(i)].stamp = kBegin + i * kPeriod;
      rows[static_cast<std::size_t>(i)].index = static_cast<std::uint32_t>(i);
    }
    return rows;
  }
  static std::vector<Event> all(EventSource& source, const TimeSpan& span = {}) {
    std::vector<Event> events;
    source.limit(span);
    while (auto event = source.next()) {
      if (!events.empty()) {
        EXPECT_LE(events.back().stamp, event->stamp);
      }
      events.push_back(std::move(*event));
    }
    return events;
  }
  /// Decodes packets as a stage does and checks each picture against its stamp.
  static std::vector<ImagePtr> decode(const std::vector<Event>& events,
                                      VideoDecoder::Counts* counts = nullptr) {
    VideoDecoder decoder(VideoDecoder::Pixels::kMono8);
    std::vector<ImagePtr> images;
    for (const Event& event : events) {
      for (auto& image : decoder.push(*std::get<VideoPacketPtr>(event.payload))) images.push_back(image);
    }
    for (auto& image : decoder.flush()) images.push_back(image);
    if (counts) *counts = decoder.counts();
    return images;
  }
  static int frameOf(const ImagePtr& image) { return static_cast<int>((image->stamp - kBegin) / kPeriod); }
  void expectAccounted() { test::expectAllAccounted(log_->files()); }

  static test::TemporaryFolder* common_;
  std::shared_ptr<RecordLog> log_ = std::make_shared<RecordLog>();
};
test::TemporaryFolder* Videos::common_ = nullptr;

TEST_F(Videos, PacketsKnowTheirPlaceInPresentationOrder) {
  VideoFile file(video());
  EXPECT_EQ(file.codec(), "hevc");
  EXPECT_EQ(file.width(), static_cast<std::uint32_t>(test::kVideoWidth));
  EXPECT_EQ(file.frames(), static_cast<std::uint32_t>(kFrames));
  EXPECT_EQ(file.missingFrames(), 0U);
  std::vector<bool> seen(kFrames, false);
  bool reordered = false;
  std::uint32_t decode_index = 0;
  while (const auto packet = file.next()) {
    EXPECT_EQ(packet->decode_index, decode_index++);
    EXPECT_EQ(packet->keyframe, packet->decode_index % 30 == 0);
    EXPECT_EQ(packet->extradata.empty(), !packet->keyframe);
    ASSERT_GE(packet->data.size(), 4U);
    EXPECT_EQ(packet->data[0] + packet->data[1], 0) << "Annex B start code";
    ASSERT_LT(packet->pts_index, seen.size());
    EXPECT_FALSE(seen[packet->pts_index]);
    seen[packet->pts_index] = true;
    reordered = reordered || packet->pts_index != packet->decode_index;
  }
  EXPECT_EQ(decode_index, static_cast<std::uint32_t>(kFrames));
  EXPECT_TRUE(reordered) << "the encoder makes B pictures, or this test says little";
}

TEST_F(Videos, PicturesGetTheStampOfTheirRow) {
  PacketSource source(camera(video(), rows(kFrames)), log_);
  const auto images = decode(all(source));
  ASSERT_EQ(images.size(), static_cast<std::size_t>(kFrames));
  for (int k = 0; k < kFrames; ++k) {
    EXPECT_EQ(images[static_cast<std::size_t>(k)]->stamp, kBegin + k * kPeriod);
    EXPECT_NEAR(greyOf(images[static_cast<std::size_t>(k)]), greyOfFrame(k), 3) << k;
  }
  expectAccounted();
}

TEST_F(Videos, SpanInTheMiddleOfAGroupOfPicturesLosesNone) {
  for (const auto& [first, length] :
       {std::pair(1, 5), {7, 5}, {7, 1}, {8, 1}, {9, 1}, {10, 1}, {29, 5}, {30, 5}, {31, 5}, {44, 5}}) {
    const TimeSpan span{kBegin + first * kPeriod, kBegin + (first + length) * kPeriod};
    const int expected = std::min(length, kFrames - first);
    log_ = std::make_shared<RecordLog>();
    PacketSource packets(camera(video(), rows(kFrames)), log_);
    const auto packet_events = all(packets, span);
    for (const Event& event : packet_events) {
      EXPECT_GT(event.stamp, span.begin - kMillisecond) << "what is before is only there for decoding";
      EXPECT_LT(event.stamp, span.end);
    }
    const auto& first_packet = *std::get<VideoPacketPtr>(packet_events.at(0).payload);
    EXPECT_EQ(first_packet.decode_index, static_cast<std::uint32_t>(first / 30 * 30))
        << "the keyframe before";
    const auto images = decode(packet_events);
    ASSERT_EQ(images.size(), static_cast<std::size_t>(expected)) << first;
    for (int k = 0; k < expected; ++k) {
      EXPECT_EQ(frameOf(images[static_cast<std::size_t>(k)]), first + k);
      EXPECT_NEAR(greyOf(images[static_cast<std::size_t>(k)]), greyOfFrame(first + k), 3);
    }
    EXPECT_EQ(log_->files().at("c/video.mp4").used, static_cast<std::uint64_t>(expected));
    expectAccounted();

    ImageSource pixels(camera(video(), rows(kFrames)), VideoDecoder::Pixels::kMono8, false, log_);
    const auto events = all(pixels, span);
    ASSERT_EQ(events.size(), static_cast<std::size_t>(expected)) << first;
    EXPECT_NEAR(greyOf(std::get<ImagePtr>(events[0].payload)), greyOfFrame(first), 3);
  }
}

TEST_F(Videos, MoreRowsThanPicturesAndMorePicturesThanRows) {
  PacketSource few(camera(video(), rows(10)), log_);
  EXPECT_EQ(decode(all(few)).size(), 10U);
  EXPECT_EQ(log_->files().at("c/video.mp4").skipped.at("no row in timestamps.txt"), kFrames - 10U);
  expectAccounted();
}

TEST_F(Videos, PictureWithoutARowHasNoStampAndIsNotDelivered) {
  auto some = rows(kFrames);
  some.erase(some.begin() + 20);
  some.erase(some.begin() + 10, some.begin() + 13);
  PacketSource source(camera(video(), some), log_);
  VideoDecoder::Counts counts;
  const auto images = decode(all(source), &counts);
  EXPECT_EQ(images.size(), kFrames - 4U);
  EXPECT_EQ(counts.without_stamp, 4U);
  for (const auto& image : images)
    EXPECT_NEAR(greyOf(image), greyOfFrame(frameOf(image)), 3) << frameOf(image);
  expectAccounted();
}

TEST_F(Videos, FirstRowsMissingDoesNotCostTheKeyframe) {
  auto late = rows(kFrames);
  late.erase(late.begin(), late.begin() + 3);
  PacketSource source(camera(video(), late), log_);
  const auto images = decode(all(source));
  ASSERT_EQ(images.size(), kFrames - 3U);
  EXPECT_NEAR(greyOf(images[0]), greyOfFrame(3), 3);
}

TEST_F(Videos, MisorderedRowsAreSortedWhenPicturesAreDecoded) {
  auto mixed = rows(kFrames);
  std::swap(mixed[5].stamp, mixed[7].stamp);
  ImageSource source(camera(video(), mixed), VideoDecoder::Pixels::kMono8, false, log_);
  const auto events = all(source);
  ASSERT_EQ(events.size(), static_cast<std::size_t>(kFrames));
  EXPECT_NEAR(greyOf(std::get<ImagePtr>(events[5].payload)), greyOfFrame(7), 3);
  EXPECT_NEAR(greyOf(std::get<ImagePtr>(events[7].payload)), greyOfFrame(5), 3);
  expectAccounted();
}

TEST_F(Videos, PacketsOfMisorderedRowsNeverGoBackAndSayWhatIsLost) {
  auto mixed = rows(kFrames);
  std::swap(mixed[5].stamp, mixed[7].stamp);
  PacketSource source(camera(video(), mixed), log_);
  const auto images = decode(all(source));
  EXPECT_EQ(images.size(), kFrames - 2U);
  ASSERT_EQ(log_->notes().size(), 1U + 1U);
  EXPECT_NE(log_->notes().back().find("2 packets whose row goes back in time"), std::string::npos);
  expectAccounted();
}

TEST_F(Videos, JpegHasTheColourOfThePicture) {
  const test::TemporaryFolder folder;
  test::writeRgbVideo(folder / "colour.mp4", 3, {200, 80, 40});
  ImageSource pixels(camera(folder / "colour.mp4", rows(3)), VideoDecoder::Pixels::kBgr8, false, log_);
  const auto raw = all(pixels);
  ASSERT_EQ(raw.size(), 3U);
  const auto& picture = std::get<ImagePtr>(raw[1].payload);
  EXPECT_EQ(picture->format, "bgr8");
  const cv::Scalar mean = cv::mean(picture->pixels);
  // One step of chroma is two steps of blue or red; the encoder adds about as much.
  EXPECT_NEAR(mean[0], 40, 6);
  EXPECT_NEAR(mean[1], 80, 6);
  EXPECT_NEAR(mean[2], 200, 6);
  ImageSource encoded(camera(folder / "colour.mp4", rows(3)), VideoDecoder::Pixels::kBgr8, true, log_);
  const auto jpeg = all(encoded);
  ASSERT_EQ(jpeg.size(), 3U);
  const auto& bytes = std::get<ImagePtr>(jpeg[1].payload);
  EXPECT_EQ(bytes->format, "jpeg");
  EXPECT_EQ(bytes->encoded.at(0), 0xff);
  EXPECT_EQ(bytes->encoded.at(1), 0xd8);
}

TEST_F(Videos, CutFileWithItsIndexInFrontKeepsWhatIsThere) {
  const test::TemporaryFolder folder;
  const std::string whole = test::withIndexFirst(common_->read("video.mp4"));
  ASSERT_FALSE(whole.empty());
  folder.write("whole.mp4", whole);
  EXPECT_EQ(VideoFile(folder / "whole.mp4").frames(), static_cast<std::uint32_t>(kFrames));
  folder.write("cut.mp4", whole.substr(0, whole.size() - 100));
  VideoFile cut(folder / "cut.mp4");
  EXPECT_GT(cut.missingFrames(), 0U);
  EXPECT_EQ(cut.frames() + cut.missingFrames(), static_cast<std::uint32_t>(kFrames));
  std::uint32_t packets = 0;
  while (cut.next()) ++packets;
  EXPECT_EQ(packets, cut.frames());
  PacketSource source(camera(folder / "cut.mp4", rows(kFrames)), log_);
  const auto images = decode(all(source));
  EXPECT_LE(images.size(), packets);
  EXPECT_GE(images.size() + 4, packets) << "but for pictures that are shown behind a missing one";
  for (const auto& image : images) EXPECT_NEAR(greyOf(image), greyOfFrame(frameOf(image)), 3);
  EXPECT_GT(log_->files().at("c/video.mp4").skipped.at("cut off: bytes missing"), 0U);
  expectAccounted();
}

TEST_F(Videos, CutFileWithItsIndexAtTheEndIsRefusedByName) {
  const test::TemporaryFolder folder;
  const std::string whole = common_->read("video.mp4");
  folder.write("cut.mp4", whole.substr(0, whole.size() / 2));
  folder.write("empty.mp4", "");
  folder.write("text.mp4", "no video at all");
  for (const char* name : {"cut.mp4", "empty.mp4", "text.mp4", "missing.mp4"}) {
    try {
      VideoFile file(folder / name);
      ADD_FAILURE() << name;
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
    }
  }
}

TEST_F(Videos, DamagedPicturesAreNotDelivered) {
  const test::TemporaryFolder folder;
  PacketSource source(camera(video(), rows(kFrames)), log_);
  auto events = all(source);
  std::vector<Event> gap;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (i < 10 || i > 12) gap.push_back(events[i]);
  }
  VideoDecoder::Counts counts;
  const auto images = decode(gap, &counts);
  for (const auto& image : images)
    EXPECT_NEAR(greyOf(image), greyOfFrame(frameOf(image)), 3) << "frame " << frameOf(image);
  EXPECT_EQ(counts.before_keyframe, 30U - 13U) << "after a gap decoding goes on at the next keyframe";
  EXPECT_GE(images.size(), 15U);
}

TEST(VideoDecoder, UnknownCodecIsNamed) {
  VideoDecoder decoder(VideoDecoder::Pixels::kBgr8);
  VideoPacket packet;
  packet.codec = "nonsense";
  packet.keyframe = true;
  packet.data = {0, 0, 0, 1, 9};
  EXPECT_TRUE(decoder.push(packet).empty());
  EXPECT_EQ(decoder.counts().codec_error, "no decoder for 'nonsense'");
}

}  // namespace
}  // namespace atlas::record
