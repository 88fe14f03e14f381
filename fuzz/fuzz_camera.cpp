// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <fstream>

#include "fuzz_target.h"
#include "telemime/core/lens.h"
#include "telemime/core/scratch_folder.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // OpenCV reads by file name; one name for the whole run.
  static const telemime::ScratchFolder folder;
  static const std::filesystem::path file = folder.path() / "camera.yaml";
  const auto read = [](std::string_view text) {
    std::ofstream(file, std::ios::binary) << text;
    const telemime::Lens lens = telemime::load_lens(file);
    lens.camera.scaled_to(320, 240);
    lens.mirrored().distorted({0.3, -0.2});
  };
  return telemime::fuzz_one(data, size, read, telemime::ErrorKind::config);
}
