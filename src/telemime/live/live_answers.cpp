// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_answers.h"

#include "telemime/core/errors.h"
#include "telemime/live/live_messages.h"
#include "telemime/streaming/url.h"

namespace telemime {
namespace {

constexpr double kMs = 1000.0;

}  // namespace

std::optional<std::string> LiveAnswers::operator()(std::uint64_t client, std::string_view text) {
  try {
    return std::visit([&](const auto& command) { return carry_out(client, command); }, parse_command(text));
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

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t /*client*/, const Guide& command) {
  session().guide(command.step);
  return std::nullopt;
}

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t /*client*/, const Recalibrate& /*command*/) {
  session().recalibrate();
  return std::nullopt;
}

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t client, const AddOutput& command) {
  try {
    senders_.add(command.url);
  } catch (const Error& e) {
    const std::string shown = without_password(command.url);
    const std::string words = e.what();
    // Name the URL, so that the page can show the message next to it.
    return words_message(MessageLevel::error, words.find(shown) == std::string::npos
                                                  ? "the output \"" + shown + "\": " + words
                                                  : words);
  }
  if (hooks_.from_here(client)) {
    hooks_.keep(command.url);
  }
  return outputs_changed(true, command.url);
}

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t /*client*/, const SwitchOutputOff& command) {
  return outputs_changed(senders_.switch_off(command.url), command.url);
}

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t client, const RemoveOutput& command) {
  const bool known = senders_.remove(command.url);
  if (known && hooks_.from_here(client)) {
    hooks_.forget(command.url);
  }
  return outputs_changed(known, command.url);
}

LiveAnswers::Answer LiveAnswers::outputs_changed(bool known, const std::string& url) const {
  if (!known) {
    return words_message(MessageLevel::error, without_password(url) + " is not in the list of outputs");
  }
  hooks_.changed();
  return std::nullopt;
}

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t /*client*/, const Record& command) {
  command.on ? recorder_.start() : recorder_.stop();
  hooks_.changed();
  return std::nullopt;
}

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t /*client*/, const Forget& command) {
  if (!recorder_.forget(command.number)) {
    return words_message(MessageLevel::error, "there is no recording " + std::to_string(command.number));
  }
  hooks_.changed();
  return std::nullopt;
}

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t client, const Pictures& command) {
  hooks_.topic(client, kPicture, command.on);
  return std::nullopt;
}

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t client, const Poses& command) {
  hooks_.topic(client, kPose, command.on);
  return std::nullopt;
}

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t /*client*/, const Drawn& command) {
  const double now = kMs * clock_.now();
  const std::lock_guard lock(mutex_);
  latency_.add(now - command.stamp);
  return std::nullopt;
}

LiveAnswers::Answer LiveAnswers::carry_out(std::uint64_t /*client*/, const Ping& command) {
  return pong_message(command.id, kMs * clock_.now());
}

}  // namespace telemime
