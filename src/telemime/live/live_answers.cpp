// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_answers.h"

#include "telemime/core/errors.h"
#include "telemime/live/live_messages.h"
#include "telemime/streaming/url.h"

namespace telemime {
namespace {

constexpr double kMs = 1000.0;

/// Functions of which std::visit chooses the one for the type.
template <class... Functions>
struct OneOf : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
OneOf(Functions...) -> OneOf<Functions...>;

}  // namespace

std::optional<std::string> LiveAnswers::operator()(std::uint64_t client, std::string_view text) {
  try {
    return carry_out(client, parse_command(text));
  } catch (const Error& e) {
    return words_message(MessageLevel::error, e.what());
  }
}

std::optional<LatencyRecord::Summary> LiveAnswers::latency() const {
  const std::lock_guard lock(mutex_);
  return latency_.summary();
}

LiveSession& LiveAnswers::session() const {
  LiveSession* const session = session_;
  if (session == nullptr) {
    throw Error(ErrorKind::usage, "Telemime is still starting", "Try again in a moment.");
  }
  return *session;
}

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t client, const Command& command) {
  Answer answer;
  std::visit(OneOf{[&](const Guide& c) { session().guide(c.step); },
                   [&](const Recalibrate&) { session().recalibrate(); },
                   [&](const AddOutput& c) { answer = add_output(client, c.url); },
                   [&](const SwitchOutputOff& c) { answer = changed(senders_.switch_off(c.url), c.url); },
                   [&](const RemoveOutput& c) {
                     const bool known = senders_.remove(c.url);
                     if (known && hooks_.from_here(client)) {
                       hooks_.forget(c.url);
                     }
                     answer = changed(known, c.url);
                   },
                   [&](const Record& c) {
                     c.on ? recorder_.start() : recorder_.stop();
                     hooks_.changed();
                   },
                   [&](const Forget& c) {
                     if (recorder_.forget(c.number)) {
                       hooks_.changed();
                     } else {
                       answer = words_message(MessageLevel::error,
                                              "there is no recording " + std::to_string(c.number));
                     }
                   },
                   [&](const Pictures& c) { hooks_.topic(client, kPicture, c.on); },
                   [&](const Poses& c) { hooks_.topic(client, kPose, c.on); },
                   [&](const Drawn& c) {
                     const double now = kMs * clock_.now();
                     const std::lock_guard lock(mutex_);
                     latency_.add(now - c.stamp);
                   },
                   [&](const Ping& c) { answer = pong_message(c.id, kMs * clock_.now()); }},
             command);
  return answer;
}

LiveAnswers::Answer LiveAnswers::add_output(std::uint64_t client, const std::string& url) {
  bool is_new = false;
  try {
    is_new = senders_.add(url);
  } catch (const Error& e) {
    const std::string shown = without_password(url);
    const std::string words = e.what();
    // Name the URL, so that the page can show the message next to it.
    return words_message(MessageLevel::error, words.find(shown) == std::string::npos
                                                  ? "the output \"" + shown + "\": " + words
                                                  : words);
  }
  // One that was paused is saved already, or was not to be: of the command line, or added from another
  // computer.
  if (is_new && hooks_.from_here(client)) {
    hooks_.keep(url);
  }
  return changed(true, url);
}

LiveAnswers::Answer LiveAnswers::changed(bool known, const std::string& url) const {
  if (!known) {
    return words_message(MessageLevel::error, without_password(url) + " is not in the list of outputs");
  }
  hooks_.changed();
  return std::nullopt;
}

}  // namespace telemime
