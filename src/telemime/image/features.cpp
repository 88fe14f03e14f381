// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/features.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/image/camera_motion.h"
#include "telemime/image/distance_map.h"
#include "telemime/image/edges.h"
#include "telemime/image/person_shape.h"

namespace telemime {
namespace {

cv::Rect whole_of(const cv::Mat& picture) {
  return {0, 0, picture.cols, picture.rows};
}

/// An arm beside or before the head: its outline is not the head's.
bool arms_near(const HeadRegion& head, const cv::Mat& labels) {
  const cv::Rect box = cv::Rect(cv::Point(static_cast<int>(head.centre.x() - 1.6 * head.radii.x()),
                                          static_cast<int>(head.centre.y() - 1.5 * head.radii.y())),
                                cv::Point(static_cast<int>(head.centre.x() + 1.6 * head.radii.x()),
                                          static_cast<int>(head.centre.y() + 0.8 * head.radii.y()))) &
                       cv::Rect(cv::Point(0, 0), labels.size());
  return !box.empty() &&
         cv::countNonZero(labels(box) == static_cast<unsigned char>(Label::arms)) * 50 > box.area();
}

}  // namespace

FeatureExtractor::FeatureExtractor(const ImageConfig& config)
    : config_((config.validate(), config)), head_(config.head, config.cascades) {}

FeatureExtractor::Pictures FeatureExtractor::pictures_of(const Frame& frame) const {
  if (frame.image.empty() || frame.image.type() != CV_8UC3) {
    throw Error(ErrorKind::input, "frame " + std::to_string(frame.index) + " holds no colour picture");
  }
  Pictures p;
  cv::resize(frame.image, p.bgr, cv::Size(config_.width, config_.height), 0, 0, cv::INTER_AREA);
  cv::cvtColor(p.bgr, p.grey, cv::COLOR_BGR2GRAY);
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

std::optional<HeadRegion> FeatureExtractor::region_of(const std::optional<TrackedFace>& face,
                                                      const Pictures& p) const {
  if (!face) {
    return std::nullopt;
  }
  return head_region(*face, shape_, static_cast<double>(config_.width) / p.face.cols,
                     static_cast<double>(config_.height) / p.face.rows);
}

cv::Rect FeatureExtractor::search_area(const Pictures& p) const {
  if (!all_valid_ || silhouette_.empty()) {
    return whole_of(p.face);
  }
  // Where the scene is known a face is nowhere but in the silhouette of the frame before, or near it.
  const cv::Rect box = cv::boundingRect(silhouette_);
  if (box.empty()) {
    return {};
  }
  const double sx = static_cast<double>(p.face.cols) / config_.width;
  const double sy = static_cast<double>(p.face.rows) / config_.height;
  const int margin = p.face.cols / 16;
  return cv::Rect(static_cast<int>(box.x * sx) - margin, static_cast<int>(box.y * sy) - margin,
                  static_cast<int>(box.width * sx) + 2 * margin,
                  static_cast<int>(box.height * sy) + 2 * margin) &
         whole_of(p.face);
}

FaceTest FeatureExtractor::face_test(const Pictures& p) const {
  const double sx = static_cast<double>(config_.width) / p.face.cols;
  const double sy = static_cast<double>(config_.height) / p.face.rows;
  return [sx, sy, &colour = p.colour](const cv::Rect& face) {
    constexpr double kLeastSkin = 0.2;
    return possible_skin(colour, cv::Rect(static_cast<int>(face.x * sx), static_cast<int>(face.y * sy),
                                          std::max(1, static_cast<int>(face.width * sx)),
                                          std::max(1, static_cast<int>(face.height * sy)))) > kLeastSkin;
  };
}

void FeatureExtractor::follow_outline(const Pictures& p, const cv::Mat& silhouette) {
  if (head_.confirmed()) {
    return;
  }
  if (const auto head = head_from_silhouette(silhouette)) {
    const double sx = static_cast<double>(config_.width) / p.face.cols;
    const double sy = static_cast<double>(config_.height) / p.face.rows;
    const cv::Rect2d square = face_square(*head, shape_, sx, sy);
    const auto& track = head_.current();
    const cv::Point2d centre(square.x + 0.5 * square.width, square.y + 0.5 * square.height);
    if (track && cv::norm(track->centre - centre) > 0.7 * track->side) {
      head_.forget();
    }
    head_.adopt(p.face, square, 0.5);
  }
}

BackgroundEnergy FeatureExtractor::background_of(Pictures& pictures, const std::optional<HeadRegion>& head) {
  const BackgroundModel& model = calibration_.background;
  const cv::Size size = pictures.grey.size();
  cv::Mat unknown;
  if (!all_valid_ || model.empty()) {
    unknown = energy(calibration_.surroundings, pictures.colour);
    cv::min(unknown, config_.segmentation.unknown_background_cost, unknown);
    // Where the scene was never seen, place and the frame before must help the colours.
    constexpr float kPlace = 5.0F;
    constexpr float kBefore = 4.0F;
    if (head) {
      unknown += kPlace * body_prior(size, *head);
    }
    if (!silhouette_.empty()) {
      cv::add(unknown, cv::Scalar(kBefore), unknown, silhouette_);
    }
  }
  if (model.empty()) {
    return {unknown, cv::Mat::zeros(size, CV_8UC1), true};
  }
  const LogColour gain = estimate_gain(model, pictures.colour, believed_);
  status_.light_change = cv::mean(gain.l)[0];
  subtract(pictures.colour, gain);
  BackgroundEnergy out = background_energy(model, pictures.colour, config_.shadow, unknown);
  out.doubtful = calibration_.doubtful;
  return out;
}

bool FeatureExtractor::stands_out(const BackgroundEnergy& background, const HeadRegion& head) const {
  // A face on a poster is where the background says; a person's head is not.
  constexpr float kExplained = -9.0F;
  int inside = 0;
  int explained = 0;
  for (int r = 0; r < background.energy.rows; ++r) {
    for (int c = 0; c < background.energy.cols; ++c) {
      const double x = (c - head.centre.x()) / head.radii.x();
      const double y = (r - head.centre.y()) / head.radii.y();
      if (x * x + y * y < 0.8) {
        ++inside;
        explained += background.energy.at<float>(r, c) < kExplained ? 1 : 0;
      }
    }
  }
  return inside > 0 && explained * 3 < inside * 2;
}

void FeatureExtractor::learn_background(std::span<const Frame> frames) {
  std::vector<cv::Mat> pictures;
  for (const Frame& frame : frames) {
    pictures.push_back(pictures_of(frame).bgr);
  }
  ImageCalibration fresh;
  fresh.background = learn_background_model(pictures);
  fresh.colours = calibration_.colours;
  set_calibration(std::move(fresh));
}

void FeatureExtractor::set_calibration(ImageCalibration calibration) {
  calibration_ = std::move(calibration);
  // The model follows the light: in planes of its own, not in those of whoever gave them.
  BackgroundModel& scene = calibration_.background;
  for (cv::Mat* plane : {&scene.mean.u, &scene.mean.v, &scene.mean.l, &scene.chroma_variance,
                         &scene.luminance_variance, &scene.valid, &scene.seen}) {
    *plane = plane->clone();
  }
  if (!calibration_.background.empty() &&
      calibration_.background.valid.size() != cv::Size(config_.width, config_.height)) {
    throw Error(ErrorKind::config, "the background was learned at another working size",
                "calibrate again, with the same --size and a camera of the same shape");
  }
  believed_.release();
  silhouette_.release();
  motion_grey_.release();
  const cv::Mat& valid = calibration_.background.valid;
  all_valid_ = !valid.empty() && cv::countNonZero(valid) == static_cast<int>(valid.total());
}

PersonReport FeatureExtractor::learn_person(const Frame& frame) {
  Pictures p = pictures_of(frame);
  shape_ = HeadShape{};
  std::optional<TrackedFace> face = head_.restart(p.face, whole_of(p.face), face_test(p));
  if (!face && all_valid_share() > 0.3) {
    // A mask hides a face, but not the outline of a head.
    Pictures copy = p;
    copy.colour = {p.colour.u.clone(), p.colour.v.clone(), p.colour.l.clone()};
    const BackgroundEnergy scene = background_of(copy, std::nullopt);
    follow_outline(
        p, segment(copy.colour, scene, PersonColours{}, std::nullopt, config_.segmentation).silhouette);
    face = head_.current();
  }
  if (!face) {
    return {false, "no face was found: look at the camera, in enough light"};
  }
  std::optional<HeadRegion> head = region_of(face, p);
  const BackgroundEnergy background = background_of(p, head);
  if (!stands_out(background, *head)) {
    head_.forget();
    return {false, "the face found belongs to the background (a poster?): sit before the camera"};
  }
  Segmentation rough;
  // The head's outline is measured on a silhouette that the head itself helped to find: twice is enough.
  for (int turn = 0; turn < 2; ++turn) {
    rough = segment(p.colour, background, PersonColours{}, head, config_.segmentation);
    if (!all_valid_) {
      // Without a background, colours that are not known yet cannot tell the person from the scene.
      rough.silhouette = cut_person(p.bgr, *head);
    }
    shape_ = adapted(shape_, *head, rough.silhouette, 1.0);
    head = region_of(face, p);
  }
  if (!head->detected && !faces_camera(*head, rough.silhouette)) {
    head_.forget();
    return {false, "no face was found, and the outline is not that of somebody who faces the camera"};
  }
  PersonReport report = learn_person_colours(p.colour, rough.silhouette, *head, calibration_.colours);
  if (report.accepted) {
    face_memory_ = FaceMemory{};
    silhouette_ = rough.silhouette;
  }
  return report;
}

FrameFeatures FeatureExtractor::extract(const Frame& frame) {
  Pictures p = pictures_of(frame);
  FrameFeatures out;
  const std::optional<TrackedFace> face = head_.update(p.face, search_area(p), face_test(p));
  const HeadShape before = shape_;
  if (face && head_.replaced()) {
    // The outline led so far: the head is as large as it was, around another square.
    shape_ = carried(shape_, *head_.replaced(), *face);
  }
  out.head = region_of(face, p);
  const BackgroundEnergy background = background_of(p, out.head);
  if (out.head && !stands_out(background, *out.head)) {
    head_.forget();
    out.head.reset();
    shape_ = before;
  }
  Segmentation segmentation =
      segment(p.colour, background, calibration_.colours, out.head, config_.segmentation);
  // The correlation can slide from the head to something else; colours then tell.
  hollow_ = out.head && calibration_.colours.known() && segmentation.head_share < 0.25 ? hollow_ + 1 : 0;
  if (hollow_ > 4) {
    head_.forget();
    hollow_ = 0;
  }
  // Only with the head well in place: a shifted look differs everywhere.
  constexpr double kInPlace = 0.75;
  if (out.head && calibration_.colours.known() && (face->detected || face->match > kInPlace)) {
    uncover_hands(face_memory_, p.colour, *out.head, segmentation.skin, segmentation.labels);
  }
  out.labels = segmentation.labels;
  out.silhouette = segmentation.silhouette;
  follow_outline(p, out.silhouette);
  if (out.head && !arms_near(*out.head, out.labels)) {
    shape_ = adapted(shape_, *out.head, out.silhouette, config_.head_shape_rate);
  }

  const cv::Mat square = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(3, 3));
  cv::Mat grown;
  cv::dilate(out.silhouette, grown, square);
  // The outline may peak one pixel outside the silhouette.
  out.edges =
      find_edges(deriche_gradient(p.grey, config_.edges.alpha), grown, config_.edges.low, config_.edges.high);
  out.distance = distance_map(out.edges, config_.edges.distance_cap * config_.width / 160.0);

  cv::dilate(grown, grown, square, cv::Point(-1, -1), 2);
  cv::bitwise_not(grown, believed_);
  silhouette_ = out.silhouette;
  // While the camera moves there is nothing to learn; after a knock everything is learned anew.
  constexpr double kKnocked = 1.5;
  if (status_.camera_motion > kKnocked && !calibration_.background.empty()) {
    calibration_.background.valid.setTo(0);
    calibration_.background.seen.setTo(0);
  } else if (!calibration_.background.empty() && config_.background_rate > 0) {
    cv::Mat where = believed_.clone();
    where.setTo(0, background.shaded);
    adapt_background(calibration_.background, p.colour, where, config_.background_rate);
  }
  watch_camera(p.grey);
  update_status(p, out);
  return out;
}

}  // namespace telemime
