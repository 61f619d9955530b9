// SPDX-License-Identifier: MIT
// A message that carries the value it was made from. Nodelets of one manager get the very same message
// object, so a stage there takes the value instead of making it again from the message; whoever gets the
// message through a socket has the bytes only. A sweep has five receivers and 1.7 MB.
#pragma once

#include <boost/make_shared.hpp>
#include <utility>

namespace atlas_ros {

/// What deletes the message; the shared pointer's own place for it is where the value travels.
template <class Message, class T>
struct Carrier {
  boost::shared_ptr<Message> message;
  T value;
  void operator()(const Message* /*the same*/) { message.reset(); }
};

template <class Message, class T>
boost::shared_ptr<Message> carrying(Message message, const T& value) {
  const auto owner = boost::make_shared<Message>(std::move(message));
  return boost::shared_ptr<Message>(owner.get(), Carrier<Message, T>{owner, value});
}

/// nullptr when the message carries no value of this type.
template <class T, class Message>
const T* carriedBy(const boost::shared_ptr<const Message>& message) {
  const auto* carrier = boost::get_deleter<Carrier<Message, T>>(message);
  return carrier != nullptr ? &carrier->value : nullptr;
}

}  // namespace atlas_ros
