// SPDX-License-Identifier: Apache-2.0
#include "synthetic_clip.h"

#include "lab/synth/sequence.h"

namespace telemime {

SyntheticClip make_synthetic_clip() {
  constexpr double kRate = 25.0;
  SceneOptions options;
  options.gesture = Gesture::joy;
  options.width = 320;
  options.height = 240;
  const auto scene = make_scene(options);
  SyntheticClip clip{scene.camera, {}, {}};
  for (int i = 0; i < 10; ++i) {
    clip.background.push_back({render_background(scene, i), i, i / kRate});
  }
  for (int i = 0; i < 12; ++i) {
    clip.frames.push_back({render_frame(scene, i).image, i, i / kRate});
  }
  return clip;
}

}  // namespace telemime
