// SPDX-License-Identifier: Apache-2.0
// The parts of FeatureExtractor that concern the whole scene: background, bootstrap, camera motion, status.
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "telemime/core/camera.h"
#include "telemime/core/errors.h"
#include "telemime/core/time_base.h"
#include "telemime/image/camera_motion.h"
#include "telemime/image/features.h"
#include "telemime/image/light_change.h"
#include "telemime/image/person_shape.h"

namespace telemime {
namespace {

constexpr double kMotionWidth = 160.0;     // px: motions of the camera are stated for this reference width
constexpr double kSkinOfFace = 0.2;        // share of a face that must have the colour of skin
constexpr std::size_t kFewestSamples = 8;  // of a clip without a face, to learn around the person
// Weights of a new measurement of the camera's motion, and of the last one where nothing can be tracked.
constexpr double kMotionWeight = 0.3;
constexpr double kOldMotionWeight = 0.03;
// Shares of the image that the outline of a person without a visible head covers.
constexpr double kLeastOutline = 0.02;
constexpr double kMostOutline = 0.9;
// Weights of 1/25 s in the shares of coloured pixels and of skin.
constexpr double kColourWeight = 0.1;
constexpr double kSkinWeight = 0.03;
constexpr double kGrey = 5.0;            // 1/25 s of pictures without colour
constexpr double kLeastLabelled = 0.02;  // share of arms and clothes from which skin is measured

cv::Mat working_image(const Frame& frame, const ImageConfig& config) {
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

/// Index of a sample in the clip that it was taken from.
std::size_t frame_of_sample(std::size_t sample, std::size_t samples, std::size_t frames) {
  return samples == 1 ? 0 : sample * (frames - 1) / (samples - 1);
}

/// The pixels outside the person, with a margin for the motion of a few frames.
cv::Mat around_person(const SceneSample& sample) {
  cv::Mat scene(sample.bgr.size(), CV_8UC1, cv::Scalar(255));
  if (!sample.mask.empty()) {
    scene.setTo(0, person_area(sample.mask, std::max(1, sample.bgr.cols / 40)));
  } else if (sample.head) {
    scene = body_prior(scene.size(), *sample.head) < 0;
  }
  return scene;
}

/// The nearest frame of the clip at least `apart` (s) after this one, or else before it.
std::optional<std::size_t> frame_apart(std::span<const Frame> clip, std::size_t from, double apart) {
  constexpr double kSlack = 1e-3;  // s, for time stamps in ms
  const double time = clip[from].time;
  const auto later = std::find_if(clip.begin() + static_cast<std::ptrdiff_t>(from), clip.end(),
                                  [&](const Frame& frame) { return frame.time > time + apart - kSlack; });
  if (later != clip.end()) {
    return static_cast<std::size_t>(later - clip.begin());
  }
  for (std::size_t i = from; i-- > 0;) {
    if (clip[i].time < time - apart + kSlack) {
      return i;
    }
  }
  return std::nullopt;
}

/// Whether the camera moves: motion that the background has in common between frames a third of a second
/// apart, or more where the clip is a sample of a longer one, in at least a quarter of the places of the clip
/// that can tell.
bool camera_moves(std::span<const Frame> clip, std::span<const SceneSample> samples,
                  const ImageConfig& config) {
  std::vector<double> motions;
  constexpr double kApart = 8.0 * kTimeUnit;
  constexpr std::size_t kFewest = 3;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t at = frame_of_sample(i, samples.size(), clip.size());
    const auto other = frame_apart(clip, at, kApart);
    if (!other) {
      continue;  // a short clip has no frame that far from its middle
    }
    const auto shared = shared_motion(grey_at_most(samples[i].bgr, config.width),
                                      grey_at_most(working_image(clip[*other], config), config.width),
                                      around_person(samples[i]));
    if (shared) {
      motions.push_back(shared->pixels * kMotionWidth / reference_width(config.width, config.height));
    }
  }
  if (motions.size() < kFewest) {
    return false;
  }
  std::sort(motions.begin(), motions.end());
  return motions[motions.size() * 3 / 4] > kCameraIsUnsteady;
}

}  // namespace

void FeatureExtractor::learn_background(std::span<const Frame> frames) {
  std::vector<cv::Mat> images;
  for (const Frame& frame : frames) {
    images.push_back(working_images(frame).bgr);
  }
  ImageCalibration fresh;
  fresh.background = learn_background_model(images);
  fresh.colours = calibration_.colours;
  set_calibration(std::move(fresh));
}

void FeatureExtractor::set_calibration(ImageCalibration calibration) {
  calibration_ = std::move(calibration);
  prepared_in_ = -1;
  // The model adapts to the light, so it needs planes that it does not share with the caller.
  BackgroundModel& scene = calibration_.background;
  for (cv::Mat* plane : {&scene.mean.u, &scene.mean.v, &scene.mean.l, &scene.chroma_variance,
                         &scene.luminance_variance, &scene.valid, &scene.seen}) {
    *plane = plane->clone();
  }
  if (!calibration_.background.empty() &&
      calibration_.background.valid.size() != cv::Size(config_.width, config_.height)) {
    throw Error(ErrorKind::config, "the background was learned at another working size",
                "calibrate again, with the same working size and a camera of the same shape");
  }
  background_mask_.release();
  silhouette_.release();
  motion_image_.release();
  camera_step_ = 0.0;
  status_.camera_motion = 0.0;
  const cv::Mat& valid = calibration_.background.valid;
  background_complete_ = !valid.empty() && cv::countNonZero(valid) == static_cast<int>(valid.total());
}

std::vector<SceneSample> FeatureExtractor::scene_samples(std::span<const Frame> clip) {
  constexpr std::size_t kSamples = 20;
  std::vector<SceneSample> samples;
  const std::size_t count = std::min(kSamples, clip.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Frame& frame = clip[frame_of_sample(i, count, clip.size())];
    const WorkingImages p = working_images(frame);
    if (finder_.has_networks()) {
      // The samples are too far apart for a person to be followed from one to the next.
      finder_.reset();
      found_in_ = -1;
      const std::optional<PoseLandmarks> landmarks = find_person(frame);
      head_.reset();
      samples.push_back({p.bgr, landmarks ? head_region_of(face_of(landmarks, p), p) : std::nullopt,
                         landmarks ? landmarks->mask : cv::Mat::zeros(p.grey.size(), CV_8UC1)});
      continue;
    }
    samples.push_back(
        {p.bgr,
         head_region_of(head_.detect(p.face, cv::Rect(0, 0, p.face.cols, p.face.rows), skin_test(p)), p),
         {}});
  }
  head_.reset();
  finder_.reset();
  found_in_ = -1;
  return samples;
}

std::string FeatureExtractor::bootstrap(std::span<const Frame> clip) {
  if (clip.empty()) {
    throw Error(ErrorKind::usage, "the background cannot be learned: there are no frames");
  }
  // Find the heads in frames spread over the clip.
  shape_ = HeadShape{};
  ImageCalibration fresh;
  fresh.colours = calibration_.colours;
  const std::vector<SceneSample> samples = scene_samples(clip);
  const auto with_head = std::count_if(samples.begin(), samples.end(), [](const auto& s) {
    return s.head.has_value() || (!s.mask.empty() && cv::countNonZero(s.mask) > 0);
  });

  // First choice: a stretch at the start or the end of the clip in which nothing moves.
  constexpr std::size_t kMostImages = 150;
  std::vector<cv::Mat> images;
  const std::size_t half = std::min(kMostImages, clip.size()) / 2;
  const bool whole = clip.size() <= kMostImages;
  for (std::size_t i = 0; i < (whole ? clip.size() : 2 * half); ++i) {
    images.push_back(working_image(clip[whole || i < half ? i : clip.size() - 2 * half + i], config_));
  }
  const auto [first, count] = find_still_stretch(images);
  const bool any_head =
      std::any_of(samples.begin(), samples.end(), [](const auto& s) { return s.head.has_value(); });
  if (count > 0 && any_head) {
    const std::span<const cv::Mat> still(images.data() + first, count);
    ImageCalibration candidate = fresh;
    candidate.background = learn_background_model(still);
    set_calibration(candidate);
    // A person who sat still during the stretch is part of the model, so the head does not differ from it.
    const auto head =
        std::find_if(samples.begin(), samples.end(), [](const auto& s) { return s.head.has_value(); });
    LogColour colour = log_colour(head->bgr);
    compensate(candidate.background, estimate_light(candidate.background, colour, {}), colour);
    const auto has_face = [this](const cv::Mat& image) {
      if (finder_.has_networks()) {
        finder_.reset();
        const bool found = finder_.find(image, 0.0).has_value();
        finder_.reset();
        return found;
      }
      const LogColour colours = log_colour(image);
      const bool found =
          head_
              .detect(grey_at_most(image, image.cols), cv::Rect(0, 0, image.cols, image.rows),
                      [&](const cv::Rect& face) { return possible_skin(colours, face) > kSkinOfFace; })
              .has_value();
      head_.reset();
      return found;
    };
    const bool empty = differs_from_background(
                           background_energy(candidate.background, colour, config_.shadow), *head->head) &&
                       !has_face(still.front()) && !has_face(still[count / 2]);
    if (empty) {
      const std::size_t offset = whole || first < half ? 0 : clip.size() - 2 * half;
      const auto from = static_cast<std::size_t>(clip[first + offset].index);
      return "the background was learned from " + std::to_string(count) +
             " frames without a person, starting at frame " + std::to_string(from);
    }
  }
  // Second choice: learn around the person, as long as the camera does not move.
  if (with_head == 0 && samples.size() < kFewestSamples) {
    set_calibration(fresh);
    return "no face was found: the background could not be learned";
  }
  fresh.background = learn_around_person(samples);
  fresh.surroundings = learn_surroundings(samples);
  fresh.doubtful = true;
  const bool moves = camera_moves(clip, samples, config_);
  if (moves) {
    fresh.background.valid.setTo(0);
  }
  set_calibration(std::move(fresh));
  if (moves) {
    constexpr double kMoves = 2.0;
    status_.camera_motion = kMoves;
    return "the camera moves, so no background was learned: fix the camera for better poses";
  }
  return "the background was learned around the person: " +
         std::to_string(std::lround(100 * known_background_share())) + " % of the image is known";
}

double FeatureExtractor::known_background_share() const {
  const cv::Mat& valid = calibration_.background.valid;
  return valid.empty() ? 0.0 : cv::countNonZero(valid) / static_cast<double>(valid.total());
}

bool FeatureExtractor::camera_check_is_due(double elapsed) const {
  return config_.motion_every > 0 && since_motion_ + elapsed >= config_.motion_every;
}

FeatureExtractor::CameraCheck FeatureExtractor::check_camera(const cv::Mat& grey) const {
  return {shared_motion(motion_image_, grey, motion_mask_ & background_mask_)};
}

void FeatureExtractor::update_camera_motion(const WorkingImages& p) {
  if (!camera_check_is_due(elapsed_)) {
    since_motion_ += elapsed_;
    return;
  }
  since_motion_ = 0.0;
  if (!motion_image_.empty()) {
    const std::optional<SharedMotion> shared = (p.camera ? *p.camera : check_camera(p.grey)).shared;
    camera_step_ =
        shared ? shared->pixels * kMotionWidth / reference_width(config_.width, config_.height) : 0.0;
    // Where nothing can be followed, a camera that moved is believed to go on for a while.
    constexpr double kLargestStep = 5.0;
    const double weight = shared ? kMotionWeight : kOldMotionWeight;
    status_.camera_motion += weight * (std::min(camera_step_, kLargestStep) - status_.camera_motion);
  }
  motion_image_ = p.grey;
  motion_mask_ = background_mask_.clone();
}

void FeatureExtractor::update_status(const WorkingImages& p, const FrameFeatures& features) {
  // Shares of the image.
  const auto total = static_cast<double>(features.labels.total());
  const auto share = [&](Label label) {
    return cv::countNonZero(features.labels == static_cast<unsigned char>(label)) / total;
  };
  status_.silhouette_share = cv::countNonZero(features.silhouette) / total;
  // Everything differs from the background when a hand covers the lens, or the camera was turned away.
  const bool outline = status_.silhouette_share > kLeastOutline && status_.silhouette_share < kMostOutline;
  status_.person = shows_something(status_) && (features.head.has_value() || outline);
  status_.people = features.landmarks ? finder_.people() : 0;
  status_.other_person = features.landmarks && finder_.switched();
  const double coloured = coloured_share_of(p.bgr);
  // A camera that has switched to infrared delivers no colours at all: the average would be late.
  grey_for_ = time_since(grey_for_, !is_coloured(coloured), elapsed_);
  status_.coloured_share =
      seen_ && grey_for_.value_or(0.0) < kGrey
          ? status_.coloured_share + over_elapsed(kColourWeight) * (coloured - status_.coloured_share)
          : coloured;
  // Whether light has washed out the colours of the head.
  cv::Mat head = cv::Mat::zeros(p.bgr.size(), CV_8UC1);
  if (features.head) {
    const HeadRegion& region = *features.head;
    cv::ellipse(head,
                cv::RotatedRect(
                    cv::Point2f(static_cast<float>(region.centre.x()), static_cast<float>(region.centre.y())),
                    cv::Size2f(static_cast<float>(2.0 * region.radii.x()),
                               static_cast<float>(2.0 * region.radii.y())),
                    0.0F),
                cv::Scalar::all(255), cv::FILLED);
    head &= features.silhouette;
  }
  const double white = white_share_of(p.bgr, head);
  status_.white_share =
      seen_ ? status_.white_share + over_elapsed(kColourWeight) * (white - status_.white_share) : white;
  seen_ = true;
  status_.known_background = known_background_share();
  background_complete_ = status_.known_background >= 1.0;
  // Share of skin on the arms: the first frames decide quickly, later ones correct slowly.
  const double arms = share(Label::arms);
  const double clothes = share(Label::clothes);
  if (arms + clothes > kLeastLabelled) {
    const double now = arms / (arms + clothes);
    status_.skin_share +=
        (status_.skin_share == 0.0 ? 1.0 : over_elapsed(kSkinWeight)) * (now - status_.skin_share);
  }
  status_.warnings = warnings_of(status_, calibration_.colours);
}

}  // namespace telemime
