// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "meeting/protocol/testing.h"
#include "subscriber.h"
#include "telemime/streaming/sender.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {

using testing_receivers::comes_true;

inline bool is_sending(const Sender& sender) {
  return comes_true([&] { return sender.status().state == SenderState::sending; });
}

/// Whether the sender fails with a message that contains the text.
inline bool fails_with(const Sender& sender, const std::string& text) {
  return comes_true([&] {
    const SenderStatus status = sender.status();
    return status.state == SenderState::failed && contains(status.words, text);
  });
}

/// Whether the newest presence of the participant becomes this.
inline bool is_here(const Subscriber& subscriber, const std::string& participant, bool here) {
  return comes_true([&] {
    const auto presence = subscriber.json("p/" + participant + "/presence");
    return presence.is_object() && presence.at("here") == here;
  });
}

/// Whether this message was received, even if it was not the newest.
inline bool was_published(const Subscriber& subscriber, const std::string& topic,
                          const std::string& payload) {
  return comes_true([&] {
    const std::vector<Subscriber::Received> all = subscriber.all();
    return std::any_of(all.begin(), all.end(),
                       [&](const auto& one) { return one.topic == topic && one.payload == payload; });
  });
}

/// Whether at least `count` frames of the participant arrive.
inline bool has_frames(const Subscriber& subscriber, const std::string& participant, std::size_t count) {
  return comes_true([&] { return subscriber.frames(participant).size() >= count; });
}

}  // namespace telemime::meeting::test_support
