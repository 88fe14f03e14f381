// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/commands.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLongestUrl = 2000;
constexpr int kDeepest = 8;  // twice that of any valid message

[[noreturn]] void refuse(const std::string& why) {
  throw Error(ErrorKind::usage, "invalid message: " + why);
}

const Json& field(const Json& message, const char* name) {
  const auto found = message.find(name);
  if (found == message.end()) {
    refuse(std::string("missing field ") + name);
  }
  return *found;
}

bool truth(const Json& message, const char* name) {
  const Json& value = field(message, name);
  if (!value.is_boolean()) {
    refuse(std::string(name) + " is not true or false");
  }
  return value.get<bool>();
}

std::string text(const Json& message, const char* name) {
  const Json& value = field(message, name);
  if (!value.is_string() || value.get_ref<const std::string&>().size() > kLongestUrl) {
    refuse(std::string(name) + " is not a text of at most 2000 characters");
  }
  return value.get<std::string>();
}

std::int64_t whole(const Json& message, const char* name, std::int64_t most) {
  const Json& value = field(message, name);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > static_cast<std::uint64_t>(most)) {
    refuse(std::string(name) + " is not a whole number up to " + std::to_string(most));
  }
  return value.get<std::int64_t>();
}

Command guide(const Json& message) {
  constexpr std::array<std::pair<const char*, GuideStep>, 3> kSteps = {
      {{"empty", GuideStep::empty}, {"skip", GuideStep::skip}, {"again", GuideStep::again}}};
  const std::string step = text(message, "step");
  for (const auto& [name, value] : kSteps) {
    if (step == name) {
      return Guide{value};
    }
  }
  refuse("step is not empty, skip or again");
}

Command output(const Json& message) {
  if (message.contains("add")) {
    return AddOutput{text(message, "add")};
  }
  if (message.contains("off")) {
    return SwitchOutputOff{text(message, "off")};
  }
  return RemoveOutput{text(message, "remove")};
}

Command drawn(const Json& message) {
  constexpr std::int64_t kMost = std::int64_t{1} << 53;  // largest exact integer in JavaScript
  const Json& stamp = field(message, "stamp");
  if (!stamp.is_number() || !std::isfinite(stamp.get<double>())) {
    refuse("stamp is not a number");
  }
  return Drawn{whole(message, "frame", kMost), stamp.get<double>()};
}

constexpr std::array<std::pair<const char*, Command (*)(const Json&)>, 9> kCommands = {{
    {"guide", guide},
    {"recalibrate", [](const Json&) -> Command { return Recalibrate{}; }},
    {"output", output},
    {"record", [](const Json& m) -> Command { return Record{truth(m, "on")}; }},
    {"forget",
     [](const Json& m) -> Command { return Forget{static_cast<int>(whole(m, "recording", 1000000))}; }},
    {"pictures", [](const Json& m) -> Command { return Pictures{truth(m, "on")}; }},
    {"poses", [](const Json& m) -> Command { return Poses{truth(m, "on")}; }},
    {"drawn", drawn},
    {"ping", [](const Json& m) -> Command { return Ping{whole(m, "id", std::int64_t{1} << 53)}; }},
}};

}  // namespace

Command parse_command(std::string_view text_of) {
  bool too_deep = false;
  const auto shallow = [&too_deep](int depth, Json::parse_event_t /*event*/, Json& /*value*/) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  const Json message = Json::parse(text_of, shallow, /*allow_exceptions=*/false);
  if (too_deep) {
    refuse("nested too deep");
  }
  if (!message.is_object()) {
    refuse("not a JSON object");
  }
  const std::string type = text(message, "type");
  for (const auto& [name, parse] : kCommands) {
    if (type == name) {
      return parse(message);
    }
  }
  refuse("unknown type");
}

}  // namespace telemime
