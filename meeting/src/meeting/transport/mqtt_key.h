// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "telemime/streaming/url.h"

namespace telemime::meeting {

/// The environment variable that may hold "user:password".
inline constexpr const char* kMeetingKeyVariable = "TELEMIME_ROOM_KEY";

/// An account at a broker. The password is told to nobody but the broker.
struct MqttKey {
  std::string user;
  std::string password;
  std::string warning;  ///< in words, about the file that it was read from
};

/// Reads {"user": "...", "password": "..."}. Others who may read or write the file are worth a warning.
/// Throws Error(usage) that tells nothing of what is in the file.
MqttKey read_key_file(const std::filesystem::path& file);

/// The account for this output: "user:password@" of the URL, else the file of its option `key`, else
/// `environment` (what kMeetingKeyVariable holds; may be null); nothing when there is none of them. Throws
/// Error(usage) when a key cannot be used, or is of another user than the URL names.
std::optional<MqttKey> key_of(const SendUrl& url, const char* environment);

}  // namespace telemime::meeting
