// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/mqtt_key.h"

#include <sys/stat.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "meeting/transport/files.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLongestFile = 4096;  // bytes
constexpr std::size_t kLongestText = 256;   // bytes, of user and password

[[noreturn]] void unusable(const std::filesystem::path& file, const std::string& why) {
  throw Error(ErrorKind::usage, "the key file " + file.string() + " cannot be used: " + why,
              R"(It holds {"user": "...", "password": "..."}.)");
}

bool is_key_text(const std::string& text) {
  return !text.empty() && text.size() <= kLongestText && text.find('\0') == std::string::npos;
}

// MQTT has them as UTF-8; the JSON reader has checked that of the file, and the URL is plain.
MqttKey checked(MqttKey key, const std::string& where) {
  if (!is_key_text(key.user) || !is_key_text(key.password)) {
    throw Error(ErrorKind::usage, where + " holds no user and password of 1 to 256 bytes");
  }
  return key;
}

}  // namespace

MqttKey read_key_file(const std::filesystem::path& file) {
  const SmallFile read = [&file] {
    try {
      return read_small_file(file, kLongestFile);
    } catch (const std::runtime_error& e) {
      unusable(file, e.what());
    }
  }();
  const Json json = Json::parse(
      read.content, [](int depth, Json::parse_event_t, Json&) { return depth < 4; },
      /*allow_exceptions=*/false);
  const auto text = [&json](const char* name) {
    return json.is_object() && json.contains(name) && json[name].is_string() ? json[name].get<std::string>()
                                                                             : std::string();
  };
  MqttKey key{text("user"), text("password"), ""};
  if (!is_key_text(key.user) || !is_key_text(key.password)) {
    unusable(file, "it holds no user and password");
  }
  if ((read.mode & (S_IRWXG | S_IRWXO)) != 0) {
    key.warning = "other users of this computer may read the key: chmod 600 " + file.string();
  }
  return key;
}

std::optional<MqttKey> key_of(const SendUrl& url, const char* environment) {
  std::optional<MqttKey> key;
  const auto file = free_option(url, "key");
  if (!url.password.empty()) {
    key = checked({url.user, url.password, ""}, "the output");
  } else if (file) {
    const auto path = percent_decoded(*file);
    if (!path || path->empty()) {
      throw Error(ErrorKind::usage, "the option \"key\" of \"" + url.text + "\" names no file");
    }
    key = read_key_file(*path);
  } else if (environment != nullptr && *environment != '\0') {
    const std::string_view text(environment);
    const std::size_t colon = std::min(text.find(':'), text.size());
    key = checked(
        {std::string(text.substr(0, colon)), std::string(text.substr(std::min(colon + 1, text.size()))), ""},
        kMeetingKeyVariable);
  }
  if (!url.user.empty() && (!key || key->user != url.user)) {
    throw Error(
        ErrorKind::usage,
        "the output \"" + url.text + "\" has a user but no password" +
            (key ? ": the key is of the user \"" + key->user + "\"" : ""),
        "Passwords are not kept. Give it again as user:password@ before the host, or by key=FILE or " +
            std::string(kMeetingKeyVariable) + ".");
  }
  return key;
}

}  // namespace telemime::meeting
