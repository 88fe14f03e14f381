// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "fuzz_target.h"
#include "telemime/core/lens.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // OpenCV reads by file name; one name for the whole run.
  static const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("fuzz_camera_" + std::to_string(getpid()) + ".yaml");
  const auto read = [](std::string_view text) {
    std::ofstream(file, std::ios::binary) << text;
    const telemime::Lens lens = telemime::load_lens(file);
    lens.camera.scaled_to(320, 240);
    lens.mirrored().distorted({0.3, -0.2});
  };
  return telemime::fuzz_one(data, size, read, telemime::ErrorKind::config);
}
