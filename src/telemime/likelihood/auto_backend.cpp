// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/all.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

// Whether two back ends counted the same except for rounding, which changes one or two pixels in a hundred at
// most. A driver that compiles the kernel wrongly is far off.
bool agree(std::span<const Reductions> counts, std::span<const Reductions> others) {
  constexpr double kRounding = 0.02;
  constexpr double kFew = 3.0;  // of each pose, for poses of which next to nothing is seen
  double sum = kFew / kRounding * static_cast<double>(counts.size());
  double difference = 0.0;
  const auto compare = [&](double a, double b) {
    sum += a;
    difference += std::abs(a - b);
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
      compare(counts[i].model[c], others[i].model[c]);
      compare(counts[i].both[c], others[i].both[c]);
    }
    compare(counts[i].contour_points, others[i].contour_points);
    compare(counts[i].contour_sum, others[i].contour_sum);
  }
  return difference <= kRounding * sum;  // false where a number is not finite
}

class AutoBackend final : public Backend {
 public:
  AutoBackend(std::unique_ptr<Backend> processor, std::unique_ptr<Backend> device,
              std::function<double()> seconds)
      : Backend(processor->cues()),
        processor_(std::move(processor)),
        device_(std::move(device)),
        seconds_(std::move(seconds)) {}

  std::string_view name() const override { return "auto"; }
  std::optional<DeviceTimes> device_times() const override {
    return on_device_ ? device_->device_times() : std::nullopt;
  }

  void count(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
             std::span<const Kinematics> kinematics, Reduction terms, std::span<Reductions> counts) override {
    on_device_ = false;
    const Kind kind{frame.camera.width, frame.camera.height, std::bit_width(poses.size()), terms};
    const auto known = prefers_device_.find(kind);
    if (known == prefers_device_.end()) {
      prefers_device_[kind] = measure(frame, model, poses, kinematics, terms, counts);
      return;
    }
    if (known->second) {
      try {
        device_->count(frame, model, poses, kinematics, terms, counts);
        on_device_ = true;
        return;
      } catch (const Error&) {  // unplugged, or reset by its driver
        known->second = false;
        std::fill(counts.begin(), counts.end(), Reductions{});
      }
    }
    processor_->count(frame, model, poses, kinematics, terms, counts);
  }

 private:
  using Kind = std::tuple<int, int, int, Reduction>;

  // Whether the device is to evaluate such batches: it is faster and agrees with the processor. Its counts
  // are kept if so, so that all batches of a kind have those of one back end. The second run of each is
  // measured: the first one allocates memory and may compile the kernel.
  bool measure(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
               std::span<const Kinematics> kinematics, Reduction terms, std::span<Reductions> counts) {
    const auto seconds_of = [&](Backend& backend, std::span<Reductions> out) {
      backend.count(frame, model, poses, kinematics, terms, out);
      std::fill(out.begin(), out.end(), Reductions{});
      const double begin = seconds_();
      backend.count(frame, model, poses, kinematics, terms, out);
      return seconds_() - begin;
    };
    const double processor = seconds_of(*processor_, counts);
    std::vector<Reductions> others(counts.size());
    try {
      const double device = seconds_of(*device_, others);
      const bool better = agree(counts, others) && device < processor;
      if (better) {
        std::copy(others.begin(), others.end(), counts.begin());
      }
      on_device_ = better;
      return better;
    } catch (const Error&) {  // the processor evaluates what the device cannot
      return false;
    }
  }

  std::unique_ptr<Backend> processor_;
  std::unique_ptr<Backend> device_;
  std::function<double()> seconds_;
  std::map<Kind, bool> prefers_device_;
  bool on_device_ = false;
};

}  // namespace

std::unique_ptr<Backend> make_auto_backend(std::unique_ptr<Backend> processor,
                                           std::unique_ptr<Backend> device, std::function<double()> seconds) {
  return std::make_unique<AutoBackend>(std::move(processor), std::move(device), std::move(seconds));
}

}  // namespace telemime
