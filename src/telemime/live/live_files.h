// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "telemime/live/avatar_shelf.h"
#include "telemime/live/recorder.h"
#include "telemime/streaming/web_server.h"

namespace telemime {

/// What stands at a path of a live run's server (docs/live-protocol.md, "Pages and files"): an avatar, which
/// may have to be made first, a file of a recording, or one of the page. Nothing where there is none. Never
/// blocks.
std::optional<WebContent> live_file(const std::string& path, AvatarShelf& avatars, const Recorder& recorder);

/// What stands at a path of a room's server (docs/room-page.md): the room's page at "/room" and "/", its
/// files, an avatar. Nothing where there is none. Never blocks.
std::optional<WebContent> room_file(const std::string& path, AvatarShelf& avatars);

}  // namespace telemime
