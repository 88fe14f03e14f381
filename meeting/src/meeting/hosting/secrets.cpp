// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/secrets.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "meeting/hosting/crypto.h"
#include "meeting/hosting/private_file.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::size_t kLongestFile = 4096;
constexpr std::size_t kShortestSecret = 16;
constexpr std::size_t kLongestSecret = 200;
constexpr unsigned kMostParticipants = 1'000'000'000;
constexpr mode_t kMine = 0600;

std::string system_words() {
  return std::generic_category().message(errno);
}

[[noreturn]] void unusable(const fs::path& path, const std::string& why, const std::string& remedy = {}) {
  throw Error(ErrorKind::usage, "the secrets of the room cannot be taken from " + path.string() + ": " + why,
              remedy);
}

/// What an address may hold (docs/room-page.md).
bool is_secret(const std::string& text) {
  return text.size() >= kShortestSecret && text.size() <= kLongestSecret &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
                  c == '-' || c == '.' || c == '~';
         });
}

MeetingSecrets secrets_of(const fs::path& path, const std::string& content) {
  const Json json = Json::parse(
      content, [](int depth, Json::parse_event_t, Json&) { return depth < 3; }, /*allow_exceptions=*/false);
  const auto text = [&json](const char* name) {
    return json.is_object() && json.contains(name) && json[name].is_string() ? json[name].get<std::string>()
                                                                             : std::string();
  };
  MeetingSecrets secrets{text("speak"), text("watch"), text("chair"), text("key"), 0};
  if (json.is_object() && json.contains("next") && json["next"].is_number_unsigned()) {
    secrets.next =
        static_cast<unsigned>(std::min<std::uint64_t>(json["next"].get<std::uint64_t>(), kMostParticipants));
  }
  const bool whole = is_secret(secrets.speak) && is_secret(secrets.watch) && is_secret(secrets.chair) &&
                     is_secret(secrets.key) && secrets.next > 0;
  if (!whole || secrets.speak == secrets.watch || secrets.speak == secrets.chair ||
      secrets.watch == secrets.chair) {
    unusable(path, "it does not hold what telemime room writes",
             "Move it away: a new one is made, with new links.");
  }
  return secrets;
}

}  // namespace

MeetingSecrets new_secrets() {
  return {random_secret(), random_secret(), random_secret(), random_secret(), 1};
}

SecretsFile::SecretsFile(fs::path path) : path_(std::move(path)) {
  make_private_folders(path_.parent_path());
  const fs::path lock = path_.string() + ".lock";
  lock_ = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kMine);
  if (lock_ < 0) {
    throw Error(ErrorKind::output, lock.string() + " cannot be made: " + system_words(),
                "--secrets names another file.");
  }
  if (::flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    const int number = errno;
    ::close(lock_);
    if (number != EWOULDBLOCK) {
      throw Error(ErrorKind::output,
                  lock.string() + " cannot be locked: " + std::generic_category().message(number),
                  "--secrets names a file elsewhere.");
    }
    throw Error(ErrorKind::usage, "this room is open already, by another program that uses " + path_.string(),
                "End that one, or open another room: --name.");
  }
}

SecretsFile::~SecretsFile() {
  ::close(lock_);
}

MeetingSecrets SecretsFile::load() {
  const int file = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (file < 0 && errno == ENOENT) {
    MeetingSecrets secrets = new_secrets();
    save(secrets);
    return secrets;
  }
  if (file < 0) {
    unusable(path_, errno == ELOOP ? "it is a link to another file" : system_words());
  }
  struct stat about {};
  std::array<char, kLongestFile + 1> bytes{};
  const bool known = ::fstat(file, &about) == 0;
  const bool plain = known && S_ISREG(about.st_mode);
  const ssize_t size = plain ? ::read(file, bytes.data(), bytes.size()) : -1;
  ::close(file);
  if (known && !plain) {
    unusable(path_, "it is no file");
  }
  if (size < 0) {
    unusable(path_, system_words());
  }
  if (about.st_uid != ::geteuid()) {
    unusable(path_, "it belongs to another user");
  }
  if ((about.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    unusable(path_, "others of this computer may read it",
             "If nobody did: chmod 600 " + path_.string() + ". Else --new-links makes new ones.");
  }
  if (static_cast<std::size_t>(size) > kLongestFile) {
    unusable(path_, "it is too long");
  }
  return secrets_of(path_, {bytes.data(), static_cast<std::size_t>(size)});
}

void SecretsFile::save(const MeetingSecrets& secrets) const {
  const Json json = {{"version", 1},           {"speak", secrets.speak}, {"watch", secrets.watch},
                     {"chair", secrets.chair}, {"key", secrets.key},     {"next", secrets.next}};
  write_private_file(path_, json.dump(2) + "\n", /*lasting=*/true);
}

fs::path default_secrets_file(const std::string& name, const char* state, const char* home) {
  const fs::path folder(state == nullptr ? "" : state);
  const fs::path users(home == nullptr ? "" : home);
  if (!folder.is_absolute() && !users.is_absolute()) {
    throw Error(ErrorKind::usage, "there is no home folder to keep the room's secrets in",
                "--secrets FILE says where.");
  }
  const fs::path base = folder.is_absolute() ? folder : users / ".local" / "state";
  return base / "telemime" / "rooms" / (name + ".json");
}

}  // namespace telemime::meeting
