// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "telemime/streaming/web_server.h"

namespace telemime {

/// The avatars of the user's folder by their looks; "<look>-light.vrm" is the one for slow computers.
class AvatarFolder {
 public:
  /// Empty: there are none. Throws Error(usage) when the folder cannot be read.
  explicit AvatarFolder(std::filesystem::path folder);

  /// Sorted, the light ones among them.
  const std::vector<std::string>& looks() const { return looks_; }

  /// What stands at "/avatars/<look>.vrm". A light one that there is not is the one itself.
  std::optional<WebContent> file(const std::string& path) const;

 private:
  bool has(const std::string& look) const;

  std::filesystem::path folder_;
  std::vector<std::string> looks_;
};

}  // namespace telemime
