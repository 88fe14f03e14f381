// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/feature_config.h"

#include <algorithm>
#include <cmath>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

void require(bool holds, const std::string& cause, const std::string& remedy) {
  if (!holds) {
    throw Error(ErrorKind::config, cause, remedy);
  }
}

/// Whether the clothes have stripes or prints: two colours of different chroma with more than 10 % each.
bool patterned(const ColourMixture& clothes) {
  for (const ColourGaussian& a : clothes) {
    for (const ColourGaussian& b : clothes) {
      const float apart = (a.mean.head<2>() - b.mean.head<2>()).norm();
      if (a.weight > 0.1F && b.weight > 0.1F && apart > 0.3F) {
        return true;
      }
    }
  }
  return false;
}

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

void ImageConfig::validate() const {
  require(width >= kNarrowest && height >= kLowest && width <= kLargest && height <= kLargest,
          "the working size " + std::to_string(width) + "x" + std::to_string(height) + " is out of range",
          "use 40x30 to 1920x1920, for instance 160x120");
  require(face_width >= 80, "face_width is too small for the face detector", "use 320");
  require(head.detect_every >= 1 && head.search_every >= 1, "head.detect_every and search_every count frames",
          "use 1 or more");
  require(head_shape_rate >= 0 && head_shape_rate <= 1, "head_shape_rate must lie in 0 to 1", "use 0.2");
  require(edges.alpha > 0 && edges.alpha <= 10, "edges.alpha is out of range",
          "use 0 to 10, for instance 1.2");
  require(edges.low >= 0 && edges.low <= edges.high, "edges.low is above edges.high", "use 3 and 8");
  require(edges.distance_cap > 0, "edges.distance_cap must be positive", "use 10");
  require(shadow.darkest > 0 && shadow.darkest < 1, "shadow.darkest must lie between 0 and 1", "use 0.55");
  require(background_rate >= 0 && background_rate <= 1, "background_rate must lie in 0 to 1", "use 0.01");
  require(motion_every >= 0, "motion_every must not be negative", "use 10, or 0 for never");
}

std::vector<std::string> warnings_of(const ImageStatus& status, const PersonColours& colours) {
  const auto percent = [](double share) { return std::to_string(std::lround(100 * share)) + " %"; };
  std::vector<std::string> out;
  if (status.brightness < 12) {
    out.push_back("the image is black (mean grey level " + std::to_string(std::lround(status.brightness)) +
                  " of 255): is the lens covered?");
  } else if (status.brightness < 40) {
    out.push_back("the image is dark (mean grey level " + std::to_string(std::lround(status.brightness)) +
                  " of 255): turn on a light");
  }
  if (!status.person) {
    out.emplace_back("no person is visible");
  }
  if (status.camera_motion > 0.7) {
    out.emplace_back("the camera moves, so the background model cannot be used: fix the camera");
  }
  if (std::abs(status.light_change) > 0.06) {
    out.push_back("the light changed by " + percent(std::exp(status.light_change) - 1) +
                  " since the background was learned");
  }
  if (colours.known() && status.person && status.skin_share < 0.13) {
    out.push_back("little skin of the arms is visible (" + percent(status.skin_share) +
                  " of arms and clothes): long sleeves or hidden arms reduce the accuracy");
  }
  if (patterned(colours.clothes)) {
    out.emplace_back("the clothes have several colours: plain clothes are easier to distinguish from skin");
  }
  return out;
}

}  // namespace telemime
