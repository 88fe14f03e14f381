// SPDX-License-Identifier: Apache-2.0
#include "measurement_clips.h"

#include <iostream>

#include "lab/synth/sequence.h"

namespace telemime {

std::filesystem::path measurement_data(const std::filesystem::path& given, const std::filesystem::path& out) {
  if (!given.empty()) {
    return given;
  }
  std::filesystem::path development = "../shared/data/dev";
  if (std::filesystem::exists(development / "joy" / "truth.json")) {
    return development;
  }
  std::filesystem::path made = out / "clips";
  for (const std::string_view name : kGestureNames) {
    if (std::filesystem::exists(made / name / "truth.json")) {
      continue;
    }
    std::cerr << "making the clip " << name << '\n';
    SequenceOptions options;
    options.scene.gesture = gesture_named(std::string(name));
    options.scene.width = 320;
    options.scene.height = 240;
    options.folder = made;
    options.small_videos = false;
    make_sequence(options);
  }
  return made;
}

}  // namespace telemime
