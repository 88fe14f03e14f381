// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include "telemime/capture/source.h"

namespace telemime::support {

/// Frames that are in memory already, as an input.
class ListSource final : public Source {
 public:
  explicit ListSource(std::vector<Frame> frames) : frames_(std::move(frames)) {
    info_.name = "list";
    info_.width = frames_.front().image.cols;
    info_.height = frames_.front().image.rows;
    info_.frames = static_cast<std::int64_t>(frames_.size());
  }

  const SourceInfo& info() const override { return info_; }
  std::optional<Frame> next() override {
    return at_ < frames_.size() ? std::optional(frames_[at_++]) : std::nullopt;
  }
  std::string complaint() const override { return {}; }

 private:
  std::vector<Frame> frames_;
  std::size_t at_ = 0;
  SourceInfo info_;
};

}  // namespace telemime::support
