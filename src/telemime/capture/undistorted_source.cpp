// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/undistorted_source.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

class UndistortedSource : public Source {
 public:
  UndistortedSource(std::unique_ptr<Source> source, const Lens& lens) : source_(std::move(source)) {
    const Camera& camera = lens.camera;
    cv::Mat_<cv::Vec2f> from(camera.height, camera.width);
    std::int64_t inside = 0;
    for (int v = 0; v < from.rows; ++v) {
      for (int u = 0; u < from.cols; ++u) {
        const Eigen::Vector2d seen = lens.distorted(camera.ray(Eigen::Vector2d(u, v)).head<2>());
        const Eigen::Vector2d pixel = camera.project({seen.x(), seen.y(), 1.0});
        from(v, u) = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
        inside +=
            pixel.x() >= 0.0 && pixel.y() >= 0.0 && pixel.x() < from.cols && pixel.y() < from.rows ? 1 : 0;
      }
    }
    if (4 * inside < static_cast<std::int64_t>(from.total())) {
      throw Error(ErrorKind::config, "the lens of the camera file leaves less than a quarter of the picture",
                  "Calibrate again, or use --fov DEGREES.");
    }
    cv::convertMaps(from, {}, where_, fraction_, CV_16SC2);
  }

  const SourceInfo& info() const override { return source_->info(); }
  std::string complaint() const override { return source_->complaint(); }
  void stop() override { source_->stop(); }
  void attend(std::function<void(const SourceNews&)> report) override { source_->attend(std::move(report)); }

  std::optional<Frame> next() override {
    std::optional<Frame> frame = source_->next();
    if (frame) {
      cv::Mat straight;
      cv::remap(frame->image, straight, where_, fraction_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
      frame->image = straight;
    }
    return frame;
  }

 private:
  std::unique_ptr<Source> source_;
  cv::Mat where_, fraction_;  // of each pixel in the source's picture
};

}  // namespace

std::unique_ptr<Source> undistorted(std::unique_ptr<Source> source, const Lens& lens) {
  return lens.distorts() ? std::make_unique<UndistortedSource>(std::move(source), lens) : std::move(source);
}

}  // namespace telemime
