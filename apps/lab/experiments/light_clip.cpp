// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/light_clip.h"

#include <opencv2/core.hpp>

#include "lab/synth/sequence.h"

namespace telemime {

LightClip make_light_clip(std::uint64_t seed, int frames) {
  SceneOptions options;
  options.gesture = Gesture::raising_arms;
  options.width = 160;
  options.height = 120;
  options.seed = seed;
  options.frames = frames;
  options.light_change = true;
  const auto scene = make_scene(options);
  LightClip clip;
  constexpr int kEmpty = 40;
  for (int i = 0; i < kEmpty; ++i) {
    clip.empty.push_back(render_background(scene, i));
  }
  for (int t = 0; t < frames; ++t) {
    const SynthFrame frame = render_frame(scene, t);
    clip.pictures.push_back(frame.image);
    clip.truth.emplace_back(frame.surfaces != static_cast<int>(Surface::room));
  }
  return clip;
}

}  // namespace telemime
