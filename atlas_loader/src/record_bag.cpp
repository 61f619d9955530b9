// SPDX-License-Identifier: MIT
#include "record_bag.hpp"

#include <rosbag/bag.h>

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "atlas_ros/event_messages.hpp"

namespace atlas_loader {
namespace {

/// Connection header of a topic; tf_static is latched so that `rosbag play` latches it.
template <class Message>
boost::shared_ptr<ros::M_string> connectionHeader(const std::string& topic, bool latched) {
  auto header = boost::make_shared<ros::M_string>();
  (*header)["topic"] = topic;
  (*header)["type"] = ros::message_traits::DataType<Message>::value();
  (*header)["md5sum"] = ros::message_traits::MD5Sum<Message>::value();
  (*header)["message_definition"] = ros::message_traits::Definition<Message>::value();
  (*header)["callerid"] = "/record_to_bag";
  (*header)["latching"] = latched ? "1" : "0";
  return header;
}

void writeEvent(rosbag::Bag& bag, const atlas::StreamInfo& stream, const atlas::Event& event) {
  atlas_ros::withMessage(stream.kind, event, [&](const auto& message) {
    using Message = std::remove_const_t<std::remove_reference_t<decltype(*message)>>;
    const std::string topic = "/" + stream.topic;
    const bool latched = stream.kind == atlas::StreamKind::kStaticTransforms;
    bag.write(topic, atlas_ros::toTime(event.stamp), *message, connectionHeader<Message>(topic, latched));
  });
}

BagCounts writeAll(atlas::RecordReader& reader, const std::string& file,
                   const std::function<bool(atlas::Stamp)>& go_on) {
  BagCounts counts;
  rosbag::Bag bag(file, rosbag::bagmode::Write);
  bag.setCompression(rosbag::compression::LZ4);
  while (const auto event = reader.next()) {
    if (!go_on(event->stamp)) {
      counts.complete = false;
      break;
    }
    const atlas::StreamInfo& stream = reader.streams().at(event->stream);
    writeEvent(bag, stream, *event);
    ++counts.messages["/" + stream.topic];
  }
  bag.close();
  return counts;
}

std::string line(const char* format, unsigned long a, unsigned long b, unsigned long c,
                 const std::string& name) {
  char buffer[80];
  std::snprintf(buffer, sizeof buffer, format, a, b, c);
  return buffer + name;
}

}  // namespace

BagCounts writeBag(atlas::RecordReader& reader, const std::string& bag,
                   const std::function<bool(atlas::Stamp)>& go_on) {
  const std::string part = bag + ".part";
  std::error_code ignored;
  try {
    const BagCounts counts = writeAll(reader, part, go_on);
    if (counts.complete && counts.messages.empty()) {
      throw std::runtime_error("nothing to write: no message in the requested span and topics");
    }
    if (counts.complete) std::filesystem::rename(part, bag);
    return counts;
  } catch (const rosbag::BagException& error) {
    std::filesystem::remove(part, ignored);
    throw std::runtime_error("cannot write bag " + bag + ": " + error.what());
  } catch (...) {
    std::filesystem::remove(part, ignored);
    throw;
  }
}

std::vector<std::string> conversionSummary(const atlas::RecordReader& reader, const BagCounts& counts) {
  std::vector<std::string> lines = {"  messages  topic"};
  for (const auto& [topic, n] : counts.messages) lines.push_back(line("%10lu  ", n, 0, 0, topic));
  lines.emplace_back("      rows       used    skipped  file");
  for (const auto& [name, file] : reader.report()) {
    lines.push_back(line("%10lu %10lu %10lu  ", file.rows, file.used, file.rows - file.used, name));
    for (const auto& [reason, n] : file.skipped) lines.push_back(line("%32lu  ", n, 0, 0, "  " + reason));
    for (const std::string& example : file.examples)
      lines.push_back(std::string(34, ' ') + "  e.g. " + example);
  }
  for (const std::string& note : reader.notes()) lines.push_back("note: " + note);
  return lines;
}

}  // namespace atlas_loader
