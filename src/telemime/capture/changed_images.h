// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <utility>

#include "telemime/capture/source.h"

namespace telemime {

/// The source with `change` of each image (CV_8UC3) in place of it; everything else is passed on. The image
/// keeps its size. `change` is called from the thread that calls next().
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

}  // namespace telemime
