// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/topics.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kLongestSegment = 32;
constexpr std::string_view kBoard = "board/";

constexpr std::array<std::pair<std::string_view, TopicKind>, 4> kOfParticipant = {
    {{"pose", TopicKind::pose},
     {"state", TopicKind::state},
     {"presence", TopicKind::presence},
     {"chat", TopicKind::chat}}};

const std::string& checked(const std::string& segment) {
  if (!is_topic_segment(segment)) {
    throw Error(ErrorKind::usage, "\"" + segment + "\" cannot name a tenant, a meeting or a participant",
                "A name consists of 1 to 32 lower-case letters, digits, _ and -.");
  }
  return segment;
}

std::string prefix_of(const MeetingAddress& meeting) {
  return "r/" + checked(meeting.tenant) + "/" + checked(meeting.meeting) + "/";
}

// Each page has exactly one spelling: no sign, no leading zeros.
std::optional<int> read_page(std::string_view text) {
  int page = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), page);
  if (error != std::errc() || page < 0 || page >= kMostBoardPages || std::to_string(page) != text) {
    return std::nullopt;
  }
  return page;
}

bool take(std::string_view& text, std::string_view start) {
  if (!text.starts_with(start)) {
    return false;
  }
  text.remove_prefix(start.size());
  return true;
}

}  // namespace

bool is_topic_segment(std::string_view text) {
  return !text.empty() && text.size() <= kLongestSegment && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string topic_text(const MeetingAddress& meeting, const Topic& topic) {
  if (topic.kind == TopicKind::meeting) {
    return prefix_of(meeting) + "room";
  }
  const std::string below = prefix_of(meeting) + "p/" + checked(topic.participant) + "/";
  if (topic.kind == TopicKind::board) {
    if (topic.page < 0 || topic.page >= kMostBoardPages) {
      throw Error(ErrorKind::usage, "a board has no page " + std::to_string(topic.page));
    }
    return below + std::string(kBoard) + std::to_string(topic.page);
  }
  const auto* const named = std::find_if(kOfParticipant.begin(), kOfParticipant.end(),
                                         [&](const auto& entry) { return entry.second == topic.kind; });
  return below + std::string(named->first);
}

std::optional<Topic> read_topic(const MeetingAddress& meeting, std::string_view text) {
  if (!take(text, prefix_of(meeting))) {
    return std::nullopt;
  }
  if (text == "room") {
    return Topic{};
  }
  if (!take(text, "p/")) {
    return std::nullopt;
  }
  Topic topic;
  topic.participant = text.substr(0, text.find('/'));
  if (!is_topic_segment(topic.participant) || topic.participant.size() == text.size()) {
    return std::nullopt;
  }
  text.remove_prefix(topic.participant.size() + 1);
  for (const auto& [name, kind] : kOfParticipant) {
    if (text == name) {
      topic.kind = kind;
      return topic;
    }
  }
  if (!take(text, kBoard)) {
    return std::nullopt;
  }
  const auto page = read_page(text);
  if (!page) {
    return std::nullopt;
  }
  topic.kind = TopicKind::board;
  topic.page = *page;
  return topic;
}

std::string presence_filter(const MeetingAddress& meeting) {
  return prefix_of(meeting) + "p/+/presence";
}

std::string meeting_filter(const MeetingAddress& meeting) {
  return prefix_of(meeting) + "#";
}

std::optional<std::string> participant_of_user(const MeetingAddress& meeting, std::string_view user) {
  if (!take(user, meeting.meeting + ".") || !is_topic_segment(user)) {
    return std::nullopt;
  }
  return std::string(user);
}

}  // namespace telemime::meeting
