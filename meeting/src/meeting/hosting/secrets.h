// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace telemime::meeting {

/// The secrets behind the links and accounts of a meeting. They give full access to it.
struct MeetingSecrets {
  std::string speak;  ///< in the link to take part
  std::string watch;  ///< in the link to watch
  std::string chair;  ///< in the link to chair
  std::string key;    ///< signs rejoin tokens and passwords (accounts.h)
  unsigned next = 1;  ///< number of the next new participant
};

/// New secrets. Everything made from earlier ones becomes invalid.
MeetingSecrets new_secrets();

/// The file that keeps the secrets of a meeting from one opening to the next. Only its owner can read it.
/// While this object exists, no other program can open the same meeting.
class SecretsFile {
 public:
  /// Creates missing folders (0700). Throws Error(usage) when the meeting is already open, and Error(output)
  /// when the file cannot be used.
  explicit SecretsFile(std::filesystem::path path);
  SecretsFile(const SecretsFile&) = delete;
  SecretsFile& operator=(const SecretsFile&) = delete;
  ~SecretsFile();

  /// The secrets in the file; without a file, new ones, which are saved. Throws Error(usage) when other users
  /// can access the file, when it belongs to another user, is not a regular file or contains no secrets. No
  /// message contains a secret.
  MeetingSecrets load();
  /// Replaces the file atomically. Throws Error(output).
  void save(const MeetingSecrets& secrets) const;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

/// $XDG_STATE_HOME/telemime/rooms/<name>.json, or ~/.local/state/telemime/rooms/<name>.json (XDG Base
/// Directory Specification; relative paths are ignored). `state`, `home`: the two variables; may be null.
/// Throws Error(usage) when both are missing.
std::filesystem::path default_secrets_file(const std::string& name, const char* state, const char* home);

}  // namespace telemime::meeting
