// SPDX-License-Identifier: Apache-2.0
#include "data_folder.h"

#include "telemime/core/errors.h"

namespace telemime {

std::filesystem::path data_folder() {
  std::error_code failed;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", failed);
  const std::filesystem::path installed = program.parent_path().parent_path() / "share" / "telemime";
  for (const std::filesystem::path& folder : {installed, std::filesystem::path(TELEMIME_SOURCE_DATA)}) {
    if (std::filesystem::is_directory(folder / "demo", failed)) {
      return folder;
    }
  }
  throw Error(ErrorKind::input,
              "the data of this program is not where it was installed: " + installed.string(),
              "Install it again, or name a file.");
}

}  // namespace telemime
