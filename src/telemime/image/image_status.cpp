// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/image_status.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/core/camera.h"
#include "telemime/image/log_colour.h"

namespace telemime {
namespace {

/// Whether the clothes have stripes or prints: two colours of different chroma with more than 10 % each.
bool patterned(const ColourMixture& clothes) {
  for (const ColourGaussian& a : clothes) {
    for (const ColourGaussian& b : clothes) {
      const float apart = (a.mean.head<2>() - b.mean.head<2>()).norm();
      if (a.weight > 0.1F && b.weight > 0.1F && apart > 0.3F) {
        return true;
      }
    }
  }
  return false;
}

constexpr double kBlack = 12.0;  // mean grey level
constexpr double kDark = 40.0;
constexpr double kOverexposed = 0.1;  // share of the head; skin and hair are never that white

}  // namespace

bool shows_something(const ImageStatus& status) {
  constexpr double kLeastDetail = 5.0;
  return status.brightness >= kBlack && status.detail >= kLeastDetail;
}

bool has_colour(const ImageStatus& status) {
  return is_coloured(status.coloured_share);
}

bool is_coloured(double share) {
  constexpr double kLeast = 0.002;
  return share >= kLeast;
}

double detail_of(const cv::Mat& grey) {
  constexpr double kWidth = 160.0;
  const double scale = kWidth / reference_width(grey.cols, grey.rows);
  const auto side = [scale](int pixels) {
    return std::max(3, static_cast<int>(std::lround(scale * pixels)));
  };
  cv::Mat small;
  cv::resize(grey, small, {side(grey.cols), side(grey.rows)}, 0, 0, cv::INTER_AREA);
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(small, dx, CV_32FC1, 1, 0, 3, 1.0 / 8.0);
  cv::Sobel(small, dy, CV_32FC1, 0, 1, 3, 1.0 / 8.0);
  cv::Mat gradient;
  cv::magnitude(dx, dy, gradient);
  std::vector<float> values(gradient.begin<float>(), gradient.end<float>());
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() * 99 / 100);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double coloured_share_of(const cv::Mat& bgr) {
  constexpr float kOwn = 0.12F;  // logarithm of a ratio of channels
  constexpr int kDarkest = 60;   // sum of the channels: below, noise has colours
  const int step = std::max(1, bgr.cols / 80);
  std::vector<float> u;
  std::vector<float> v;
  for (int r = 0; r < bgr.rows; r += step) {
    for (int c = 0; c < bgr.cols; c += step) {
      const auto& pixel = bgr.at<cv::Vec3b>(r, c);
      if (pixel[0] + pixel[1] + pixel[2] > kDarkest) {
        const Eigen::Vector3f colour = log_colour_of(pixel[0], pixel[1], pixel[2]);
        u.push_back(colour[0]);
        v.push_back(colour[1]);
      }
    }
  }
  if (u.empty()) {
    return 0.0;
  }
  std::vector<float> sorted_u = u;
  std::vector<float> sorted_v = v;
  const float usual_u = median(sorted_u);
  const float usual_v = median(sorted_v);
  std::size_t own = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    own += std::hypot(u[i] - usual_u, v[i] - usual_v) > kOwn ? 1 : 0;
  }
  return static_cast<double>(own) / static_cast<double>(u.size());
}

double white_share_of(const cv::Mat& bgr, const cv::Mat& mask) {
  constexpr int kWhite = 250;
  cv::Mat white;
  cv::inRange(bgr, cv::Scalar::all(kWhite), cv::Scalar::all(255), white);
  const int area = cv::countNonZero(mask);
  return area > 0 ? static_cast<double>(cv::countNonZero(white & mask)) / area : 0.0;
}

std::vector<std::string> warnings_of(const ImageStatus& status, const PersonColours& colours) {
  const auto percent = [](double share) { return std::to_string(std::lround(100 * share)) + " %"; };
  const std::string grey_level =
      "(mean grey level " + std::to_string(std::lround(status.brightness)) + " of 255)";
  std::vector<std::string> out;
  // The cause alone: who is not visible in a black picture is not missing.
  if (status.brightness < kBlack) {
    out.push_back("the image is black " + grey_level + ": is the lens covered?");
    return out;
  }
  if (!shows_something(status)) {
    out.emplace_back("the image shows no detail: is something in front of the lens, or is it out of focus?");
    return out;
  }
  if (status.brightness < kDark) {
    out.push_back("the image is dark " + grey_level + ": turn on a light");
  }
  if (status.person && status.white_share > kOverexposed) {
    out.push_back("the image is overexposed (" + percent(status.white_share) +
                  " of the head is white): turn the light or the exposure of the camera down");
  }
  if (!status.person) {
    out.emplace_back("no person is visible: sit so that the camera sees your head and your shoulders");
  }
  if (status.people > 1) {
    out.push_back(
        std::to_string(status.people) +
        " people are in the image: one of them is followed, at first the largest and most central; if "
        "that is the wrong one, the others should step out of the image");
  }
  if (status.person && !has_colour(status)) {
    out.emplace_back(
        "the image has no colour: the arms are followed by outlines and landmarks alone; a camera with "
        "colours, "
        "or more light if it has switched to infrared, gives better poses");
  }
  if (status.camera_motion > kBackgroundIsVoid) {
    out.emplace_back("the camera moves, so the background model cannot be used: fix the camera");
  } else if (status.camera_motion > kCameraIsUnsteady) {
    out.emplace_back("the camera moves slightly, so the background model is blurred: fix the camera");
  }
  if (status.person && std::abs(status.light_change) > 0.15) {
    out.push_back(
        "the light changed: the image is " + percent(std::exp(status.light_change)) +
        " as bright as when the background was learned; that is compensated, but steady light and a "
        "fixed exposure of the camera give better poses");
  }
  if (colours.known() && status.person && has_colour(status) && status.skin_share < 0.13) {
    out.push_back("little skin of the arms is visible (" + percent(status.skin_share) +
                  " of arms and clothes): long sleeves or hidden arms reduce the accuracy");
  }
  if (has_colour(status) && patterned(colours.clothes)) {
    out.emplace_back("the clothes have several colours: plain clothes are easier to distinguish from skin");
  }
  return out;
}

}  // namespace telemime
