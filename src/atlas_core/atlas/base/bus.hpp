// SPDX-License-Identifier: MIT
// Lists of inputs and outputs of one kind, for the functions that bind a stage to a bus (local_graph.hpp).
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace atlas {

/// One output per name: `<name><suffix>`; the returned function emits on output i.
template <class T, class Bus>
std::function<void(std::size_t, const T&)> outputs(Bus& bus, const std::vector<std::string>& names,
                                                   const std::string& suffix) {
  std::vector<std::function<void(const T&)>> emits;
  emits.reserve(names.size());
  for (const std::string& name : names) emits.push_back(bus.template output<T>(name + suffix));
  return [emits](std::size_t i, const T& value) { emits.at(i)(value); };
}
/// Input first + i takes `<names[i]><suffix>`, pushed as stage.push(i, value).
template <class StageType, class T, class Bus>
void inputs(Bus& bus, std::size_t first, const std::vector<std::string>& names, const std::string& suffix) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    bus.template input<StageType, T>(first + i, names[i] + suffix,
                                     [i](StageType& s, const T& value) { s.push(i, value); });
  }
}

}  // namespace atlas
