// SPDX-License-Identifier: Apache-2.0
#include "telemime/pipeline/scene.h"

#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::size_t kBackgroundFrames = 100;

std::vector<Frame> read_frames(Source& source, std::size_t most) {
  std::vector<Frame> frames;
  while (frames.size() < most) {
    auto frame = source.next();
    if (!frame) {
      break;
    }
    frames.push_back(std::move(*frame));
  }
  return frames;
}

}  // namespace

std::optional<Frame> Footage::next(Source& source) {
  if (ahead.empty()) {
    return source.next();
  }
  Frame frame = std::move(ahead.front());
  ahead.pop_front();
  return frame;
}

Footage learn_scene(const TrackRequest& request, const SourceInfo& info, Source& source, Tracker& tracker) {
  Footage scene;
  if (!request.background.empty()) {
    const auto clip = open_source(request.background);
    const double aspect = static_cast<double>(clip->info().width) * info.height /
                          (static_cast<double>(clip->info().height) * info.width);
    if (aspect < 0.98 || aspect > 1.02) {
      throw Error(ErrorKind::input,
                  "the background clip " + request.background + " has another shape than the input",
                  "Record it with the same camera and the same settings.");
    }
    const std::vector<Frame> frames = read_frames(*clip, kBackgroundFrames);
    tracker.learn_background(frames);
    scene.messages.push_back("background: " + std::to_string(frames.size()) + " frames of " +
                             request.background);
    return scene;
  }
  (void)source;
  scene.messages.emplace_back("background: none is known");
  return scene;
}

}  // namespace telemime
