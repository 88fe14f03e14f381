// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/all.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <map>
#include <tuple>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

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

  void count(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses, Reduction terms,
             std::span<Reductions> counts) override {
    on_device_ = false;
    const Kind kind{frame.camera.width, frame.camera.height, std::bit_width(poses.size()), terms};
    const auto known = device_is_faster_.find(kind);
    if (known == device_is_faster_.end()) {
      device_is_faster_[kind] = measure(frame, model, poses, terms, counts);
      return;
    }
    on_device_ = known->second;
    (on_device_ ? *device_ : *processor_).count(frame, model, poses, terms, counts);
  }

 private:
  using Kind = std::tuple<int, int, int, Reduction>;

  // The second run of each is measured: the first one allocates memory and may compile the kernel.
  bool measure(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses, Reduction terms,
               std::span<Reductions> counts) {
    const auto seconds_of = [&](Backend& backend) {
      backend.count(frame, model, poses, terms, counts);
      std::fill(counts.begin(), counts.end(), Reductions{});
      const double begin = seconds_();
      backend.count(frame, model, poses, terms, counts);
      return seconds_() - begin;
    };
    double device = std::numeric_limits<double>::infinity();
    try {
      device = seconds_of(*device_);
    } catch (const Error&) {  // the processor evaluates what the device cannot
    }
    std::fill(counts.begin(), counts.end(), Reductions{});
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
