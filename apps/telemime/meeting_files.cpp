// SPDX-License-Identifier: Apache-2.0
#ifdef TELEMIME_MEETING
#include "meeting_files.h"

#include <algorithm>

#include "cli/data_folder.h"
#include "telemime/live/live_files.h"
#include "telemime/streaming/avatar_folder.h"

namespace telemime {

meeting::MeetingFiles meeting_files(const std::filesystem::path& avatars) {
  const AvatarFolder own(avatars);
  const AvatarFolder shipped(avatar_folder());
  meeting::MeetingFiles files;
  files.looks = shipped.looks();
  for (const std::string& look : own.looks()) {
    if (std::find(files.looks.begin(), files.looks.end(), look) == files.looks.end()) {
      files.looks.push_back(look);
    }
  }
  files.get = [own, shipped](const std::string& path) {
    auto file = own.file(path);
    return file ? file : room_file(path, shipped);
  };
  return files;
}

}  // namespace telemime
#endif
