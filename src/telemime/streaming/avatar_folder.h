// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "telemime/streaming/web_server.h"

namespace telemime {

/// The avatars in one or two folders, one VRM file for each look: LOOK.vrm, and LOOK-light.vrm with fewer
/// triangles for computers without a graphics card. A look's name consists of 1 to 32 lower-case letters,
/// digits, "_" and "-", made from the file's name: "My Robot.VRM" is my-robot, a name without any of these is
/// avatar, and a second one of the same name ends in -2. Files of other types are ignored.
class AvatarFolder {
 public:
  /// Lists the folders once; a look of `more` hides one of the same name and its light variant. An empty
  /// path: no avatars. Throws Error(usage) when a folder cannot be read.
  explicit AvatarFolder(const std::filesystem::path& folder, const std::filesystem::path& more = {});

  /// The looks to choose from, without the light variants: "plain" first, then by name.
  const std::vector<std::string>& looks() const { return looks_; }

  /// The file for the web path "/avatars/LOOK.vrm"; nothing if there is none. A light variant that does not
  /// exist is answered with the avatar itself.
  std::optional<WebContent> file(const std::string& path) const;

 private:
  std::map<std::string, std::filesystem::path> files_;  ///< by their names without ".vrm"
  std::vector<std::string> looks_;
};

}  // namespace telemime
