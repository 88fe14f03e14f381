// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "telemime/likelihood/backend.h"
#include "telemime/render/renderer.h"

namespace telemime {
namespace {

// Counts of at most 255 pixels of a row by class: in the model, and in model and image. Bytes hold them, so
// that the compiler can add many at once. Pixels with labels above 3 count nowhere.
struct ByteCounts {
  std::array<std::uint8_t, kSurfaceClassCount> model{};
  std::array<std::uint8_t, kSurfaceClassCount> both{};
};

ByteCounts count_bytes(const std::uint8_t* surface, const std::uint8_t* label, int pixels) {
  ByteCounts counts;
  for (std::uint8_t c = 1; c <= kSurfaceClassCount; ++c) {
    std::uint8_t model = 0;
    std::uint8_t both = 0;
    for (int x = 0; x < pixels; ++x) {
      // Without branches, so that the compiler can vectorise it.
      const auto is = static_cast<std::uint8_t>(surface[x] == c);
      model = static_cast<std::uint8_t>(model + (is & static_cast<std::uint8_t>(label[x] <= 3)));
      both = static_cast<std::uint8_t>(both + (is & static_cast<std::uint8_t>(label[x] == c)));
    }
    counts.model[c - 1U] = model;
    counts.both[c - 1U] = both;
  }
  return counts;
}

void count_overlap(const PreparedFrame& frame, const Rendering& rendering, Reductions& r) {
  for (int y = rendering.top; y < rendering.bottom; ++y) {
    const auto* label = frame.labels.ptr<std::uint8_t>(y);
    const std::uint8_t* surface =
        rendering.surface.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(rendering.width);
    constexpr int kMost = 255;
    for (int x = rendering.left; x < rendering.right; x += kMost) {
      const ByteCounts counts = count_bytes(surface + x, label + x, std::min(kMost, rendering.right - x));
      for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
        r.model[c] += counts.model[c];
        r.both[c] += counts.both[c];
      }
    }
  }
}

// std::lround for numbers from -0.5 (not included) to 2^23, without a call.
int nearest_to(float x) {
  const int whole = static_cast<int>(x);
  return whole + (x - static_cast<float>(whole) >= 0.5F ? 1 : 0);
}

void sum_contour(const PreparedFrame& frame, const std::vector<Eigen::Vector2f>& contour, Reductions& r) {
  double sum = 0.0;
  for (const Eigen::Vector2f& p : contour) {
    sum += frame.distance.at<float>(nearest_to(p.y()), nearest_to(p.x()));
  }
  r.contour_sum = sum;
  r.contour_points = static_cast<std::int32_t>(contour.size());
}

class ScalarBackend final : public Backend {
 public:
  using Backend::Backend;
  std::string_view name() const override { return "scalar"; }

  void count(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
             std::span<const Kinematics> kinematics, Reduction terms, std::span<Reductions> counts) override {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      render(model.mesh, kinematics.empty() ? forward_kinematics(model.body, poses[i]) : kinematics[i],
             frame.camera, rendering_);
      if (wants(terms, Reduction::overlap)) {
        count_overlap(frame, rendering_, counts[i]);
      }
      if (wants(terms, Reduction::contour)) {
        occluding_contour(model.mesh, rendering_, contour_);
        sum_contour(frame, contour_, counts[i]);
      }
    }
  }

 private:
  Rendering rendering_;
  std::vector<Eigen::Vector2f> contour_;
};

}  // namespace

std::unique_ptr<Backend> make_scalar_backend(CueTable cues) {
  return std::make_unique<ScalarBackend>(std::move(cues));
}

}  // namespace telemime
