// SPDX-License-Identifier: Apache-2.0
#include "cli/data_folder.h"

#include <string>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

fs::path program_folder() {
  std::error_code failed;
  return fs::read_symlink("/proc/self/exe", failed).parent_path();
}

// The installed folder, or `otherwise`: the first that contains `entry`.
fs::path find(const std::string& what, const fs::path& entry, const fs::path& otherwise) {
  const fs::path installed = program_folder().parent_path() / "share" / "telemime";
  std::error_code failed;
  for (const fs::path& folder : {installed, otherwise}) {
    if (fs::is_directory(folder / entry, failed)) {
      return folder;
    }
  }
  throw Error(ErrorKind::input, "the " + what + " are missing: there is no " + (installed / entry).string(),
              "Install the program again.");
}

}  // namespace

fs::path data_folder() {
  return find("bundled clips", "demo", TELEMIME_SOURCE_DATA);
}

fs::path avatar_folder() {
  return find("avatars", "avatars", program_folder()) / "avatars";
}

}  // namespace telemime
