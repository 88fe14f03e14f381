// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "meeting/protocol/outcome.h"
#include "meeting/transport/senders.h"
#include "telemime/core/errors.h"
#include "telemime/core/files.h"
#include "telemime/core/text.h"
#include "telemime/streaming/send_queue.h"

namespace telemime::meeting {
namespace {

constexpr std::string_view kDefaultParticipant = "tracker";  // without an account
constexpr std::size_t kLongestFile = 4096;                   // bytes
constexpr std::size_t kLongestText = 256;                    // bytes, of user and password

[[noreturn]] void reject(const SendUrl& url, const std::string& what, const std::string& remedy) {
  throw Error(ErrorKind::usage, "the output \"" + url.text + "\" " + what, remedy);
}

// MQTT requires UTF-8: the JSON reader has checked the file, and URLs are ASCII.
bool is_valid(const BrokerKey& key) {
  const auto fits = [](const std::string& text) {
    return !text.empty() && text.size() <= kLongestText && text.find('\0') == std::string::npos;
  };
  return fits(key.user) && fits(key.password);
}

/// The value of an option with "%41" decoded to "A".
std::optional<std::string> decoded_option(const SendUrl& url, std::string_view name) {
  const auto raw = find_option(url, name);
  if (!raw) {
    return std::nullopt;
  }
  auto value = percent_decoded(*raw);
  if (!value) {
    reject(url, "has the option \"" + std::string(name) + "\" with a \"%\" without two hexadecimal digits",
           "");
  }
  return value;
}

MeetingAddress meeting_of(const SendUrl& url) {
  const std::string_view path = std::string_view(url.path).substr(1);
  const std::size_t slash = path.find('/');
  MeetingAddress meeting{std::string(path.substr(0, slash)),
                         slash == std::string_view::npos ? "" : std::string(path.substr(slash + 1))};
  if (!is_topic_segment(meeting.tenant) || !is_topic_segment(meeting.meeting)) {
    reject(url, "does not name a meeting",
           "Write it like mqtt://localhost:1883/home/studio: names consist of lower-case letters, digits, _ "
           "and -.");
  }
  return meeting;
}

std::optional<int> seat_of(const SendUrl& url) {
  const auto text = decoded_option(url, "seat");
  for (int seat = 0; seat < kMostSeats && text; ++seat) {
    if (*text == std::to_string(seat)) {
      return seat;
    }
  }
  if (text) {
    reject(url, "names a seat that does not exist", "Seats are 0 to " + std::to_string(kMostSeats - 1) + ".");
  }
  return std::nullopt;
}

}  // namespace

BrokerKey read_key_file(const std::filesystem::path& file) {
  const auto unusable = [&file](const std::string& reason) {
    return Error(ErrorKind::usage, "the key file " + file.string() + " cannot be used: " + reason,
                 R"(It contains {"user": "...", "password": "..."}.)");
  };
  SmallFile read;
  try {
    read = read_small_file(file, kLongestFile);
  } catch (const std::runtime_error& e) {
    throw unusable(e.what());
  }
  auto key = read_if_valid(read.content, kMessageSource, [](const JsonField& json) {
    return BrokerKey{json["user"].text(), json["password"].text(), ""};
  });
  if (!key || !is_valid(*key)) {
    throw unusable("it contains no user and password");
  }
  if ((read.mode & (S_IRWXG | S_IRWXO)) != 0) {
    key->warning = "other users of this computer can read the key: chmod 600 " + file.string();
  }
  return *key;
}

std::optional<BrokerKey> key_of(const SendUrl& url, const char* environment) {
  std::optional<BrokerKey> key;
  std::string source = "the output";
  if (!url.password.empty()) {
    key = {url.user, url.password, ""};
  } else if (const auto file = decoded_option(url, "key")) {
    if (file->empty()) {
      reject(url, "has the option \"key\" without a file", "");
    }
    key = read_key_file(*file);
  } else if (environment != nullptr && *environment != '\0') {
    const std::string text(environment);
    const std::size_t colon = std::min(text.find(':'), text.size());
    key = {text.substr(0, colon), text.substr(std::min(colon + 1, text.size())), ""};
    source = kKeyVariable;
  }
  if (key && !is_valid(*key)) {
    throw Error(ErrorKind::usage, source + " has no user and password of 1 to 256 bytes");
  }
  if (!url.user.empty() && (!key || key->user != url.user)) {
    reject(url, "has a user but no password" + (key ? ": the key is of the user \"" + key->user + "\"" : ""),
           "Passwords are not stored. Give it again as user:password@ before the host, or by key=FILE or " +
               std::string(kKeyVariable) + ".");
  }
  return key;
}

MeetingOutput meeting_output_of(const SendUrl& url) {
  for (const auto& [name, value] : url.options) {
    if (name == "password" || name == "user") {  // before any message shows the URL
      throw Error(ErrorKind::usage, "the user and password of an output are not options",
                  "Write user:password@ before the host, or use key=FILE.");
    }
  }
  check_options(url, {"name", "look", "seat", "participant", "key", "ca", "mirror"});
  const bool tls = url.scheme == "mqtts";
  MeetingOutput output;
  output.meeting = meeting_of(url);

  // The broker and the account.
  output.server.host = url.host;
  output.server.port = url.port.value_or(tls ? kMqttsPort : kMqttPort);
  if (tls) {
    output.server.ca_file = decoded_option(url, "ca").value_or("");
  } else if (find_option(url, "ca")) {
    reject(url, "names certificates but is not encrypted", "Write mqtts:// for TLS.");
  }
  if (const auto key = key_of(url, std::getenv(kKeyVariable))) {
    output.server.user = key->user;
    output.server.password = key->password;
    output.warning = key->warning;
  }

  // The participant.
  const auto default_participant = participant_of_user(output.meeting, output.server.user);
  output.participant = decoded_option(url, "participant")
                           .value_or(default_participant.value_or(std::string(kDefaultParticipant)));
  if (!is_topic_segment(output.participant)) {
    reject(url, "names an invalid participant",
           "A name consists of 1 to 32 lower-case letters, digits, _ and -.");
  }
  output.name = decoded_option(url, "name").value_or(output.participant);
  if (!is_participant_name(output.name)) {
    reject(url, "has a name that cannot be shown", "A name has 1 to 40 characters, in UTF-8.");
  }
  output.look = decoded_option(url, "look").value_or(output.look);
  if (!is_topic_segment(output.look)) {
    reject(url, "has an invalid look", "Looks are plain, robot and so on.");
  }
  output.seat = seat_of(url);
  return output;
}

std::unique_ptr<Sender> make_mqtt_sender(const SendUrl& url) {
  const MeetingOutput output = meeting_output_of(url);
  return make_queued_sender(url, [&](SendLoop& loop) { return std::make_unique<MeetingLink>(loop, output); });
}

}  // namespace telemime::meeting
