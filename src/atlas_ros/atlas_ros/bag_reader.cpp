// SPDX-License-Identifier: MIT
#include "atlas_ros/bag_reader.hpp"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <map>
#include <queue>
#include <stdexcept>

#include "atlas_ros/event_messages.hpp"

namespace atlas_ros {
namespace {

std::string withoutSlash(const std::string& topic) {
  return topic.rfind('/', 0) == 0 ? topic.substr(1) : topic;
}

class BagReader : public atlas::RecordReader {
 public:
  BagReader(const std::string& path, const BagOptions& options) : path_(path), options_(options) {
    try {
      bag_.open(path, rosbag::bagmode::Read);
    } catch (const rosbag::BagException& error) {
      throw std::runtime_error("cannot open bag " + path + ": " + error.what());
    }
    collectStreams();
    readStaticTransforms();
    rosbag::View whole(bag_);
    if (whole.size() > 0) span_ = {fromTime(whole.getBeginTime()), fromTime(whole.getEndTime())};
    // Without a start nothing is cut off: what was measured before the first record time belongs to the bag
    // too.
    if (options.start_s > 0) begin_ = span_.first + atlas::fromSeconds(options.start_s);
    end_ = options.duration_s < 0 ? atlas::kEndOfTime
                                  : std::max(begin_, span_.first) + atlas::fromSeconds(options.duration_s);
    std::vector<std::string> topics;
    for (const auto& [topic, stream] : stream_of_) topics.push_back(topic);
    view_.addQuery(bag_, rosbag::TopicQuery(topics), begin_ > 0 ? toTime(begin_) : ros::TIME_MIN,
                   ros::TIME_MAX);
    next_ = view_.begin();
  }

  const std::vector<atlas::StreamInfo>& streams() const override { return streams_; }
  std::pair<atlas::Stamp, atlas::Stamp> span() const override { return span_; }
  std::vector<std::string> notes() const override { return notes_; }
  std::map<std::string, atlas::FileReport> report() const override { return report_; }

  std::optional<atlas::Event> next() override {
    if (!transforms_given_) {
      transforms_given_ = true;
      if (!transforms_.transforms.empty()) return atlas::Event{std::max(begin_, span_.first), 0, transforms_};
    }
    while (next_ != view_.end() && !nextIsDue()) take();
    if (buffer_.empty()) return std::nullopt;
    atlas::Event event = std::move(const_cast<Buffered&>(buffer_.top()).event);
    buffer_.pop();
    given_ = event.stamp;
    return event;
  }

 private:
  struct Buffered {
    std::uint64_t sequence;
    atlas::Event event;
    bool operator<(const Buffered& other) const {  // std::priority_queue gives the largest first
      return std::tie(event.stamp, event.stream, sequence) >
             std::tie(other.event.stamp, other.event.stream, other.sequence);
    }
  };

  bool nextIsDue() const {
    return !buffer_.empty() && buffer_.top().event.stamp + atlas::fromSeconds(options_.reorder_s) < recorded_;
  }

  void collectStreams() {
    streams_.push_back({"tf_static", atlas::StreamKind::kStaticTransforms, 0});
    rosbag::View whole(bag_);
    std::map<std::string, std::string>
        types;  // sorted by topic: the same order for every bag of the same topics
    for (const rosbag::ConnectionInfo* connection : whole.getConnections())
      types[connection->topic] = connection->datatype;
    for (const auto& [topic, datatype] : types) {
      const auto kind = kindOf(topic, datatype);
      if (!kind) {
        notes_.push_back("topic " + topic + " (" + datatype + ") is not used");
        continue;
      }
      const std::string name = withoutSlash(topic);
      const bool wanted = options_.topics.empty() || std::find(options_.topics.begin(), options_.topics.end(),
                                                               name) != options_.topics.end();
      if (*kind == atlas::StreamKind::kStaticTransforms || !wanted) continue;
      stream_of_[topic] = streams_.size();
      rosbag::View count(bag_, rosbag::TopicQuery(topic));
      streams_.push_back({name, *kind, count.size()});
    }
  }

  void readStaticTransforms() {
    for (const rosbag::MessageInstance& m : rosbag::View(bag_, rosbag::TypeQuery("tf2_msgs/TFMessage"))) {
      if (kindOf(m.getTopic(), m.getDataType()) == std::nullopt) continue;
      atlas::FileReport& file = report_["tf_static"];
      ++file.rows;
      const auto transforms = fromMsg(*m.instantiate<tf2_msgs::TFMessage>());
      if (!transforms) {
        ++file.skipped[toString(transforms.reason())];
        continue;
      }
      ++file.used;
      transforms_.transforms.insert(transforms_.transforms.end(), transforms->transforms.begin(),
                                    transforms->transforms.end());
    }
  }

  void take() {
    const rosbag::MessageInstance& m = *next_;
    recorded_ = std::max(recorded_, fromTime(m.getTime()));
    const std::size_t stream = stream_of_.at(m.getTopic());
    const atlas::StreamKind kind = streams_[stream].kind;
    atlas::FileReport& file = report_[streams_[stream].topic];
    ++file.rows;
    withMessageType(kind, [&](auto* type) {
      using Message = std::remove_pointer_t<decltype(type)>;
      takeMessage(*m.instantiate<Message>(), kind, stream, file);
    });
    ++next_;
  }

  template <class Message>
  void takeMessage(const Message& msg, atlas::StreamKind kind, std::size_t stream, atlas::FileReport& file) {
    const atlas::Stamp stamp = stampOf(msg);
    auto payload = toPayload(kind, msg);
    if (!payload) {
      skip(file, toString(payload.reason()), stream, stamp);
    } else if (stamp < given_) {
      skip(file, toString(atlas::Reason::kOutOfOrder), stream, stamp);
    } else if (stamp < begin_ || stamp > end_) {
      ++file.skipped["outside of start and duration"];
    } else {
      ++file.used;
      buffer_.push({sequence_++, {stamp, stream, *payload}});
    }
  }

  void skip(atlas::FileReport& file, const std::string& reason, std::size_t stream, atlas::Stamp stamp) {
    ++file.skipped[reason];
    constexpr std::size_t kExamples = 3;
    if (file.examples.size() < kExamples) {
      file.examples.push_back(streams_[stream].topic + " at " + std::to_string(stamp) + ": " + reason);
    }
  }

  std::string path_;
  BagOptions options_;
  rosbag::Bag bag_;
  rosbag::View view_;
  rosbag::View::iterator next_;
  std::vector<atlas::StreamInfo> streams_;
  std::map<std::string, std::size_t> stream_of_;  ///< by topic as in the bag
  atlas::StaticTransforms transforms_;
  bool transforms_given_ = false;
  std::priority_queue<Buffered> buffer_;
  std::uint64_t sequence_ = 0;
  atlas::Stamp recorded_ = atlas::kBeginOfTime;  ///< time in the bag of the newest message taken
  atlas::Stamp given_ = atlas::kBeginOfTime;
  atlas::Stamp begin_ = 0, end_ = atlas::kEndOfTime;
  std::pair<atlas::Stamp, atlas::Stamp> span_{0, 0};
  std::map<std::string, atlas::FileReport> report_;
  std::vector<std::string> notes_;
};

}  // namespace

std::unique_ptr<atlas::RecordReader> openBag(const std::string& path, const BagOptions& options) {
  return std::make_unique<BagReader>(path, options);
}

}  // namespace atlas_ros
