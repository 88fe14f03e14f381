// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/loop.h"

#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

class LoopedSource : public Source {
 public:
  explicit LoopedSource(std::function<std::unique_ptr<Source>()> open)
      : open_(std::move(open)), file_(open_()), info_(file_->info()) {
    info_.frames = 0;
  }

  const SourceInfo& info() const override { return info_; }
  std::string complaint() const override { return complaint_.empty() ? file_->complaint() : complaint_; }

  std::optional<Frame> next() override {
    std::optional<Frame> frame = file_->next();
    if (!frame && count_ > 0) {
      frame = again();
    }
    if (frame) {
      frame->time += passed_;
      last_ = frame->time;
      frame->index = count_++;
    }
    return frame;
  }

 private:
  std::optional<Frame> again() {
    try {
      file_ = open_();
    } catch (const Error& e) {
      complaint_ = e.what();
      return std::nullopt;
    }
    passed_ = last_ + 1.0 / info_.fps;
    return file_->next();
  }

  std::function<std::unique_ptr<Source>()> open_;
  std::unique_ptr<Source> file_;
  SourceInfo info_;
  std::string complaint_;
  double passed_ = 0.0;  // s, at the first frame of this repetition
  double last_ = 0.0;
  std::int64_t count_ = 0;
};

}  // namespace

std::unique_ptr<Source> loop(std::function<std::unique_ptr<Source>()> open) {
  return std::make_unique<LoopedSource>(std::move(open));
}

}  // namespace telemime
