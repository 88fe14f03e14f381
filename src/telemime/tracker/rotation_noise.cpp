// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/rotation_noise.h"

#include <algorithm>

#include "telemime/body/arm_parts.h"
#include "telemime/core/visible_line.h"

namespace telemime {
namespace {

// Standard deviations of a visible arm (m): elbow, wrist, hand. The upper ends of those of synthetic people.
constexpr std::array<double, 3> kVisible = {0.07, 0.12, 0.14};

// Of an upper arm, this share in the image shows where it points.
constexpr double kEnough = 0.5;

bool is_in_image(const Eigen::Vector2d& pixel, const Camera& camera) {
  return pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() <= camera.width - 1 &&
         pixel.y() <= camera.height - 1;
}

}  // namespace

NoiseRatios noise_of(const MotionFrame& frame, const Camera& camera) {
  NoiseRatios noise;
  for (std::size_t side = 0; side < kArmParts.size(); ++side) {
    const ArmParts& arm = kArmParts[side];
    const std::array<Joint, 3> joints = {arm.elbow, arm.wrist, arm.knuckle};
    const auto pixel = [&](Joint joint) { return frame.pixels[static_cast<std::size_t>(joint)]; };
    const bool visible = std::any_of(joints.begin(), joints.end(),
                                     [&](Joint joint) { return is_in_image(pixel(joint), camera); });
    if (!frame.spread || visible) {
      continue;
    }
    const double seen = share_in_image(camera, pixel(arm.shoulder), pixel(arm.elbow));
    const auto ratio = [&](std::size_t i) {
      const double variance = frame.spread->covariance[static_cast<std::size_t>(joints[i])].trace();
      return std::max(1.0, variance / (kVisible[i] * kVisible[i]));
    };
    noise.rotation[2 + side] = seen < kEnough ? ratio(0) : 1.0;
    noise.elbow[side] = ratio(1);
    noise.rotation[4 + side] = ratio(2);
  }
  return noise;
}

}  // namespace telemime
