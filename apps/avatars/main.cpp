// SPDX-License-Identifier: Apache-2.0
// telemime-avatars FOLDER: writes every look of look.h into the folder, as LOOK.vrm and, with fewer
// triangles, as LOOK-light.vrm. The build runs it; the files are installed with the program.
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "avatars/avatar.h"
#include "telemime/core/files.h"

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (arguments.size() != 1) {
    std::cerr << "usage: telemime-avatars FOLDER\n";
    return 2;
  }
  try {
    const std::filesystem::path folder = arguments.front();
    std::filesystem::create_directories(folder);
    for (const telemime::AvatarLook& look : telemime::kAvatarLooks) {
      const std::string name(look.name);
      telemime::write_whole_file(folder / (name + ".vrm"), make_avatar({}, look));
      telemime::write_whole_file(folder / (name + "-light.vrm"), make_avatar({}, light(look)));
    }
  } catch (const std::exception& e) {
    std::cerr << "telemime-avatars: " << e.what() << '\n';
    return 1;
  }
  return 0;
}
