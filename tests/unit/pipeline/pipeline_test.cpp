// SPDX-License-Identifier: MIT
// The whole data path as atlas_replay runs it: what comes out, in any order of arrival, and what is kept in
// memory.
#include "atlas/pipeline.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "small_drive.hpp"

namespace atlas::test {
namespace {

/// Everything that the stages have said.
struct Outputs {
  std::vector<Odometry> odometry;
  std::vector<Anchor> anchors;
  std::vector<BatchedSweepPtr> batches;
  std::vector<MapCloudPtr> clouds;
  std::vector<Obstacles> obstacles;
  std::vector<Lines> lines;
  std::vector<Frustums> frustums;
  std::vector<ProjectedDetections> projected;
  std::vector<DepthImagePtr> depth;
};

/// Appends what one topic carries to a list.
template <class T>
class Listener : public Stage {
 public:
  explicit Listener(std::vector<T>* list) : Stage("listener", {"topic"}), list_(list) {}
  void push(const T& value) { list_->push_back(value); }

 private:
  std::vector<T>* list_;
};
template <class T>
void listen(LocalGraph& graph, const std::string& topic, std::vector<T>& list) {
  graph.add([&](LocalGraph::Bus& bus) -> StageFactory {
    bus.input<Listener<T>, T>(0, topic, [](Listener<T>& s, const T& value) { s.push(value); });
    return [&list] { return std::make_unique<Listener<T>>(&list); };
  });
}

PipelineParams params() {
  PipelineParams p;
  p.camera_lidar.cameras = {"camera_left_front", "camera_right_front"};
  p.depth.cameras = {"camera_ir", "camera_left_front"};
  return p;
}

PipelineParams paramsWithLines() {
  PipelineParams p = params();
  p.lines.emplace();
  return p;
}

/// The stages with a listener at each output.
struct Replay {
  Outputs out;
  LocalGraph graph;
  explicit Replay(const PipelineParams& asked = params()) {
    addPipeline(graph, asked);
    if (asked.lines) {
      for (const std::string& lidar : asked.lines->lidars) listen(graph, lidar + "/lines", out.lines);
    }
    listen(graph, "odometry", out.odometry);
    listen(graph, "anchor", out.anchors);
    listen(graph, "cloud", out.clouds);
    listen(graph, "obstacles", out.obstacles);
    listen(graph, "camera_ir/projected_detections", out.projected);
    for (const std::string& lidar : params().deskew.lidars) listen(graph, lidar + "/batches", out.batches);
    for (const std::string& camera : params().camera_lidar.cameras)
      listen(graph, camera + "/frustums", out.frustums);
    for (const std::string& camera : params().depth.cameras)
      listen(graph, camera + "/depth/image", out.depth);
  }
};

template <class T>
void add(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// All numbers of all outputs, bit by bit, and all counters.
std::string everything(const Replay& run) {
  std::string bytes;
  for (const Odometry& o : run.out.odometry) {
    add(bytes, o.stamp);
    for (int i = 0; i < 4; ++i) add(bytes, o.T_map_imu.rotation.coeffs()[i]);
    for (int i = 0; i < 3; ++i) add(bytes, o.T_map_imu.translation[i]);
    add(bytes, o.pose_covariance);
    add(bytes, o.twist_covariance);
  }
  for (const MapCloudPtr& cloud : run.out.clouds) {
    add(bytes, cloud->stamp);
    bytes.append(reinterpret_cast<const char*>(cloud->points.data()),
                 cloud->points.size() * sizeof(LidarPoint));
  }
  for (const Obstacles& o : run.out.obstacles) {
    add(bytes, o.stamp);
    for (const Obstacle& box : o.obstacles) {
      for (int i = 0; i < 3; ++i) add(bytes, box.center[i]);
      add(bytes, box.yaw_rad);
    }
  }
  for (const Lines& l : run.out.lines) {
    add(bytes, l.stamp);
    for (const Line& line : l.lines) {
      for (int i = 0; i < 3; ++i) add(bytes, line.from[i]), add(bytes, line.to[i]);
    }
  }
  for (const Frustums& f : run.out.frustums) {
    add(bytes, f.stamp);
    for (const Frustum& one : f.frustums) {
      for (int i = 0; i < 3; ++i) add(bytes, one.position[i]);
      add(bytes, one.depth_sigma_m);
    }
  }
  for (const ProjectedDetections& p : run.out.projected) {
    add(bytes, p.detections.stamp);
    for (const Detection2d& box : p.detections.boxes) add(bytes, box.x_min);
  }
  for (const DepthImagePtr& image : run.out.depth) {
    add(bytes, image->stamp);
    bytes.append(reinterpret_cast<const char*>(image->depth.data),
                 image->depth.total() * image->depth.elemSize());
  }
  for (const Stage* stage : run.graph.stages()) {
    for (const auto& [key, count] : stage->counters().all())
      bytes += stage->name() + " " + key + " " + std::to_string(count) + "\n";
  }
  return bytes;
}

void replayInOrder(Replay& run, const std::vector<SourceEvent>& events) {
  for (const SourceEvent& event : events) {
    if (event.topic != "tf_static") run.graph.advance(event.stamp - 1);  // counts before every other event
    event.publish(run.graph);
  }
  run.graph.finish();
}

TEST(Pipeline, ADriveTowardsAWall) {
  const SmallDrive drive(3.0);
  Replay run;
  replayInOrder(run, drive.events());
  const Outputs& out = run.out;
  ASSERT_EQ(out.anchors.size(), 1U);
  EXPECT_EQ(out.anchors[0].stamp, kStart + 3 * kMillisecond);
  ASSERT_GT(out.odometry.size(), 200U);
  for (const Odometry& o : out.odometry) EXPECT_NEAR(o.T_map_imu.translation.x(), drive.xAt(o.stamp), 0.02);

  ASSERT_EQ(out.batches.size(), 60U) << "every sweep is answered once";
  EXPECT_GE(out.clouds.size(), 3U);
  std::size_t wall = 0, road = 0;
  for (const LidarPoint& p : out.clouds[1]->points) {
    wall += std::abs(p.x - kWall_m) < 0.05 ? 1 : 0;
    road += std::abs(p.z - kRoad_m) < 0.05 ? 1 : 0;
    EXPECT_TRUE(std::abs(p.x - kWall_m) < 0.05 || std::abs(p.z - kRoad_m) < 0.05)
        << p.x << " " << p.y << " " << p.z;
  }
  EXPECT_GT(wall, 300U);
  EXPECT_GT(road, 300U);

  EXPECT_EQ(out.obstacles.size(), 30U) << "one answer for each sweep of the first lidar";
  ASSERT_EQ(out.obstacles.back().obstacles.size(), 1U) << "the wall";
  EXPECT_NEAR(out.obstacles.back().obstacles[0].center.x(), kWall_m, 0.1);

  ASSERT_EQ(out.frustums.size(), 60U) << "one for each image of two cameras";
  ASSERT_EQ(out.frustums.back().frustums.size(), 2U);
  EXPECT_NEAR(out.frustums.back().frustums[0].position.x(), kWall_m, 0.05);
  EXPECT_NEAR(out.frustums.back().frustums[0].position.y(), 0.0, 0.05);

  ASSERT_EQ(out.projected.size(), 90U) << "every thermal frame is answered";
  std::size_t boxes = 0;
  for (const ProjectedDetections& p : out.projected) boxes += p.detections.boxes.size();
  EXPECT_GT(boxes, 40U) << "nearly all of 2 boxes in 30 images: same place, same lens";

  ASSERT_EQ(out.depth.size(), 120U);
  const DepthImage& last = *out.depth.back();
  EXPECT_NEAR(last.depth.at<float>(40, 50), kWall_m - drive.xAt(last.stamp) - 0.5, 0.05);
}

// The published program gave the geometry of one camera (W17) and the frame of another (W22) to its images.
TEST(Pipeline, W17_W22_EveryImageHasTheCalibrationAndFrameOfItsOwnCamera) {
  Replay run;
  replayInOrder(run, SmallDrive(1.0).events());
  std::set<std::string> cameras;
  for (const DepthImagePtr& image : run.out.depth) {
    cameras.insert(image->camera);
    EXPECT_EQ(image->camera_info.frame, image->camera);
    EXPECT_EQ(image->camera_info.stamp, image->stamp);
    EXPECT_EQ(image->depth.cols, static_cast<int>(image->camera_info.width));
    EXPECT_EQ(image->depth.rows, static_cast<int>(image->camera_info.height));
  }
  EXPECT_EQ(cameras, (std::set<std::string>{"camera_ir", "camera_left_front"}));
  for (const ProjectedDetections& p : run.out.projected) EXPECT_EQ(p.detections.frame, "camera_ir");
}

TEST(Pipeline, LinesOnlyWhenAskedFor) {
  const SmallDrive drive(1.0);
  Replay without, with(paramsWithLines());
  replayInOrder(without, drive.events());
  replayInOrder(with, drive.events());
  for (const Stage* stage : without.graph.stages()) EXPECT_NE(stage->name(), "lines");
  ASSERT_EQ(with.out.lines.size(), 20U) << "every sweep is answered once";
  EXPECT_EQ(with.out.lines.back().lines.size(), 50U)
      << "one up each column of the wall; the road is too thin";
  for (const Line& line : with.out.lines.back().lines) {
    EXPECT_EQ(line.kind, LineKind::kSurface);
    for (const Eigen::Vector3d& end : {line.from, line.to}) EXPECT_NEAR(end.x(), kWall_m, 0.05);
  }
}

// Sources arrive in any order within 100 ms, with watermarks now and then: the same bits from every stage.
TEST(Pipeline, ArrivalOrderHasNoInfluence) {
  const std::vector<SourceEvent> events = SmallDrive(2.0).events();
  Replay reference(paramsWithLines());
  replayInOrder(reference, events);
  const std::string expected = everything(reference);
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    Replay run(paramsWithLines());
    events.front().publish(run.graph);  // tf_static
    for (std::size_t begin = 1; begin < events.size();) {
      std::size_t end = begin;
      while (end < events.size() && events[end].stamp < events[begin].stamp + 100 * kMillisecond) ++end;
      // Each topic keeps its own order; whose turn it is, is chance.
      std::map<std::string, std::vector<std::size_t>> by_topic;
      std::vector<std::string> turns;
      for (std::size_t i = begin; i < end; ++i) {
        by_topic[events[i].topic].push_back(i);
        turns.push_back(events[i].topic);
      }
      std::shuffle(turns.begin(), turns.end(), random);
      std::map<std::string, std::size_t> next;
      for (const std::string& topic : turns) events[by_topic[topic][next[topic]++]].publish(run.graph);
      begin = end;
      if (begin < events.size() && seed % 2 == 0) run.graph.advance(events[begin].stamp - 1);
    }
    run.graph.finish();
    EXPECT_TRUE(everything(run) == expected) << "seed " << seed;
  }
}

/// The most sweeps and queued events that were alive at once.
struct Held {
  std::size_t sweeps = 0, queued = 0;
};
Held mostHeld(const std::vector<SourceEvent>& events) {
  LocalGraph graph;
  addPipeline(graph, params());
  std::vector<std::weak_ptr<const BatchedSweep>> batches;
  for (const std::string& lidar : params().deskew.lidars) {
    graph.add([&](LocalGraph::Bus& bus) -> StageFactory {
      using L = Listener<BatchedSweepPtr>;
      bus.input<L, BatchedSweepPtr>(0, lidar + "/batches",
                                    [&](L&, const BatchedSweepPtr& b) { batches.push_back(b); });
      static std::vector<BatchedSweepPtr> none;
      return [] { return std::make_unique<L>(&none); };
    });
  }
  Held most;
  for (const SourceEvent& event : events) {
    if (event.topic != "tf_static") graph.advance(event.stamp - 1);
    event.publish(graph);
    batches.erase(std::remove_if(batches.begin(), batches.end(), [](const auto& b) { return b.expired(); }),
                  batches.end());
    std::size_t queued = 0;
    for (const Stage* stage : graph.stages()) queued += stage->merge().queued();
    most.sweeps = std::max(most.sweeps, batches.size());
    most.queued = std::max(most.queued, queued);
  }
  return most;
}

// An hour needs no more than a minute: what is held after 4 s is what is held after 12 s, also while there is
// no pose.
TEST(Pipeline, WhatIsHeldDoesNotGrowWithTheDrive) {
  const Held brief = mostHeld(SmallDrive(4.0, 0.2).events()),
             longer = mostHeld(SmallDrive(12.0, 0.2).events());
  EXPECT_LE(longer.sweeps, brief.sweeps + 2);
  EXPECT_LE(longer.queued, brief.queued + 10);
  EXPECT_LE(longer.sweeps, 26U) << "one second of two lidars, and what is on its way";
  for (const char* lost : {"imu/data", "gnss/fix", "lidar_right/points"}) {
    SmallDrive drive(12.0, 0.2);
    drive.drop(lost, kStart + 2 * kSecond);
    const Held without = mostHeld(drive.events());
    EXPECT_LE(without.sweeps, 40U) << lost;
    EXPECT_LE(without.queued, 2 * brief.queued + 100) << lost;
  }
}

}  // namespace
}  // namespace atlas::test
