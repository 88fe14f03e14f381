// SPDX-License-Identifier: Apache-2.0
#include "telemime/network/mqtt_key.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLongestFile = 4096;  // bytes
constexpr std::size_t kLongestText = 256;   // bytes, of user and password

[[noreturn]] void unusable(const std::filesystem::path& file, const std::string& why) {
  throw Error(ErrorKind::usage, "the key file " + file.string() + " cannot be used: " + why,
              R"(It holds {"user": "...", "password": "..."}.)");
}

/// A file that is open for reading.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& path)
      : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) {
      ::close(descriptor_);
    }
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

std::string content_of(const OpenFile& open, const std::filesystem::path& file) {
  std::array<char, kLongestFile + 1> bytes{};
  std::size_t size = 0;
  while (size < bytes.size()) {
    const ssize_t count = ::read(open.get(), bytes.data() + size, bytes.size() - size);
    if (count == 0) {
      break;
    }
    if (count < 0 && errno != EINTR) {
      unusable(file, std::generic_category().message(errno));
    }
    size += count > 0 ? static_cast<std::size_t>(count) : 0;
  }
  if (size > kLongestFile) {
    unusable(file, "it is too long");
  }
  return {bytes.data(), size};
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
  errno = 0;
  const OpenFile open(file);
  struct stat about {};
  if (open.get() < 0 || ::fstat(open.get(), &about) != 0) {
    unusable(file, std::generic_category().message(errno));
  }
  if (!S_ISREG(about.st_mode)) {
    unusable(file, "it is no file");
  }
  const Json json = Json::parse(
      content_of(open, file), [](int depth, Json::parse_event_t, Json&) { return depth < 4; },
      /*allow_exceptions=*/false);
  const auto text = [&json](const char* name) {
    return json.is_object() && json.contains(name) && json[name].is_string() ? json[name].get<std::string>()
                                                                             : std::string();
  };
  MqttKey key{text("user"), text("password"), ""};
  if (!is_key_text(key.user) || !is_key_text(key.password)) {
    unusable(file, "it holds no user and password");
  }
  if ((about.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
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
        kRoomKeyVariable);
  }
  if (!url.user.empty() && (!key || key->user != url.user)) {
    throw Error(
        ErrorKind::usage,
        "the output \"" + url.text + "\" has a user but no password" +
            (key ? ": the key is of the user \"" + key->user + "\"" : ""),
        "Passwords are not kept. Give it again as user:password@ before the host, or by key=FILE or " +
            std::string(kRoomKeyVariable) + ".");
  }
  return key;
}

}  // namespace telemime
