// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "telemime/live/recorder.h"
#include "telemime/streaming/avatar_folder.h"
#include "telemime/streaming/web_server.h"

namespace telemime {

/// The content of a path on the server of a live run (docs/live-protocol.md, "Pages and files"): an avatar, a
/// file of a recording, or a file of the page. Nothing if there is none. Does not block.
std::optional<WebContent> live_file(const std::string& path, const AvatarFolder& avatars,
                                    const Recorder& recorder);

/// The content of a path on the server of a meeting (meeting/docs/protocol.md): the meeting's page at "/room"
/// and
/// "/", its files, or an avatar. Nothing if there is none. Does not block.
std::optional<WebContent> room_file(const std::string& path, const AvatarFolder& avatars);

}  // namespace telemime
