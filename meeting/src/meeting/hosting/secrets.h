// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace telemime::meeting {

/// What a room's links and accounts are made of. Who knows it can do all in the room.
struct MeetingSecrets {
  std::string speak;  ///< invite of those who take part
  std::string watch;  ///< of those who only look on
  std::string chair;  ///< of those who may change the room, too
  std::string key;    ///< signs ways back and passwords (accounts.h)
  unsigned next = 1;  ///< number of the next participant who is new
};

/// New ones; all that was made of others is worth nothing.
MeetingSecrets new_secrets();

/// The file in which the secrets of one room are kept from one opening to the next. Only its user may read
/// it. As long as this lives no other program opens the same one.
class SecretsFile {
 public:
  /// Makes the folders (0700) above `path` where there are none. Throws Error(usage) when others may read or
  /// write the file, when it is not the user's, is no plain file or holds no secrets, or when the room is
  /// open already; Error(output) when it cannot be used. No words hold a secret.
  explicit SecretsFile(std::filesystem::path path);
  SecretsFile(const SecretsFile&) = delete;
  SecretsFile& operator=(const SecretsFile&) = delete;
  ~SecretsFile();

  /// Those of the file; new ones, which are saved, where there is none.
  MeetingSecrets load();
  /// Replaces the file at once: whoever reads it finds the old or the new one. Throws Error(output).
  void save(const MeetingSecrets& secrets) const;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int lock_ = -1;
};

/// $XDG_STATE_HOME/telemime/rooms/<name>.json, or ~/.local/state/... (the XDG Base Directory Specification: a
/// relative path there does not count). `state`, `home`: the two variables; may be null. Throws Error(usage)
/// when there is neither.
std::filesystem::path default_secrets_file(const std::string& name, const char* state, const char* home);

}  // namespace telemime::meeting
