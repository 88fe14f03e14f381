// SPDX-License-Identifier: Apache-2.0
#include "cli/data_folder.h"

#include <string>

#include "telemime/core/errors.h"
#include "telemime/core/installed.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

// The installed folder, or `otherwise`: the first that contains `entry`.
fs::path find(const std::string& what, const fs::path& entry, const fs::path& otherwise) {
  if (fs::path installed = installed_folder(code_folder(), entry); !installed.empty()) {
    return installed;
  }
  std::error_code failed;
  if (fs::is_directory(otherwise / entry, failed)) {
    return otherwise;
  }
  throw Error(ErrorKind::input,
              "the " + what + " are missing: there is no share/telemime/" + entry.string() + " above " +
                  code_folder().string(),
              "Install the program again.");
}

}  // namespace

fs::path data_folder() {
  return find("bundled clips", "demo", TELEMIME_SOURCE_DATA);
}

fs::path avatar_folder() {
  return find("avatars", "avatars", code_folder()) / "avatars";
}

}  // namespace telemime
