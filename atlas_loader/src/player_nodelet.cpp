// SPDX-License-Identifier: MIT
// Nodelet: plays a bag or a record into the graph, paced by the progress of the stages (rate 0: as fast as
// they go).
#include <nodelet/nodelet.h>
#include <rosgraph_msgs/Clock.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>
#include <tf2_msgs/TFMessage.h>

#include <atomic>
#include <chrono>
#include <pluginlib/class_list_macros.hpp>
#include <thread>

#include "atlas_ros/conversions.hpp"
#include "atlas_ros/param_reader.hpp"
#include "open_input.hpp"
#include "run_report.hpp"
#include "run_source.hpp"

namespace atlas_loader {

class PlayerNodelet : public nodelet::Nodelet {
 public:
  ~PlayerNodelet() override {
    stop_ = true;
    if (worker_.joinable()) worker_.join();
  }

 private:
  void onInit() override try {
    atlas_ros::ParamReader params(getPrivateNodeHandle());
    params.readOptional("bag", input_.bag);
    params.readOptional("record", input_.record);
    params.readOptional("calibration", input_.calibration);
    params.readOptional("start_s", input_.start_s);
    params.readOptional("duration_s", input_.duration_s);
    params.readOptional("rate", rate_);
    params.readOptional("out", out_);
    params.readOptional("exit_at_end", exit_at_end_);
    params.readOptional("paused", paused_);
    RunSourceParams source;
    params.read("stages", source.stages);
    std::vector<std::string> more_stages;  // those that are not always there
    params.readOptional("more_stages", more_stages);
    source.stages.insert(source.stages.end(), more_stages.begin(), more_stages.end());
    params.readOptional("lead_s", source.lead_s);
    params.readOptional("graph_timeout_s", source.graph_timeout_s);
    params.rejectUnread();
    if (!(rate_ >= 0.0))
      throw std::invalid_argument("rate must not be negative, got " + std::to_string(rate_));
    reader_ = openInput(input_);
    source_ = std::make_unique<RunSource>(getNodeHandle(), source);
    source_->advertise(reader_->streams());
    clock_ = getNodeHandle().advertise<rosgraph_msgs::Clock>("/clock", 10);
    tf_static_ = getNodeHandle().advertise<tf2_msgs::TFMessage>("/tf_static", 10, true);
    pause_ = getPrivateNodeHandle().advertiseService("pause", &PlayerNodelet::onPause, this);
    step_ = getPrivateNodeHandle().advertiseService("step", &PlayerNodelet::onStep, this);
    worker_ = std::thread([this] { run(); });
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    throw;  // the manager refuses the nodelet
  }

  bool onPause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
    paused_ = request.data != 0;
    response.success = true;
    return true;
  }
  /// One event while paused.
  bool onStep(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    response.success = paused_;
    if (paused_) ++steps_;
    return true;
  }

  void run() {
    RunReport report(input_, out_, "nodelets");
    report.readConfiguration(getNodeHandle().getNamespace());
    bool ok = false;
    try {
      source_->awaitGraph();
      source_->begin(0);
      NODELET_INFO("the graph is complete, replay begins");
      ok = play() && source_->end();
      if (!ok && !source_->failure().empty()) NODELET_FATAL("the run failed: %s", source_->failure().c_str());
    } catch (const std::exception& error) {
      report.fail(error.what());
      NODELET_FATAL("%s", error.what());
    }
    report.finish(*source_, reader_.get(), ok);
    for (const std::string& line : report.lines()) NODELET_INFO("%s", line.c_str());
    if (exit_at_end_ && !stop_) ros::requestShutdown();
  }

  bool play() {
    const auto begin = std::chrono::steady_clock::now();
    atlas::Stamp first = atlas::kBeginOfTime;
    while (auto event = reader_->next()) {
      if (event->stream == 0) {
        tf_static_.publish(atlas_ros::toMsg(std::get<atlas::StaticTransforms>(event->payload), event->stamp));
      }
      if (first == atlas::kBeginOfTime) first = event->stamp;
      if (!awaitTurn(begin, event->stamp - first)) return false;
      if (!source_->publish(*event)) return false;
      publishClock(event->stamp);
    }
    return true;
  }

  /// Sleeps for the wanted rate and while paused. The order and content of the events do not depend on it.
  bool awaitTurn(std::chrono::steady_clock::time_point begin, atlas::Duration since_first) {
    while (!stop_ && ros::ok()) {
      if (paused_) {
        if (steps_ > 0) {
          --steps_;
          return true;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        continue;
      }
      if (rate_ <= 0.0) return true;
      const auto due = begin + std::chrono::nanoseconds(
                                   static_cast<std::int64_t>(static_cast<double>(since_first) / rate_));
      const auto left = due - std::chrono::steady_clock::now();
      if (left <= std::chrono::nanoseconds(0)) return true;
      std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(left, std::chrono::milliseconds(100)));
    }
    return false;
  }

  void publishClock(atlas::Stamp stamp) {
    constexpr atlas::Duration kClockStep = 10 * atlas::kMillisecond;
    if (clock_stamp_ != atlas::kBeginOfTime && stamp < clock_stamp_ + kClockStep) return;
    clock_stamp_ = stamp;
    rosgraph_msgs::Clock msg;
    msg.clock = atlas_ros::toTime(stamp);
    clock_.publish(msg);
  }

  InputOptions input_;
  double rate_ = 1.0;
  std::string out_;
  bool exit_at_end_ = true;
  bool paused_ = false;
  std::atomic<int> steps_{0};
  std::atomic<bool> stop_{false};
  std::unique_ptr<atlas::RecordReader> reader_;
  std::unique_ptr<RunSource> source_;
  ros::Publisher clock_, tf_static_;
  ros::ServiceServer pause_, step_;
  atlas::Stamp clock_stamp_ = atlas::kBeginOfTime;
  std::thread worker_;
};

}  // namespace atlas_loader

PLUGINLIB_EXPORT_CLASS(atlas_loader::PlayerNodelet, nodelet::Nodelet)
