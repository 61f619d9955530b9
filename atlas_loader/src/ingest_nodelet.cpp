// SPDX-License-Identifier: MIT
// Nodelet: the source of the graph when the data comes from topics (`rosbag play --clock`, other nodes) and
// not from our player.
#include <nodelet/nodelet.h>

#include <atomic>
#include <pluginlib/class_list_macros.hpp>
#include <thread>

#include "atlas_ros/event_messages.hpp"
#include "atlas_ros/param_reader.hpp"
#include "atlas_ros/stage_link.hpp"
#include "ingest.hpp"
#include "run_report.hpp"
#include "run_source.hpp"

namespace atlas_loader {

class IngestNodelet : public nodelet::Nodelet {
 public:
  ~IngestNodelet() override {
    if (ingest_) ingest_->stop();
    stop_ = true;
    if (worker_.joinable()) worker_.join();
  }

 private:
  void onInit() override try {
    atlas_ros::ParamReader params(getPrivateNodeHandle());
    RunSourceParams source;
    double max_delay_s = 2.0;
    params.read("stages", source.stages);
    std::vector<std::string> more_stages;  // those that are not always there
    params.readOptional("more_stages", more_stages);
    source.stages.insert(source.stages.end(), more_stages.begin(), more_stages.end());
    params.readOptional("lead_s", source.lead_s);
    params.readOptional("graph_timeout_s", source.graph_timeout_s);
    params.readOptional("max_delay_s", max_delay_s);
    params.readOptional("input_namespace", input_namespace_);
    params.readOptional("out", out_);
    params.readOptional("exit_at_end", exit_at_end_);
    params.rejectUnread();
    if (!(max_delay_s > 0))
      throw std::invalid_argument("max_delay_s must be positive, got " + std::to_string(max_delay_s));
    max_delay_ = atlas::fromSeconds(max_delay_s);
    source_ = std::make_unique<RunSource>(getNodeHandle(), source);
    watch_ = getNodeHandle().createWallTimer(ros::WallDuration(0.1), &IngestNodelet::onWatch, this);
    worker_ = std::thread([this] { run(); });
  } catch (const std::exception& error) {
    NODELET_FATAL("%s", error.what());
    throw;
  }

  /// Subscribes what the stages want; runs in the worker, before any event.
  void subscribeWanted() {
    source_->awaitGraph();
    std::vector<atlas::StreamInfo> streams{{"tf_static", atlas::StreamKind::kStaticTransforms, 0}};
    for (const std::string& topic : source_->wantedTopics()) {
      const auto kind = kindOfTopicName(topic);
      if (kind && *kind != atlas::StreamKind::kStaticTransforms) streams.push_back({topic, *kind, 0});
    }
    source_->advertise(streams);
    source_->awaitGraph();
    ingest_ = std::make_unique<Ingest>(streams, max_delay_);
    for (std::size_t i = 0; i < streams.size(); ++i) {
      atlas_ros::withMessageType(streams[i].kind, [&](auto* type) { subscribe(i, streams[i], type); });
    }
    NODELET_INFO("ready for %zu topics below %s", streams.size(), input_namespace_.c_str());
  }

  template <class Message>
  void subscribe(std::size_t index, const atlas::StreamInfo& stream, Message*) {
    const std::string topic = input_namespace_ + stream.topic;
    const atlas::StreamKind kind = stream.kind;
    subscribers_.push_back(getNodeHandle().subscribe<Message>(
        topic, atlas_ros::kKeepAll,
        boost::function<void(const boost::shared_ptr<const Message>&)>(
            [this, index, kind, topic](const boost::shared_ptr<const Message>& message) {
              auto payload = atlas_ros::toPayload(kind, *message);
              if (payload) {
                ingest_->push(index, atlas_ros::stampOf(*message), *payload);
              } else {
                ++skipped_[topic + ": " + toString(payload.reason())];
              }
            })));
  }

  /// The end of the data: publishers were there and have gone. Seen twice in a row in the callback queue, so
  /// that every message that arrived before has been handled.
  void onWatch(const ros::WallTimerEvent&) {
    if (!subscribed_) return;
    bool any = false;
    for (const ros::Subscriber& subscriber : subscribers_) any = any || subscriber.getNumPublishers() > 0;
    gone_ = any || ingest_->received() == 0 || ended_ ? 0 : gone_ + 1;
    if (any && ended_) ended_ = false;
    if (gone_ < 3) return;
    ended_ = true;
    gone_ = 0;
    ingest_->finish();
  }

  void run() {
    try {
      subscribeWanted();
      subscribed_ = true;
      for (std::uint32_t epoch = 0; runEpoch(epoch); ++epoch) {
      }
    } catch (const std::exception& error) {
      NODELET_FATAL("%s", error.what());
    }
    if (exit_at_end_ && !stop_) ros::requestShutdown();
  }

  /// False when there will be no further epoch.
  bool runEpoch(std::uint32_t epoch) {
    auto item = ingest_->pop();  // the epoch begins with its first event
    if (!item) return false;
    RunReport report({}, out_, "topics");
    report.readConfiguration(getNodeHandle().getNamespace());
    source_->begin(epoch);
    bool ok = true;
    while (item && item->kind == Ingest::Item::Kind::kEvent && ok) {
      ok = source_->publish(*item->event);
      if (ok) item = ingest_->pop();
    }
    if (!item) ok = false;
    const bool looped = item && item->kind == Ingest::Item::Kind::kEndOfEpoch;
    if (looped) NODELET_WARN("time jumped back: the stages begin afresh (epoch %u)", epoch + 1);
    ok = ok && source_->end();
    for (const auto& [what, count] : skipped_)
      report.note("skipped " + std::to_string(count) + " of " + what);
    if (ingest_->late() > 0)
      report.note(std::to_string(ingest_->late()) + " messages came too late for their place in time");
    report.finish(*source_, nullptr, ok);
    for (const std::string& line : report.lines()) NODELET_INFO("%s", line.c_str());
    return ok && (looped || !exit_at_end_);
  }

  std::string input_namespace_ = "/";
  std::string out_;
  bool exit_at_end_ = false;
  atlas::Duration max_delay_ = 0;
  std::unique_ptr<RunSource> source_;
  std::unique_ptr<Ingest> ingest_;
  std::vector<ros::Subscriber> subscribers_;
  std::map<std::string, std::uint64_t> skipped_;
  ros::WallTimer watch_;
  int gone_ = 0;
  std::atomic<bool> ended_{false}, subscribed_{false}, stop_{false};
  std::thread worker_;
};

}  // namespace atlas_loader

PLUGINLIB_EXPORT_CLASS(atlas_loader::IngestNodelet, nodelet::Nodelet)
