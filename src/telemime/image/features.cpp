// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/features.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/image/distance_map.h"
#include "telemime/image/edges.h"

namespace telemime {
namespace {

void require(bool holds, const std::string& cause, const std::string& remedy) {
  if (!holds) {
    throw Error(ErrorKind::config, cause, remedy);
  }
}

}  // namespace

void ImageConfig::validate() const {
  require(width >= 40 && height >= 30 && width <= 1920 && height <= 1920,
          "the working size " + std::to_string(width) + "x" + std::to_string(height) + " is out of range",
          "use 40x30 to 1920x1920, for instance 160x120");
  require(face_width >= 80, "face_width is too small for the face detector", "use 320");
  require(edges.alpha > 0 && edges.alpha <= 10, "edges.alpha is out of range",
          "use 0 to 10, for instance 1.2");
  require(edges.low >= 0 && edges.low <= edges.high, "edges.low is above edges.high", "use 3 and 8");
  require(edges.distance_cap > 0, "edges.distance_cap must be positive", "use 10");
  require(shadow.darkest > 0 && shadow.darkest < 1, "shadow.darkest must lie between 0 and 1", "use 0.55");
  require(background_rate >= 0 && background_rate <= 1, "background_rate must lie in 0 to 1", "use 0.01");
}

struct FeatureExtractor::Pictures {
  cv::Mat bgr;       ///< of the working size
  cv::Mat grey;      ///< of the working size
  cv::Mat face;      ///< grey, for the face detector
  LogColour colour;  ///< of the working size
};

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

BackgroundEnergy FeatureExtractor::background_of(Pictures& pictures) {
  const BackgroundModel& model = calibration_.background;
  if (model.empty()) {
    // Nothing is known of the scene: everything could be the person.
    return {cv::Mat(pictures.grey.size(), CV_32FC1, cv::Scalar(0)),
            cv::Mat::zeros(pictures.grey.size(), CV_8UC1)};
  }
  subtract(pictures.colour, estimate_gain(model, pictures.colour, believed_));
  return background_energy(model, pictures.colour, config_.shadow, 0.0F);
}

void FeatureExtractor::learn_background(std::span<const Frame> frames) {
  std::vector<cv::Mat> pictures;
  for (const Frame& frame : frames) {
    pictures.push_back(pictures_of(frame).bgr);
  }
  calibration_.background = learn_background_model(pictures);
  believed_.release();
}

void FeatureExtractor::set_calibration(ImageCalibration calibration) {
  calibration_ = std::move(calibration);
  believed_.release();
}

PersonReport FeatureExtractor::begin_person(const Frame& frame) {
  Pictures p = pictures_of(frame);
  const std::optional<TrackedFace> face = head_.restart(p.face);
  if (!face) {
    return {false, "no face was found: look at the camera, in enough light"};
  }
  const BackgroundEnergy background = background_of(p);
  shape_ = HeadShape{};
  std::optional<HeadRegion> head;
  Segmentation rough;
  // The head's outline is measured on a silhouette that the head itself helped to find: twice is enough.
  for (int turn = 0; turn < 2; ++turn) {
    head = region_of(face, p);
    rough = segment(p.colour, background, PersonColours{}, head, config_.segmentation);
    shape_ = adapted(shape_, *head, rough.silhouette, 1.0);
  }
  head = region_of(face, p);
  return learn_person(p.colour, rough.silhouette, *head, calibration_.colours);
}

Observation FeatureExtractor::extract(const Frame& frame) {
  Pictures p = pictures_of(frame);
  Observation out;
  const std::optional<TrackedFace> face = head_.update(p.face);
  out.head = region_of(face, p);
  const BackgroundEnergy background = background_of(p);
  Segmentation segmentation =
      segment(p.colour, background, calibration_.colours, out.head, config_.segmentation);
  out.labels = segmentation.labels;
  out.silhouette = segmentation.silhouette;
  if (out.head) {
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
  if (!calibration_.background.empty() && config_.background_rate > 0) {
    adapt_background(calibration_.background, p.colour, believed_ & ~background.shaded,
                     config_.background_rate);
  }
  return out;
}

}  // namespace telemime
