// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/features.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/core/in_parallel.h"
#include "telemime/core/stopwatch.h"
#include "telemime/core/time_base.h"
#include "telemime/image/edges.h"
#include "telemime/image/person_shape.h"
#include "telemime/nets/models/table.h"

namespace telemime {
namespace {

constexpr double kReferenceWidth = 160.0;  // px: lengths of the settings are given for this width
constexpr int kHalf = 127;                 // of the probability in a mask, 0 to 255
// Around the head, in its radii: where an arm hides the outline of the head.
constexpr double kAside = 1.6;
constexpr double kAbove = 1.5;
constexpr double kBelow = 0.8;
constexpr int kFewArms = 50;  // in one of this many pixels
// Share of the background that must be known to look for a head by its outline.
constexpr double kEnoughBackground = 0.3;
// A head region with less skin and hair than this, for longer than this, is not the head.
constexpr double kLeastSkin = 0.25;
constexpr double kMostWithoutSkin = 4.0;  // 1/25 s
constexpr double kPause = 1.0;            // s; no motion is followed across it
constexpr double kMostElapsed = 8.0;      // 1/25 s that one frame teaches for

void require_colour_image(const Frame& frame) {
  if (frame.image.empty() || frame.image.type() != CV_8UC3) {
    throw Error(ErrorKind::input, "frame " + std::to_string(frame.index) + " has no 8-bit colour image");
  }
}

/// Takes what a network does not take for the person, such as somebody else behind, out of the silhouette. It
/// is unknown what it is: no cue counts it. Where the network sees only a part of the silhouette, it is not
/// believed.
void ignore_strangers(const cv::Mat& mask, cv::Mat& silhouette, cv::Mat& labels) {
  const cv::Mat strange = silhouette & ~person_area(mask, std::max(2, mask.cols / 40));
  if (2 * cv::countNonZero(strange) < cv::countNonZero(silhouette)) {
    silhouette.setTo(0, strange);
    labels.setTo(static_cast<unsigned char>(Label::ignore), strange);
  }
}

/// Whether all of the picture changed: a hand is on the lens, or the camera was turned away.
bool covers_everything(const cv::Mat& silhouette) {
  return cv::countNonZero(silhouette) * 10 > static_cast<int>(silhouette.total()) * 9;
}

/// The silhouette where a network sees the person. What of it are arms or clothes is not known.
Segmentation silhouette_of_mask(const cv::Mat& mask, Segmentation segmentation) {
  cv::compare(mask, kHalf, segmentation.silhouette, cv::CMP_GT);
  segmentation.labels.setTo(static_cast<unsigned char>(Label::background), segmentation.silhouette == 0);
  segmentation.labels.setTo(
      static_cast<unsigned char>(Label::ignore),
      (segmentation.labels != static_cast<unsigned char>(Label::head)) & segmentation.silhouette);
  return segmentation;
}

/// Whether an arm is beside or in front of the head, so that the outline there is not the head's.
bool arms_near(const HeadRegion& head, const cv::Mat& labels) {
  const cv::Rect box = cv::Rect(cv::Point(static_cast<int>(head.centre.x() - kAside * head.radii.x()),
                                          static_cast<int>(head.centre.y() - kAbove * head.radii.y())),
                                cv::Point(static_cast<int>(head.centre.x() + kAside * head.radii.x()),
                                          static_cast<int>(head.centre.y() + kBelow * head.radii.y()))) &
                       cv::Rect(cv::Point(0, 0), labels.size());
  return !box.empty() &&
         cv::countNonZero(labels(box) == static_cast<unsigned char>(Label::arms)) * kFewArms > box.area();
}

}  // namespace

FeatureExtractor::FeatureExtractor(const ImageConfig& config)
    : config_((check_settings(config), config)), head_(config.head, config.cascades) {
  const std::filesystem::path models = find_models(config.models);
  if (config.landmarks && !models.empty()) {
    finder_ = PersonFinder(models);
  }
}

std::optional<PoseLandmarks> FeatureExtractor::find_landmarks(const Frame& frame) {
  if (!finder_.has_networks() || found_in_ == frame.index) {
    return found_;
  }
  require_colour_image(frame);
  Stopwatch watch;
  // Networks see a square of 256 pixels: a larger picture would only cost time.
  constexpr int kWidest = 640;
  cv::Mat picture = frame.image;
  if (picture.cols > kWidest) {
    cv::resize(frame.image, picture, {kWidest, std::max(1, frame.image.rows * kWidest / frame.image.cols)}, 0,
               0, cv::INTER_AREA);
  }
  found_ = finder_.find(picture, frame.time);
  if (found_) {
    found_ = scaled_to(std::move(*found_), picture.size(), working_size());
  }
  found_in_ = frame.index;
  networks_ms_ = watch.lap();
  return found_;
}

std::optional<PoseLandmarks> FeatureExtractor::find_person(const Frame& frame, bool own_mask) {
  std::optional<PoseLandmarks> found = find_landmarks(frame);
  if (found) {
    Stopwatch watch;
    // Where colours are not known, the mask is the silhouette.
    const bool keeps = !own_mask && calibration_.colours.known() && has_colour(status_);
    cv::resize(finder_.mask(keeps), found->mask, working_size(), 0.0, 0.0, cv::INTER_AREA);
    networks_ms_ += watch.lap();
  }
  return found;
}

FeatureExtractor::WorkingImages FeatureExtractor::working_images(const Frame& frame) const {
  require_colour_image(frame);
  // The working image.
  WorkingImages p;
  cv::resize(frame.image, p.bgr, cv::Size(config_.width, config_.height), 0, 0, cv::INTER_AREA);
  cv::cvtColor(p.bgr, p.grey, cv::COLOR_BGR2GRAY);
  // The face detector needs more pixels than the working image has, but not all of a large frame.
  const int face_width = std::min(config_.face_width, frame.image.cols);
  const int face_height = std::max(1, frame.image.rows * face_width / frame.image.cols);
  if (face_width == config_.width && face_height == config_.height) {
    p.face = p.grey;
  } else {
    cv::Mat small;
    cv::resize(frame.image, small, cv::Size(face_width, face_height), 0, 0, cv::INTER_AREA);
    cv::cvtColor(small, p.face, cv::COLOR_BGR2GRAY);
  }
  p.colour = log_colour(p.bgr);
  return p;
}

void FeatureExtractor::prepare(const Frame& frame) {
  prepared_in_ = -1;
  prepared_ = working_images(frame);
  WorkingImages& p = prepared_;
  in_parallel([&] { p.gradient = deriche_gradient(p.grey, config_.edges.alpha); },
              [&] {
                // The colours, if it is known which pixels show the background in this light.
                if (!calibration_.background.empty() && !background_mask_.empty()) {
                  p.lit = in_light_of_background(p.colour, background_mask_);
                }
                if (calibration_.background.empty() || p.lit) {
                  const LogColour& colour = p.lit ? p.lit->colour : p.colour;
                  p.scene = compare_with_scene(colour);
                  p.person = colour_energies(colour, calibration_.colours);
                }
              },
              [&] {
                // With the background of the frame before. After a pause, the person may be anywhere in it.
                const bool due = camera_check_is_due(elapsed_until(frame.time));
                const bool paused = last_time_ && frame.time - *last_time_ > kPause;
                if (due && !paused && !motion_image_.empty() && !background_mask_.empty()) {
                  p.camera = check_camera(p.grey);
                }
              });
  prepared_in_ = frame.index;
}

double FeatureExtractor::elapsed_until(double time) const {
  return last_time_ ? units_between(*last_time_, time) : 1.0;
}

// A rate per 1/25 s over the time since the last frame, or less: one frame does not speak for a whole pause.
double FeatureExtractor::over_elapsed(double rate) const {
  return elapsed_ == 1.0 ? rate : 1.0 - std::pow(1.0 - rate, std::min(elapsed_, kMostElapsed));
}

PersonReport FeatureExtractor::learn_person(const Frame& frame) {
  // With networks a person is tracked while their colours are looked for: if the frame is refused, the head
  // that is being followed stays as it was. Without them, what was found now is a better start than an old
  // track.
  prepared_in_ = -1;
  const HeadTracker head = head_;
  const HeadShape shape = shape_;
  PersonReport report = learn_person_in(frame);
  if (!report.accepted && has_networks() && head.current()) {
    head_ = head;
    shape_ = shape;
  }
  return report;
}

PersonReport FeatureExtractor::learn_person_in(const Frame& frame) {
  // Find the face, or the head by its outline if a mask hides the face.
  WorkingImages p = working_images(frame);
  // With networks a person is found without colours, too: what a grey picture teaches would be wrong later.
  if (has_networks() && !is_coloured(coloured_share_of(p.bgr))) {
    return {false, "the image has no colour: colours are learned as soon as it has some"};
  }
  shape_ = HeadShape{};
  const std::optional<PoseLandmarks> landmarks = find_person(frame, true);
  const cv::Mat mask = landmarks ? landmarks->mask : cv::Mat();
  head_.reset();
  std::optional<TrackedFace> face =
      landmarks ? face_of(landmarks, p)
                : head_.detect(p.face, cv::Rect(0, 0, p.face.cols, p.face.rows), skin_test(p));
  if (!face && known_background_share() > kEnoughBackground) {
    WorkingImages copy = p;
    const BackgroundEnergy scene = background_energy_of(copy, std::nullopt);
    follow_head_outline(
        p, segment(copy.colour, scene, PersonColours{}, std::nullopt, config_.segmentation).silhouette);
    face = head_.current();
  }
  if (!face && has_networks() && !landmarks) {
    return {false, "nobody is in the picture"};
  }
  if (!face) {
    return {false, "no face was found: look at the camera, and make sure that there is enough light"};
  }
  // Reject faces that are part of the background.
  std::optional<HeadRegion> head = head_region_of(face, p);
  const BackgroundEnergy background = background_energy_of(p, head, mask);
  if (!landmarks && !differs_from_background(background, *head)) {
    head_.reset();
    return {false, "the detected face belongs to the background (a poster?): sit in front of the camera"};
  }
  // Segment without colours and measure the head on the silhouette. The silhouette depends on the head, so
  // this is done twice.
  Segmentation rough;
  for (int turn = 0; turn < 2; ++turn) {
    rough = segment(p.colour, background, PersonColours{}, head, config_.segmentation);
    if (landmarks) {
      cv::compare(mask, kHalf, rough.silhouette, cv::CMP_GT);
    } else if (!background_complete_) {
      // Neither the background nor the colours are known yet: a graph cut separates the person.
      rough.silhouette = cut_person(p.bgr, *head);
    }
    shape_ = adapted(shape_, *head, rough.silhouette, 1.0);
    head = head_region_of(face, p);
  }
  if (!head->detected && !faces_camera(*head, rough.silhouette)) {
    head_.reset();
    return {false, "no face was found, and the outline is not that of a person facing the camera"};
  }
  // Learn the colours inside the silhouette.
  PersonReport report = learn_person_colours(p.colour, rough.silhouette, *head, calibration_.colours);
  if (report.accepted) {
    face_memory_ = FaceMemory{};
    silhouette_ = rough.silhouette;
  }
  return report;
}

FrameFeatures FeatureExtractor::extract(const Frame& frame) {
  if (prepared_in_ != frame.index) {
    prepare(frame);
  }
  prepared_in_ = -1;
  WorkingImages p = std::move(prepared_);
  FrameFeatures out;
  // After a pause, the head and the silhouette may be anywhere.
  if (last_time_ && frame.time - *last_time_ > kPause) {
    head_.restart();
    silhouette_.release();
  }
  elapsed_ = elapsed_until(frame.time);
  last_time_ = frame.time;

  // Head: track the face; a head that the background explains is rejected. A covered lens shows none.
  status_.brightness = cv::mean(p.grey)[0];
  status_.detail = detail_of(p.grey);
  out.landmarks = find_person(frame);
  out.networks_ms = networks_ms_;
  std::optional<TrackedFace> face;
  if (shows_something(status_)) {
    face = face_of(out.landmarks, p);
  } else {
    head_.reset();
  }
  const HeadShape previous_shape = shape_;
  if (face && head_.replaced()) {
    // Until now the outline gave the face square. The head keeps its size around the detected square.
    shape_ = rebased(shape_, *head_.replaced(), *face);
  }
  out.head = head_region_of(face, p);
  const BackgroundEnergy background =
      background_energy_of(p, out.head, out.landmarks ? out.landmarks->mask : cv::Mat());
  if (out.head && !out.landmarks && !differs_from_background(background, *out.head)) {
    head_.reset();
    out.head.reset();
    shape_ = previous_shape;
  }

  // Labels and silhouette.
  if (!p.person) {
    p.person = colour_energies(p.colour, calibration_.colours);
  }
  Segmentation segmentation =
      segment(*p.person, background, calibration_.colours.known(), out.head, config_.segmentation);
  const bool colours_help = calibration_.colours.known() && has_colour(status_);
  if (out.landmarks && !colours_help) {
    segmentation = silhouette_of_mask(out.landmarks->mask, std::move(segmentation));
  }
  // The correlation can drift off the head. The colours inside the head region reveal it.
  const bool has_skin = !out.head || !calibration_.colours.known() || segmentation.head_share >= kLeastSkin;
  without_skin_ = time_since(without_skin_, !has_skin, elapsed_);
  if (without_skin_ && *without_skin_ >= kMostWithoutSkin) {
    head_.reset();
    without_skin_.reset();
  }
  if (!out.landmarks && covers_everything(segmentation.silhouette)) {
    head_.reset();
    out.head.reset();
  }
  // Hands in front of the face. This needs an accurate head region: a shifted face differs everywhere.
  constexpr double kReliableMatch = 0.75;
  if (out.head && calibration_.colours.known() && (face->detected || face->match > kReliableMatch)) {
    label_hands_over_face(face_memory_, p.colour, *out.head, segmentation.skin, segmentation.labels,
                          std::min(elapsed_, kMostElapsed));
  }
  out.labels = segmentation.labels;
  out.silhouette = segmentation.silhouette.clone();
  if (out.landmarks) {
    ignore_strangers(out.landmarks->mask, out.silhouette, out.labels);
  }

  // Update the head from the outline of the silhouette.
  if (shows_something(status_) && !covers_everything(out.silhouette)) {
    follow_head_outline(p, out.silhouette);
  }
  if (out.head && !arms_near(*out.head, out.labels)) {
    shape_ = adapted(shape_, *out.head, out.silhouette, over_elapsed(config_.head_shape_rate));
  }

  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(3, 3));
  in_parallel(
      [&] {
        // Edges inside the silhouette, whose outline may peak one pixel outside it, and their distance map.
        cv::Mat grown;
        cv::dilate(out.silhouette, grown, square);
        out.edges = find_edges(p.gradient, grown, config_.edges.low, config_.edges.high);
        out.distance =
            distance_map(out.edges, config_.edges.distance_cap *
                                        reference_width(config_.width, config_.height) / kReferenceWidth);
      },
      [&] {
        cv::Mat grown;
        cv::dilate(segmentation.silhouette, grown, square, cv::Point(-1, -1), 3);
        cv::bitwise_not(grown, background_mask_);
        update_background(p, background, out.landmarks);
        update_camera_motion(p);
      });
  silhouette_ = out.silhouette;
  update_status(p, out);
  return out;
}

}  // namespace telemime
