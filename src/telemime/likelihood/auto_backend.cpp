// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/auto_backend.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

class AutoBackend final : public Backend {
 public:
  AutoBackend(std::unique_ptr<Backend> processor, std::unique_ptr<Backend> device,
              std::function<double()> seconds)
      : processor_(std::move(processor)), device_(std::move(device)), seconds_(std::move(seconds)) {}

  std::string_view name() const override { return "auto"; }
  std::optional<DeviceTimes> device_times() const override {
    return on_device_ ? device_->device_times() : std::nullopt;
  }

  void evaluate(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses, Reduction terms,
                std::span<Score> scores) override {
    on_device_ = false;
    const Kind kind{frame.camera.width, frame.camera.height, std::bit_width(poses.size()), terms};
    const auto known = device_is_faster_.find(kind);
    if (known == device_is_faster_.end()) {
      device_is_faster_[kind] = measure(frame, model, poses, terms, scores);
      return;
    }
    on_device_ = known->second;
    (on_device_ ? *device_ : *processor_).evaluate(frame, model, poses, terms, scores);
  }

 private:
  using Kind = std::tuple<int, int, int, Reduction>;

  // The second run of each counts: the first one takes memory and may compile.
  bool measure(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses, Reduction terms,
               std::span<Score> scores) {
    const auto seconds_of = [&](Backend& backend) {
      backend.evaluate(frame, model, poses, terms, scores);
      const double begin = seconds_();
      backend.evaluate(frame, model, poses, terms, scores);
      return seconds_() - begin;
    };
    double device = std::numeric_limits<double>::infinity();
    try {
      device = seconds_of(*device_);
    } catch (const Error&) {  // what the device cannot do, the processor does
    }
    return device < seconds_of(*processor_);
  }

  std::unique_ptr<Backend> processor_;
  std::unique_ptr<Backend> device_;
  std::function<double()> seconds_;
  std::map<Kind, bool> device_is_faster_;
  bool on_device_ = false;
};

}  // namespace

std::unique_ptr<Backend> make_auto_backend(std::unique_ptr<Backend> processor,
                                           std::unique_ptr<Backend> device, std::function<double()> seconds) {
  return std::make_unique<AutoBackend>(std::move(processor), std::move(device), std::move(seconds));
}

}  // namespace telemime
