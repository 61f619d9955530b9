// SPDX-License-Identifier: MIT
// record_to_bag RECORD -o F.bag: streams a record into a bag, messages in order of their stamps.
#include <rosbag/bag.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "atlas_ros/event_messages.hpp"
#include "open_input.hpp"
#include "progress_bar.hpp"

namespace {

/// Connection header of a topic; tf_static is latched so that `rosbag play` latches it.
boost::shared_ptr<ros::M_string> connectionHeader(const std::string& topic, const std::string& type, const std::string& md5,
                                                  const std::string& definition, bool latched) {
  auto header = boost::make_shared<ros::M_string>();
  (*header)["topic"] = topic;
  (*header)["type"] = type;
  (*header)["md5sum"] = md5;
  (*header)["message_definition"] = definition;
  (*header)["callerid"] = "/record_to_bag";
  (*header)["latching"] = latched ? "1" : "0";
  return header;
}

void writeEvent(rosbag::Bag& bag, const atlas::StreamInfo& stream, const atlas::Event& event) {
  atlas_ros::withMessage(stream.kind, event, [&](const auto& message) {
    using Message = std::remove_const_t<std::remove_reference_t<decltype(*message)>>;
    const std::string topic = "/" + stream.topic;
    const bool latched = stream.kind == atlas::StreamKind::kStaticTransforms;
    const auto header = connectionHeader(topic, ros::message_traits::DataType<Message>::value(),
                                         ros::message_traits::MD5Sum<Message>::value(),
                                         ros::message_traits::Definition<Message>::value(), latched);
    bag.write(topic, atlas_ros::toTime(event.stamp), *message, header);
  });
}

void printSummary(const atlas::RecordReader& reader, const std::map<std::string, std::uint64_t>& written) {
  for (const auto& [topic, count] : written) std::printf("%10lu  %s\n", static_cast<unsigned long>(count), topic.c_str());
  for (const auto& [name, file] : reader.report()) {
    for (const auto& [reason, count] : file.skipped) {
      std::printf("%s: %lu of %lu rows skipped: %s\n", name.c_str(), static_cast<unsigned long>(count),
                  static_cast<unsigned long>(file.rows), reason.c_str());
    }
    for (const std::string& example : file.examples) std::printf("  e.g. %s\n", example.c_str());
  }
  for (const std::string& note : reader.notes()) std::printf("note: %s\n", note.c_str());
}

int convert(const atlas_loader::InputOptions& options, const std::string& output) {
  const auto reader = atlas_loader::openInput(options);
  const std::string temporary = output + ".part";
  std::map<std::string, std::uint64_t> written;
  {
    rosbag::Bag bag(temporary, rosbag::bagmode::Write);
    bag.setCompression(rosbag::compression::LZ4);
    atlas_loader::ProgressBar bar("converting", reader->span());
    while (const auto event = reader->next()) {
      const atlas::StreamInfo& stream = reader->streams().at(event->stream);
      writeEvent(bag, stream, *event);
      ++written["/" + stream.topic];
      bar.show(event->stamp);
    }
  }
  std::filesystem::rename(temporary, output);
  printSummary(*reader, written);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Converts a record (Brno Urban Dataset, KITTI raw) into a bag.");
  atlas_loader::InputOptions options;
  std::string output;
  bool force = false;
  app.add_option("record", options.record, "folder of the record")->required();
  app.add_option("-o,--output", output, "bag to write")->required();
  app.add_option("--images", options.images, "h265 (packets as recorded), jpeg or raw")->check(CLI::IsMember({"h265", "jpeg", "raw"}));
  app.add_option("--calibration", options.calibration, "calibration folder, when the record carries none");
  app.add_option("--start", options.start_s, "skip this many seconds");
  app.add_option("--duration", options.duration_s, "convert this many seconds");
  app.add_option("--topics", options.topics, "only these topics")->delimiter(',');
  app.add_flag("--force", force, "overwrite the bag");
  CLI11_PARSE(app, argc, argv);
  if (std::filesystem::exists(output) && !force) {
    std::cerr << output << " exists; --force overwrites it\n";
    return 2;
  }
  try {
    return convert(options, output);
  } catch (const std::exception& error) {
    std::cerr << "record_to_bag: " << error.what() << "\n";
    std::filesystem::remove(output + ".part");
    return 1;
  }
}
