// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "telemime/live/recorder.h"
#include "telemime/streaming/avatar_folder.h"
#include "telemime/streaming/web_server.h"

namespace telemime {

struct PageFile {
  std::string_view path;   ///< of its address: "/index.html"
  std::string_view bytes;  ///< for ever
};

/// Every file of the page, sorted by path. Written when the program is built (cmake/TelemimeWeb.cmake).
std::span<const PageFile> page_table();

/// The file of the page that is built into the program, by the path of its address; "/" is "/index.html".
/// Nothing where there is none.
std::optional<WebContent> page_file(std::string_view path);

/// Whether Vite named the file, "/assets/name-DZaG1Uvn.js": what has this name never changes.
bool has_hash(std::string_view path);

/// The content of a path on the server of a live run (docs/live-protocol.md, "Pages and files"): an avatar, a
/// file of a recording, or a file of the page. Nothing if there is none. Does not block.
std::optional<WebContent> live_file(const std::string& path, const AvatarFolder& avatars,
                                    const Recorder& recorder);

/// The content of a path on the server of a meeting (meeting/docs/protocol.md): the meeting's page at "/room"
/// and
/// "/", its files, or an avatar. Nothing if there is none. Does not block.
std::optional<WebContent> room_file(const std::string& path, const AvatarFolder& avatars);

}  // namespace telemime
