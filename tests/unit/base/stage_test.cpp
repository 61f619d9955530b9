// SPDX-License-Identifier: MIT
// The progress rules of Stage, on a small stage that answers images when a later pose has come.
#include "atlas/base/stage.hpp"

#include <gtest/gtest.h>

#include <deque>

namespace atlas {
namespace {

class PairStage : public Stage {
 public:
  enum Input : std::size_t { kPose, kImage };
  PairStage() : Stage("pair", {"pose", "image"}) {}

  void pushPose(Stamp stamp) {
    enqueue(kPose, stamp, [this, stamp] {
      newest_pose_ = stamp;
      counters_.add("pose");
    });
  }
  void pushImage(Stamp stamp) {
    enqueue(kImage, stamp, [this, stamp] { waiting_.push_back(stamp); });
  }

  std::vector<Stamp> answered;
  int ends = 0;
  std::vector<Stamp> progress_at_answer;

 protected:
  [[nodiscard]] Stamp heldBackFrom() const override {
    return waiting_.empty() ? kEndOfTime : waiting_.front();
  }
  void onProgress() override {
    while (!waiting_.empty() && waiting_.front() <= newest_pose_) answer();
  }
  void onEnd() override {
    ++ends;
    while (!waiting_.empty()) {
      counters_.skip("image", Reason::kPoseNotReached);
      answer();
    }
  }

 private:
  void answer() {
    progress_at_answer.push_back(progress());
    answered.push_back(waiting_.front());
    waiting_.pop_front();
  }
  std::deque<Stamp> waiting_;
  Stamp newest_pose_ = kBeginOfTime;
};

TEST(Stage, NamesItsInputs) {
  PairStage stage;
  EXPECT_EQ(stage.name(), "pair");
  EXPECT_EQ(stage.inputs(), 2U);
  EXPECT_EQ(stage.inputName(1), "image");
}

TEST(Stage, ProgressStopsBeforeWhatIsOwed) {
  PairStage stage;
  EXPECT_EQ(stage.progress(), kBeginOfTime);
  stage.pushPose(10);
  stage.advance(PairStage::kPose, 15);
  stage.pushImage(12);
  stage.advance(PairStage::kImage, 20);
  EXPECT_TRUE(stage.answered.empty());
  EXPECT_EQ(stage.progress(), 11) << "image 12 is taken but not answered";
  stage.pushPose(18);  // dispatched at once: no image at or before 20 can come
  EXPECT_EQ(stage.answered, std::vector<Stamp>{12});
  EXPECT_EQ(stage.progress(), 17) << "another pose of stamp 18 may come";
  stage.advance(PairStage::kPose, 30);
  EXPECT_EQ(stage.progress(), 20);
}

TEST(Stage, ProgressNeverClaimsAnAnswerThatIsNotGivenYet) {
  PairStage stage;
  for (Stamp t = 0; t < 100; t += 7) stage.pushImage(t);
  for (Stamp t = 0; t < 100; t += 3) stage.pushPose(t);
  stage.finish(0);
  stage.finish(1);
  ASSERT_EQ(stage.answered.size(), 15U);
  for (std::size_t i = 0; i < stage.answered.size(); ++i)
    EXPECT_LT(stage.progress_at_answer[i], stage.answered[i]);
}

TEST(Stage, ProgressIsMonotonic) {
  PairStage stage;
  Stamp last = kBeginOfTime;
  for (Stamp t = 1; t < 200; ++t) {
    if (t % 2 == 0) stage.pushPose(t);
    if (t % 5 == 0) stage.pushImage(t);
    if (t % 7 == 0) stage.advance(PairStage::kImage, t);
    ASSERT_GE(stage.progress(), last) << t;
    last = stage.progress();
  }
  EXPECT_GT(last, 150);
}

TEST(Stage, EndFlushesOnceAndIsTheEnd) {
  PairStage stage;
  stage.pushPose(10);
  stage.pushImage(50);
  stage.finish(PairStage::kPose);
  EXPECT_FALSE(stage.ended());
  EXPECT_TRUE(stage.answered.empty());
  stage.finish(PairStage::kImage);
  EXPECT_TRUE(stage.ended());
  EXPECT_EQ(stage.ends, 1);
  EXPECT_EQ(stage.answered, std::vector<Stamp>{50});
  EXPECT_EQ(stage.counters().get("skipped image: after the newest pose"), 1U);
  EXPECT_EQ(stage.progress(), kEndOfTime);
  stage.finish(PairStage::kImage);
  stage.pushImage(60);
  EXPECT_EQ(stage.ends, 1);
  EXPECT_EQ(stage.answered.size(), 1U);
  EXPECT_EQ(stage.merge().late(PairStage::kImage), 1U);
}

TEST(Counters, AddSkipAndRead) {
  Counters counters;
  EXPECT_EQ(counters.get("imu"), 0U);
  counters.add("imu");
  counters.add("imu", 2);
  counters.skip("fix", Reason::kNotFinite);
  EXPECT_EQ(counters.get("imu"), 3U);
  EXPECT_EQ(counters.get("skipped fix: not finite"), 1U);
  EXPECT_EQ(counters.all().size(), 2U);
}

}  // namespace
}  // namespace atlas
