// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/feature_config.h"

#include <algorithm>
#include <cmath>

namespace telemime {
namespace {

constexpr int kNarrowest = 40;
constexpr int kLowest = 30;
constexpr int kLargest = 1920;

}  // namespace

ImageConfig fitted_to(ImageConfig config, const Camera& camera) {
  config.segmentation.focal_length = static_cast<float>(camera.fx / camera.width);
  const Camera working = camera.scaled_to(config.width, config.height);
  const double stretched = working.fy / working.fx;
  // Even sides are up to one pixel off: a configuration that was fitted must not change again.
  const double rounding = 1.1 * (1.0 / config.width + 1.0 / config.height);
  if (std::abs(stretched - 1.0) < std::max(0.01, rounding)) {
    return config;
  }
  const auto even = [](double size, int least) {
    return std::clamp(2 * static_cast<int>(std::lround(0.5 * size)), least, kLargest);
  };
  const double root = std::sqrt(stretched);
  const double width = root * config.width;
  const double height = config.height / root;
  const double wanted = std::clamp(width, static_cast<double>(kNarrowest), static_cast<double>(kLargest));
  config.height = even(height * wanted / width, kLowest);
  const bool bound = config.height == kLowest || config.height == kLargest;
  config.width = even(bound ? config.height * width / height : wanted, kNarrowest);
  return config;
}

SettingTable settings_of(ImageConfig& c) {
  SettingTable table;
  table.rows = {
      number("image.width", &c.width, {kNarrowest, kLargest}, "px",
             "Width of the working image; an input of another shape gets as many pixels."),
      number("image.height", &c.height, {kLowest, kLargest}, "px", "Height of the working image."),
      number("image.face_width", &c.face_width, {80, 4096}, "px",
             "Largest width of the image in which the face detector searches."),
      text("image.models", c.models, {}, "Folder of the networks; empty: searched in the usual places."),
      flag("image.landmarks", c.landmarks,
           "Find the person, their mask and their landmarks with networks, where these are installed."),
      number("image.mask_trust", &c.mask_trust, {0, 1000}, "",
             "Most that the person mask adds to the energy of the background, -2 ln of the odds."),
      text("image.cascades", c.cascades, {},
           "Folder of OpenCV's face cascades; empty: searched in the usual places."),
      number("image.background_rate", &c.background_rate, {0, 1}, "",
             "Share by which visible background is updated in 1/25 s."),
      number("image.motion_every", &c.motion_every, {0, 100000}, "1/25 s",
             "Interval of the checks for camera motion; 0: no checks."),
      number("image.head.detect_every", &c.head.detect_every, {1, 1000}, "1/25 s",
             "Interval of face detections while the face is tracked."),
      number("image.head.search_every", &c.head.search_every, {1, 1000}, "1/25 s",
             "Interval of face detections while no face is tracked."),
      number("image.head.lost_match", &c.head.lost_match, {-1, 1}, "",
             "Correlation below which the tracked face is not at its predicted place."),
      number("image.head.lost_after", &c.head.lost_after, {0, 100000}, "1/25 s",
             "Time without a reliable position after which the face is lost."),
      number("image.head.smallest_face", &c.head.smallest_face, {0, 1}, "",
             "Smallest face that is detected, as a share of the image height."),
      number("image.head.shape_rate", &c.head_shape_rate, {0, 1}, "",
             "Share by which the outline of the head is updated in 1/25 s."),
      number("image.shadow.darkest", &c.shadow.darkest, {0.01, 0.99}, "",
             "Smallest ratio of luminance that counts as a shadow."),
      number("image.shadow.typical", &c.shadow.typical, {0.001, 10}, "",
             "Mean darkening in a shadow (natural logarithm)."),
      number("image.shadow.chroma", &c.shadow.chroma, {0, 10}, "",
             "Standard deviation of the chroma in a shadow."),
      number("image.shadow.prior_cost", &c.shadow.prior_cost, {0, 1000}, "",
             "-2 ln of the share of pixels in a shadow."),
      number("image.segmentation.unknown_cost", &c.segmentation.unknown_cost, {0, 1000}, "",
             "-2 ln of the density of colours of the person that were not learned."),
      number("image.segmentation.unknown_background_cost", &c.segmentation.unknown_background_cost, {0, 1000},
             "", "-2 ln of the density of background that was not seen yet."),
      number("image.segmentation.person_cost", &c.segmentation.person_cost, {-1000, 1000}, "",
             "-2 ln of the prior odds of person to background."),
      number("image.segmentation.vote_limit", &c.segmentation.vote_limit, {0, 1000}, "",
             "Largest vote of a pixel in the 3x3 vote on person or background."),
      number("image.segmentation.head_bonus", &c.segmentation.head_bonus, {0, 1000}, "",
             "Vote for the person inside the ellipse of the head."),
      number("image.segmentation.least_part", &c.segmentation.least_part, {0, 1}, "",
             "Smallest part of a silhouette, as a share of the image."),
      number("image.edges.alpha", &c.edges.alpha, {0.01, 10}, "",
             "Parameter of the Deriche filter; smaller smooths more."),
      number("image.edges.low", &c.edges.low, {0, 255}, "grey levels/px",
             "Lower threshold of the hysteresis."),
      number("image.edges.high", &c.edges.high, {0, 255}, "grey levels/px",
             "Upper threshold of the hysteresis."),
      number("image.edges.distance_cap", &c.edges.distance_cap, {0.1, 1000}, "px",
             "Largest distance to an edge in a working image of 160x120; grows with the square root of its "
             "area."),
  };
  table.rules = {{c.edges.low <= c.edges.high, "image.edges.low must not be above image.edges.high"}};
  return table;
}

}  // namespace telemime
