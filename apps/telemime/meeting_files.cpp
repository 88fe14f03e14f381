// SPDX-License-Identifier: Apache-2.0
#ifdef TELEMIME_MEETING
#include "meeting_files.h"

#include "cli/data_folder.h"
#include "telemime/live/live_files.h"
#include "telemime/streaming/avatar_folder.h"

namespace telemime {

meeting::MeetingFiles meeting_files(const std::filesystem::path& more) {
  const AvatarFolder avatars(avatar_folder(), more);
  return {.looks = avatars.looks(),
          .get = [avatars](const std::string& path) { return room_file(path, avatars); }};
}

}  // namespace telemime
#endif
