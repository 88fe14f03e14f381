// SPDX-License-Identifier: Apache-2.0
// The parts of FeatureExtractor that look at the scene as a whole: bootstrap, camera motion, status.
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/image/camera_motion.h"
#include "telemime/image/features.h"
#include "telemime/image/person_shape.h"

namespace telemime {
namespace {

cv::Mat working_picture(const Frame& frame, const ImageConfig& config) {
  cv::Mat out;
  cv::resize(frame.image, out, cv::Size(config.width, config.height), 0, 0, cv::INTER_AREA);
  return out;
}

cv::Mat grey_at_most(const cv::Mat& image, int width) {
  cv::Mat small = image;
  if (image.cols > width) {
    cv::resize(image, small, cv::Size(width, std::max(1, image.rows * width / image.cols)), 0, 0,
               cv::INTER_AREA);
  }
  cv::Mat grey;
  cv::cvtColor(small, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

/// Does the scene itself move? Pictures 1 and 8 frames apart, all over the clip, corners far from any head.
bool camera_moves(std::span<const Frame> clip, std::span<const SceneSample> samples,
                  const ImageConfig& config) {
  std::vector<double> motions;
  constexpr std::size_t kApart = 8;
  if (clip.size() <= kApart) {
    return false;
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t at = i * (clip.size() - 1 - kApart) / std::max<std::size_t>(1, samples.size() - 1);
    cv::Mat scene(config.height, config.width, CV_8UC1, cv::Scalar(255));
    if (samples[i].head) {
      scene = body_prior(scene.size(), *samples[i].head) < 0;
    }
    const auto moved =
        scene_motion(grey_at_most(working_picture(clip[at], config), config.width),
                     grey_at_most(working_picture(clip[at + kApart], config), config.width), scene);
    if (moved) {
      motions.push_back(*moved * 160.0 / config.width);
    }
  }
  if (motions.empty()) {
    return false;
  }
  std::sort(motions.begin(), motions.end());
  return motions[motions.size() * 3 / 4] > 0.7;
}

}  // namespace

std::vector<SceneSample> FeatureExtractor::samples_of(std::span<const Frame> clip) {
  constexpr std::size_t kSamples = 20;
  std::vector<SceneSample> samples;
  const std::size_t count = std::min(kSamples, clip.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Frame& frame = clip[count == 1 ? 0 : i * (clip.size() - 1) / (count - 1)];
    const Pictures p = pictures_of(frame);
    samples.push_back(
        {p.bgr, region_of(head_.restart(p.face, cv::Rect(0, 0, p.face.cols, p.face.rows), face_test(p)), p)});
  }
  head_.forget();
  return samples;
}

SceneReport FeatureExtractor::bootstrap(std::span<const Frame> clip) {
  if (clip.empty()) {
    throw Error(ErrorKind::usage, "the scene cannot be learned from no frames");
  }
  shape_ = HeadShape{};
  ImageCalibration fresh;
  fresh.colours = calibration_.colours;
  SceneReport report;
  const std::vector<SceneSample> samples = samples_of(clip);
  const auto with_head =
      std::count_if(samples.begin(), samples.end(), [](const auto& s) { return s.head.has_value(); });

  constexpr std::size_t kMostPictures = 150;
  std::vector<cv::Mat> pictures;
  const std::size_t half = std::min(kMostPictures, clip.size()) / 2;
  const bool whole = clip.size() <= kMostPictures;
  for (std::size_t i = 0; i < (whole ? clip.size() : 2 * half); ++i) {
    pictures.push_back(working_picture(clip[whole || i < half ? i : clip.size() - 2 * half + i], config_));
  }
  const auto [first, count] = find_still_stretch(pictures);
  if (count > 0 && with_head > 0) {
    const std::span<const cv::Mat> still(pictures.data() + first, count);
    ImageCalibration candidate = fresh;
    candidate.background = learn_background_model(still);
    set_calibration(candidate);
    // Somebody who sat still all that time is part of such a model, and his head does not stand out from it.
    const auto head =
        std::find_if(samples.begin(), samples.end(), [](const auto& s) { return s.head.has_value(); });
    LogColour colour = log_colour(head->bgr);
    subtract(colour, estimate_gain(candidate.background, colour, {}));
    const auto has_face = [this](const cv::Mat& picture) {
      const LogColour colours = log_colour(picture);
      const bool found =
          head_
              .restart(grey_at_most(picture, picture.cols), cv::Rect(0, 0, picture.cols, picture.rows),
                       [&](const cv::Rect& face) { return possible_skin(colours, face) > 0.2; })
              .has_value();
      head_.forget();
      return found;
    };
    const bool empty =
        stands_out(background_energy(candidate.background, colour, config_.shadow, {}), *head->head) &&
        !has_face(still.front()) && !has_face(still[count / 2]);
    if (empty) {
      const std::size_t offset = whole || first < half ? 0 : clip.size() - 2 * half;
      report = {SceneSource::empty_stretch, first + offset, count, 1.0,
                "the background was learned from " + std::to_string(count) +
                    " frames without a person, from frame " + std::to_string(first + offset) + " on"};
      return report;
    }
  }
  if (with_head == 0 && samples.size() < 8) {
    set_calibration(fresh);
    report.sentence = "no face was found: the scene could not be learned";
    return report;
  }
  fresh.background = learn_around_person(samples);
  fresh.surroundings = learn_surroundings(samples);
  fresh.doubtful = true;
  report.source = SceneSource::moving_person;
  if (camera_moves(clip, samples, config_)) {
    fresh.background.valid.setTo(0);
    status_.camera_motion = 2.0;
    report.source = SceneSource::colours_only;
    report.sentence = "the camera moves: only colours tell the person from the scene";
  }
  report.known =
      cv::countNonZero(fresh.background.valid) / static_cast<double>(fresh.background.valid.total());
  if (report.source == SceneSource::moving_person) {
    report.sentence =
        "the background was learned around the person: " + std::to_string(std::lround(100 * report.known)) +
        " % of the picture is known";
  }
  set_calibration(std::move(fresh));
  return report;
}

double FeatureExtractor::all_valid_share() const {
  const cv::Mat& valid = calibration_.background.valid;
  return valid.empty() ? 0.0 : cv::countNonZero(valid) / static_cast<double>(valid.total());
}

void FeatureExtractor::watch_camera(const cv::Mat& grey) {
  if (config_.motion_every == 0 || ++since_motion_ < config_.motion_every) {
    return;
  }
  since_motion_ = 0;
  if (!motion_grey_.empty()) {
    if (const auto moved = scene_motion(motion_grey_, grey, motion_scene_ & believed_)) {
      // One lively curtain is not a moving camera: averaged over a few looks, large steps cut.
      const double step = std::min(*moved * 160.0 / config_.width, 5.0);
      status_.camera_motion += 0.3 * (step - status_.camera_motion);
    }
  }
  motion_grey_ = grey;
  motion_scene_ = believed_.clone();
}

void FeatureExtractor::update_status(const Pictures& p, const FrameFeatures& seen) {
  const auto total = static_cast<double>(seen.labels.total());
  const auto share = [&](Label label) {
    return cv::countNonZero(seen.labels == static_cast<unsigned char>(label)) / total;
  };
  status_.silhouette_share = cv::countNonZero(seen.silhouette) / total;
  status_.person = seen.head.has_value() || status_.silhouette_share > 0.02;
  status_.brightness = cv::mean(p.grey)[0];
  status_.known_background = all_valid_share();
  all_valid_ = status_.known_background >= 1.0;
  const double arms = share(Label::arms);
  const double clothes = share(Label::clothes);
  if (arms + clothes > 0.02) {
    const double now = arms / (arms + clothes);
    // The first frames decide quickly, later ones correct slowly.
    status_.skin_share += (status_.skin_share == 0.0 ? 1.0 : 0.03) * (now - status_.skin_share);
  }
  status_.warnings = warnings_of(status_, calibration_.colours);
}

}  // namespace telemime
