// SPDX-License-Identifier: Apache-2.0
// The parts of FeatureExtractor that compare a frame with the background, and let the background follow.
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "telemime/image/features.h"
#include "telemime/image/light_change.h"
#include "telemime/image/person_shape.h"

namespace telemime {
namespace {

/// ln of how much brighter a grey surface of medium brightness is.
double relative_light(const LightChange& light) {
  constexpr double kMedium = 100.0;  // grey levels
  const double offset = (light.offset[0] + light.offset[1] + light.offset[2]) / 3;
  const double now = std::exp(cv::mean(light.gain.l)[0]) * kMedium + offset;
  return std::log(std::max(now, 1.0) / kMedium);
}

}  // namespace

// Compensates changes of light, exposure and white balance.
FeatureExtractor::LitImage FeatureExtractor::in_light_of_background(const LogColour& colour,
                                                                    const cv::Mat& background) const {
  const LightChange light = estimate_light(calibration_.background, colour, background);
  LitImage lit{{colour.u.clone(), colour.v.clone(), colour.l.clone()}, relative_light(light)};
  compensate(calibration_.background, light, lit.colour);
  return lit;
}

FeatureExtractor::SceneEnergies FeatureExtractor::compare_with_scene(const LogColour& colour) const {
  const BackgroundModel& model = calibration_.background;
  SceneEnergies scene;
  if (!model.empty()) {
    scene.background = background_energy(model, colour, config_.shadow);
  }
  if (!background_complete_ || model.empty()) {
    scene.surroundings = energy(calibration_.surroundings, colour);
  }
  return scene;
}

BackgroundEnergy FeatureExtractor::background_energy_of(WorkingImages& images,
                                                        const std::optional<HeadRegion>& head,
                                                        const cv::Mat& mask) {
  const BackgroundModel& model = calibration_.background;
  const cv::Size size = images.grey.size();
  // Compensate: all colours were learned in the light of the model.
  if (!model.empty()) {
    if (!images.lit) {
      // In the first frame, the mask alone knows where the background is.
      const cv::Mat background =
          background_mask_.empty() && !mask.empty() ? ~person_area(mask, 3) : background_mask_;
      images.lit = in_light_of_background(images.colour, background);
    }
    images.colour = images.lit->colour;
    status_.light_change = images.lit->change;
  }
  SceneEnergies scene = images.scene ? *std::exchange(images.scene, {}) : compare_with_scene(images.colour);
  // Energy of pixels whose background is unknown: colours of the surroundings, position relative to the
  // head, and the previous silhouette.
  cv::Mat unknown;
  if (!background_complete_ || model.empty()) {
    unknown = scene.surroundings;
    cv::min(unknown, config_.segmentation.unknown_background_cost, unknown);
    constexpr float kPositionWeight = 5.0F;
    constexpr float kPreviousWeight = 4.0F;
    if (head) {
      unknown += kPositionWeight * body_prior(size, *head);
    }
    if (!silhouette_.empty()) {
      cv::add(unknown, cv::Scalar(kPreviousWeight), unknown, silhouette_);
    }
  }
  // What the network takes for the person.
  const cv::Mat by_mask = mask.empty() ? cv::Mat() : mask_energy(mask, config_.mask_trust);
  if (model.empty()) {
    if (!by_mask.empty()) {
      unknown += by_mask;
    }
    return {unknown, cv::Mat::zeros(size, CV_8UC1), true};
  }
  // Compare with the model.
  BackgroundEnergy out = std::move(scene.background);
  if (!unknown.empty()) {
    set_unknown(model, unknown, out);
  }
  out.doubtful = calibration_.doubtful;
  if (!by_mask.empty()) {
    out.energy += by_mask;
  }
  return out;
}

// Adapts the background model outside the person. A camera that was moved invalidates it.
void FeatureExtractor::update_background(const WorkingImages& p, const BackgroundEnergy& background,
                                         const std::optional<PoseLandmarks>& landmarks) {
  BackgroundModel& model = calibration_.background;
  if (landmarks) {
    // Nothing that a network may take for the person becomes background.
    background_mask_.setTo(0, person_area(landmarks->mask, 2));
    if (model.empty()) {
      // The background is learned where it is seen, from the first frame on.
      model = learn_background_model(std::span(&p.bgr, 1));
      model.valid.setTo(0);
      background_complete_ = false;
    }
  }
  if (model.empty()) {
    return;
  }
  if (std::max(status_.camera_motion, camera_step_) > kBackgroundIsVoid) {
    model.valid.setTo(0);
    model.seen.setTo(0);
  } else if (config_.background_rate > 0) {
    cv::Mat where = background_mask_.clone();
    where.setTo(0, background.shaded);
    constexpr double kSteady = 12.0;  // images, and 1/25 s
    adapt_background(model, p.colour, where, static_cast<float>(over_elapsed(config_.background_rate)),
                     static_cast<int>(std::clamp(std::ceil(kSteady / elapsed_ - 0.01), kSteady, 255.0)));
  }
}

}  // namespace telemime
