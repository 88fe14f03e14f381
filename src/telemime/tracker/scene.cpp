// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/scene.h"

#include <opencv2/imgproc.hpp>

#include "telemime/capture/input_kind.h"
#include "telemime/core/errors.h"
#include "telemime/tracker/set_up.h"

namespace telemime {
namespace {

constexpr std::size_t kBackgroundFrames = 100;

Frame at_working_size(const Frame& frame, const ImageConfig& image) {
  Frame small = frame;
  cv::resize(frame.image, small.image, {image.width, image.height}, 0.0, 0.0, cv::INTER_AREA);
  return small;
}

// The first frames, at working size.
std::vector<Frame> read_frames(Source& source, std::size_t most, const ImageConfig& image) {
  std::vector<Frame> frames;
  while (frames.size() < most) {
    auto frame = source.next();
    if (!frame) {
      break;
    }
    frames.push_back(at_working_size(*frame, image));
  }
  return frames;
}

// Frames of the clip itself at working size: all of the start, for an empty stretch, then every tenth, for
// what the background looks like where the person has gone. All of a clip that is known to be short.
std::vector<Frame> sample_of_clip(const TrackRequest& request, const ImageConfig& image) {
  constexpr std::int64_t kDense = 150;
  constexpr std::int64_t kStride = 10;
  constexpr std::int64_t kMost = 4000;
  const auto again = without_distortion(open_source(request.input, request.input_options), request);
  const bool is_short = again->info().frames > 0 && again->info().frames < 3 * kDense;
  std::vector<Frame> sample;
  for (std::int64_t i = 0; i < kMost; ++i) {
    auto frame = again->next();
    if (!frame) {
      break;
    }
    if (i < kDense || i % kStride == 0 || is_short) {
      sample.push_back(at_working_size(*frame, image));
    }
  }
  return sample;
}

}  // namespace

std::string learn_scene(const TrackRequest& request, const SourceInfo& info, TrackingRun& run) {
  FeatureExtractor& features = run.scene.features;
  if (request.background.empty()) {
    return "background: " + features.bootstrap(sample_of_clip(request, run.tracker.config.image));
  }
  const auto clip = without_distortion(
      open_source(request.background, {.mirrored = request.input_options.mirrored}), request);
  const double aspect = static_cast<double>(clip->info().width) * info.height /
                        (static_cast<double>(clip->info().height) * info.width);
  if (aspect < 0.98 || aspect > 1.02) {
    throw Error(
        ErrorKind::input,
        "the background clip " + shown_url(request.background) + " has another aspect ratio than the input",
        "Record it with the same camera and the same settings.");
  }
  const std::vector<Frame> frames = read_frames(*clip, kBackgroundFrames, run.tracker.config.image);
  features.learn_background(frames);
  return "background: " + std::to_string(frames.size()) + " frames of " + shown_url(request.background);
}

}  // namespace telemime
