// SPDX-License-Identifier: Apache-2.0
#include "support/synthetic_clip.h"

#include "lab/synth/sequence.h"

namespace telemime::support {

SyntheticClip synthetic_clip(int background_frames, int person_frames) {
  SceneOptions options;
  options.width = 320;
  options.height = 240;
  const Scene scene = make_scene(options);
  SyntheticClip clip;
  clip.camera = scene.camera;
  for (int i = 0; i < background_frames; ++i) {
    clip.background.push_back({render_background(scene, i), i, i / kClipFps});
  }
  for (int i = 0; i < person_frames; ++i) {
    const SynthFrame frame = render_frame(scene, i);
    clip.person.push_back({frame.image, i, i / kClipFps});
    clip.truth.push_back(frame.joints);
  }
  return clip;
}

}  // namespace telemime::support
