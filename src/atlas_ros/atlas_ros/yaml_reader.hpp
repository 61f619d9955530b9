// SPDX-License-Identifier: MIT
// ParamReader's twin for a YAML file without a ROS master: every key present, every present key read.
#pragma once

#include <yaml-cpp/yaml.h>

#include <set>
#include <stdexcept>
#include <string>
#include <utility>

namespace atlas_ros {

class YamlReader {
 public:
  /// `name` is used in messages, e.g. "bud.yaml: deskew".
  YamlReader(YAML::Node node, std::string name) : node_(std::move(node)), name_(std::move(name)) {
    if (!node_ || !node_.IsMap()) throw std::invalid_argument(name_ + ": missing or not a map");
  }
  template <class T>
  void read(const std::string& key, T& value) {
    const YAML::Node field = node_[key];
    if (!field) throw std::invalid_argument(name_ + ": missing parameter " + key);
    try {
      value = field.as<T>();
    } catch (const YAML::Exception&) {
      throw std::invalid_argument(name_ + ": parameter " + key + " has the wrong type");
    }
    read_.insert(key);
  }
  template <class T>
  void readOptional(const std::string& key, T& value) {
    if (node_[key]) read(key, value);
  }
  void rejectUnread() const {
    for (const auto& entry : node_) {
      const auto key = entry.first.as<std::string>();
      if (read_.count(key) == 0) throw std::invalid_argument(name_ + ": unknown parameter " + key);
    }
  }

 private:
  YAML::Node node_;
  std::string name_;
  std::set<std::string> read_;
};

/// A configuration file; what is wrong with it is said with its name (std::invalid_argument).
inline YAML::Node loadConfiguration(const std::string& file) {
  YAML::Node root;
  try {
    root = YAML::LoadFile(file);
  } catch (const YAML::Exception& error) {
    throw std::invalid_argument("configuration " + file + ": " + error.what());
  }
  if (!root.IsMap()) throw std::invalid_argument("configuration " + file + ": not a map of sections");
  return root;
}
/// Parameters in `section` of the configuration in `file`; `params` are those that may stay away.
template <class Params>
Params readSection(const YAML::Node& configuration, const std::string& file, const std::string& section,
                   Params params = {}) {
  YamlReader reader(configuration[section], file + ": " + section);
  readParams(reader, params);
  reader.rejectUnread();
  return params;
}

}  // namespace atlas_ros
