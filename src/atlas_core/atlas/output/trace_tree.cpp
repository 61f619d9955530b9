// SPDX-License-Identifier: MIT
#include "atlas/output/trace_tree.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace atlas {
namespace {

constexpr int kDeepest = 8;  // levels; the data path has five

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// `<name>/batches` -> `<name><suffix>`.
std::string beside(const std::string& topic, const std::string& suffix) {
  return topic.substr(0, topic.rfind('/')) + suffix;
}

/// What is so in every run; nullopt for what has to be looked up.
std::optional<std::vector<Origin>> knownOrigins(const Origin& of) {
  if (endsWith(of.topic, "/batches"))
    return std::vector<Origin>{{beside(of.topic, "/points"), of.stamp, of.index, {}},
                               {"odometry", of.stamp, {}, {}}};
  if (endsWith(of.topic, "/detections"))
    return std::vector<Origin>{{beside(of.topic, "/image"), of.stamp, of.index, {}}};
  if (of.topic == "obstacles")
    return std::vector<Origin>{{"batches of the first lidar", of.stamp, {}, {}},
                               {"newest batches of the other lidars", of.stamp, {}, {}}};
  if (of.topic == "odometry")
    return std::vector<Origin>{{"imu/data around", of.stamp, {}, {}},
                               {"imu/data, gnss/fix, gnss/heading before", of.stamp, {}, {}}};
  const bool raw = endsWith(of.topic, "/points") || endsWith(of.topic, "/image") ||
                   endsWith(of.topic, "/camera_info") || of.topic.find("batches of") != std::string::npos ||
                   endsWith(of.topic, "/scan") || of.topic.rfind("imu/", 0) == 0 ||
                   of.topic.rfind("gnss/", 0) == 0;
  if (raw) return std::vector<Origin>{};
  return std::nullopt;
}

using Key = std::tuple<std::string, Stamp, std::uint32_t>;
Key keyOf(const Origin& origin) { return {origin.topic, origin.stamp, origin.index.value_or(0)}; }

/// Origins of everything below a root, level by level: one search for each level.
class Levels {
 public:
  explicit Levels(const FindOrigins& find) : find_(find) {}
  void collect(std::vector<Origin> level) {
    for (int depth = 0; depth < kDeepest && !level.empty(); ++depth) {
      std::vector<Origin> wanted;
      for (const Origin& origin : level) {
        if (origins_.count(keyOf(origin)) > 0) continue;
        const auto known = knownOrigins(origin);
        if (known) {
          origins_[keyOf(origin)] = *known;
        } else {
          wanted.push_back(origin);
        }
      }
      if (!wanted.empty()) {
        for (const ProductOrigins& row : find_(wanted)) {
          for (const Origin& origin : wanted) {
            if (row.product == origin.topic && row.stamp == origin.stamp)
              origins_[keyOf(origin)] = row.origins;
          }
        }
      }
      std::vector<Origin> next;
      for (const Origin& origin : level) {
        const auto found = origins_.find(keyOf(origin));
        if (found != origins_.end()) next.insert(next.end(), found->second.begin(), found->second.end());
      }
      level = std::move(next);
    }
  }
  /// Null when nothing is known about it.
  [[nodiscard]] const std::vector<Origin>* of(const Origin& origin) const {
    const auto found = origins_.find(keyOf(origin));
    return found == origins_.end() ? nullptr : &found->second;
  }

 private:
  const FindOrigins& find_;
  std::map<Key, std::vector<Origin>> origins_;
};

void print(const Origin& origin, const Levels& levels, int depth, std::string& text) {
  text += std::string(2 * static_cast<std::size_t>(depth), ' ') + origin.topic;
  if (origin.index) text += " #" + std::to_string(*origin.index);
  if (origin.item) text += " item " + std::to_string(*origin.item);
  text += " @ " + std::to_string(origin.stamp);
  const auto* origins = levels.of(origin);
  text += origins == nullptr ? "  (origins not written by this run)\n" : "\n";
  if (origins == nullptr || depth >= kDeepest) return;
  for (const Origin& next : *origins) print(next, levels, depth + 1, text);
}

}  // namespace

std::string traceTree(const Origin& root, const FindOrigins& find) {
  Levels levels(find);
  levels.collect({root});
  std::string text;
  print(root, levels, 0, text);
  return text;
}

}  // namespace atlas
