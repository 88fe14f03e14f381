// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/secrets.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "meeting/hosting/crypto.h"
#include "meeting/protocol/outcome.h"
#include "telemime/core/errors.h"
#include "telemime/core/files.h"

namespace telemime::meeting {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestFile = 4096;  // bytes
constexpr std::size_t kShortestSecret = 16;
constexpr std::size_t kLongestSecret = 200;
constexpr unsigned kMostParticipants = 1'000'000'000;

[[noreturn]] void unusable(const fs::path& path, const std::string& reason, const std::string& remedy = {}) {
  throw Error(ErrorKind::usage,
              "the secrets of the meeting cannot be read from " + path.string() + ": " + reason, remedy);
}

/// Whether the text is valid in the fragment of a URL (meeting/docs/protocol.md).
bool is_secret(const std::string& text) {
  return text.size() >= kShortestSecret && text.size() <= kLongestSecret &&
         text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.~") ==
             std::string::npos;
}

MeetingSecrets secrets_of(const fs::path& path, const std::string& content) {
  const auto secrets = read_if_valid(content, kMessageSource, [](const JsonField& json) {
    return MeetingSecrets{.speak = json["speak"].text(),
                          .watch = json["watch"].text(),
                          .chair = json["chair"].text(),
                          .key = json["key"].text(),
                          .next = static_cast<unsigned>(json["next"].integer(1, kMostParticipants))};
  });
  const bool complete = secrets && is_secret(secrets->speak) && is_secret(secrets->watch) &&
                        is_secret(secrets->chair) && is_secret(secrets->key);
  if (!complete || secrets->speak == secrets->watch || secrets->speak == secrets->chair ||
      secrets->watch == secrets->chair) {
    unusable(path, "telemime meeting did not write it", "Move it away to create a new one, with new links.");
  }
  return *secrets;
}

}  // namespace

MeetingSecrets new_secrets() {
  return {random_secret(), random_secret(), random_secret(), random_secret(), 1};
}

SecretsFile::SecretsFile(fs::path path) : path_(std::move(path)) {
  make_private_folders(path_.parent_path());
  const fs::path lock = path_.string() + ".lock";
  lock_ = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, S_IRUSR | S_IWUSR);
  if (lock_ >= 0 && ::flock(lock_, LOCK_EX | LOCK_NB) == 0) {
    return;
  }
  const int error = errno;
  if (lock_ >= 0) {
    ::close(lock_);
  }
  if (error == EWOULDBLOCK) {
    throw Error(ErrorKind::usage,
                "this meeting is already open, in another program that uses " + path_.string(),
                "Close that one, or open another meeting: --name.");
  }
  throw Error(ErrorKind::output,
              lock.string() + " cannot be locked: " + std::generic_category().message(error),
              "--secrets names another file.");
}

SecretsFile::~SecretsFile() {
  ::close(lock_);
}

MeetingSecrets SecretsFile::load() {
  SmallFile read;
  try {
    read = read_small_file(path_, kLongestFile, SymbolicLinks::refuse);
  } catch (const std::system_error& e) {
    if (e.code().value() == ENOENT) {
      MeetingSecrets secrets = new_secrets();
      save(secrets);
      return secrets;
    }
    unusable(path_, e.code().value() == ELOOP ? "it is a symbolic link" : e.what());
  } catch (const std::runtime_error& e) {
    unusable(path_, e.what());
  }
  if (read.owner != ::geteuid()) {
    unusable(path_, "it belongs to another user");
  }
  if ((read.mode & (S_IRWXG | S_IRWXO)) != 0) {
    unusable(path_, "other users of this computer can read it",
             "If nobody did: chmod 600 " + path_.string() + ". Otherwise --new-links creates new links.");
  }
  return secrets_of(path_, read.content);
}

void SecretsFile::save(const MeetingSecrets& secrets) const {
  const nlohmann::ordered_json json = {{"version", 1},           {"speak", secrets.speak},
                                       {"watch", secrets.watch}, {"chair", secrets.chair},
                                       {"key", secrets.key},     {"next", secrets.next}};
  write_private_file(path_, json.dump(2) + "\n", /*durable=*/true);
}

fs::path default_secrets_file(const std::string& name, const char* state, const char* home) {
  const fs::path folder(state == nullptr ? "" : state);
  const fs::path users(home == nullptr ? "" : home);
  if (!folder.is_absolute() && !users.is_absolute()) {
    throw Error(ErrorKind::usage, "there is no home folder to keep the links of the meeting",
                "--secrets FILE names another place.");
  }
  const fs::path base = folder.is_absolute() ? folder : users / ".local" / "state";
  return base / "telemime" / "rooms" / (name + ".json");
}

}  // namespace telemime::meeting
