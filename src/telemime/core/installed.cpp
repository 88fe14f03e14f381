// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/installed.h"

#include <dlfcn.h>
#include <link.h>

namespace telemime {

namespace fs = std::filesystem;

fs::path code_folder() {
  static const char here = 0;
  Dl_info info;
  link_map* object = nullptr;
  // The program itself is the object without a name.
  const bool found = ::dladdr1(&here, &info, reinterpret_cast<void**>(&object), RTLD_DL_LINKMAP) != 0;
  std::error_code failed;
  return found && object != nullptr && object->l_name[0] != '\0'
             ? fs::absolute(object->l_name, failed).parent_path()
             : fs::read_symlink("/proc/self/exe", failed).parent_path();
}

fs::path installed_folder(const fs::path& code, const fs::path& entry) {
  std::error_code failed;
  for (fs::path prefix = code.parent_path(); prefix.has_relative_path(); prefix = prefix.parent_path()) {
    if (fs::exists(prefix / "share" / "telemime" / entry, failed)) {
      return prefix / "share" / "telemime";
    }
  }
  return {};
}

}  // namespace telemime
