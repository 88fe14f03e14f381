// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/changed_images.h"

#include <utility>

namespace telemime {
namespace {

class ChangedImages : public Source {
 public:
  ChangedImages(std::unique_ptr<Source> source, std::function<cv::Mat(const cv::Mat&)> change)
      : source_(std::move(source)), change_(std::move(change)) {}

  const SourceInfo& info() const override { return source_->info(); }
  std::string complaint() const override { return source_->complaint(); }
  void stop() override { source_->stop(); }
  void attend(std::function<void(const SourceNews&)> report) override { source_->attend(std::move(report)); }

  std::optional<Frame> next() override {
    std::optional<Frame> frame = source_->next();
    if (frame) {
      frame->image = change_(frame->image);
    }
    return frame;
  }

 private:
  std::unique_ptr<Source> source_;
  std::function<cv::Mat(const cv::Mat&)> change_;
};

}  // namespace

std::unique_ptr<Source> with_changed_images(std::unique_ptr<Source> source,
                                            std::function<cv::Mat(const cv::Mat&)> change) {
  return std::make_unique<ChangedImages>(std::move(source), std::move(change));
}

}  // namespace telemime
