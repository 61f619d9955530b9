// SPDX-License-Identifier: MIT
// Reads a nodelet's private parameters into a core params struct. Every key must be present, every present
// key must be read: a typo or a dead key cannot survive (the idea of cartographer's
// CheckAllKeysWereUsedExactlyOnce).
#pragma once

#include <ros/node_handle.h>

#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace atlas_ros {

class ParamReader {
 public:
  explicit ParamReader(ros::NodeHandle private_handle) : handle_(std::move(private_handle)) {}

  /// Throws std::invalid_argument naming the parameter when it is missing or of another type.
  template <class T>
  void read(const std::string& key, T& value) {
    const std::string name = handle_.resolveName(key);
    if (!handle_.hasParam(key)) throw std::invalid_argument("missing parameter " + name);
    if (!handle_.getParam(key, value))
      throw std::invalid_argument("parameter " + name + " has the wrong type");
    read_.insert(name);
  }
  /// A key that may be absent: `value` keeps its default.
  template <class T>
  void readOptional(const std::string& key, T& value) {
    if (handle_.hasParam(key)) read(key, value);
  }
  /// Throws std::invalid_argument naming the first private parameter that nobody read.
  void rejectUnread() const {
    const std::string prefix = handle_.getNamespace() + "/";
    std::vector<std::string> names;
    handle_.getParamNames(names);
    for (const std::string& name : names) {
      if (name.compare(0, prefix.size(), prefix) == 0 && !isRead(name)) {
        throw std::invalid_argument("unknown parameter " + name);
      }
    }
  }

 private:
  /// Itself, or the map that it is an entry of.
  [[nodiscard]] bool isRead(std::string name) const {
    for (std::size_t end = name.size(); end != std::string::npos; end = name.rfind('/')) {
      name.resize(end);
      if (read_.count(name) > 0) return true;
    }
    return false;
  }

  ros::NodeHandle handle_;
  std::set<std::string> read_;
};

}  // namespace atlas_ros
