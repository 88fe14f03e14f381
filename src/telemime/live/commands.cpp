// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/commands.h"

#include <array>
#include <utility>

#include "telemime/core/json_field.h"

namespace telemime {
namespace {

constexpr std::size_t kLongestText = 2000;             // bytes
constexpr std::int64_t kMost = std::int64_t{1} << 53;  // largest exact integer in JavaScript

Command guide(const JsonField& message) {
  constexpr std::array<std::pair<const char*, GuideStep>, 3> kSteps = {
      {{"empty", GuideStep::empty}, {"skip", GuideStep::skip}, {"again", GuideStep::again}}};
  const std::string step = message["step"].text(kLongestText);
  for (const auto& [name, value] : kSteps) {
    if (step == name) {
      return Guide{value};
    }
  }
  message["step"].fail("is not empty, skip or again");
}

Command output(const JsonField& message) {
  if (message.has("add")) {
    return AddOutput{message["add"].text(kLongestText)};
  }
  if (message.has("off")) {
    return SwitchOutputOff{message["off"].text(kLongestText)};
  }
  return RemoveOutput{message["remove"].text(kLongestText)};
}

constexpr std::array<std::pair<const char*, Command (*)(const JsonField&)>, 9> kCommands = {{
    {"guide", guide},
    {"recalibrate", [](const JsonField&) -> Command { return Recalibrate{}; }},
    {"output", output},
    {"record", [](const JsonField& m) -> Command { return Record{m["on"].boolean()}; }},
    {"forget",
     [](const JsonField& m) -> Command {
       return Forget{static_cast<int>(m["recording"].integer(0, 1000000))};
     }},
    {"pictures", [](const JsonField& m) -> Command { return Pictures{m["on"].boolean()}; }},
    {"poses", [](const JsonField& m) -> Command { return Poses{m["on"].boolean()}; }},
    {"drawn",
     [](const JsonField& m) -> Command {
       return Drawn{m["frame"].integer(0, kMost), m["stamp"].number()};
     }},
    {"ping", [](const JsonField& m) -> Command { return Ping{m["id"].integer(0, kMost)}; }},
}};

}  // namespace

Command parse_command(std::string_view text) {
  // Twice as deep as any valid message.
  const JsonSource source{.name = "invalid message", .kind = ErrorKind::usage, .remedy = "", .deepest = 8};
  const auto json = parse_json(text, source);
  const JsonField message(json, source);
  const std::string type = message["type"].text(kLongestText);
  for (const auto& [name, parse] : kCommands) {
    if (type == name) {
      return parse(message);
    }
  }
  message["type"].fail("is unknown");
}

}  // namespace telemime
