// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/person_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace telemime {
namespace {

// Bounds of the places, in half widths and half heights of the head from its centre. They follow from human
// proportions: a head is about 1/7.5 of the height, shoulders are about three heads wide.
constexpr double kFaceWidth = 0.6;    // squared: the ellipse of the face without hair
constexpr double kFaceHeight = 0.7;   // squared
constexpr double kChestAside = 1.3;   // the middle of the chest
constexpr double kChestTop = 1.9;     // below the collar
constexpr double kThroatAside = 0.6;  // the neck, from the middle of the face down
constexpr double kHeadRound = 1.25;   // squared radius of the head with hair
constexpr double kTorsoAside = 2.6;   // shoulders
constexpr double kTorsoTop = 1.6;
constexpr double kTorsoBottom = 7.0;  // hips
constexpr double kArmUp = 3.5;        // an arm above the head
constexpr double kArmAside = 9.0;     // an arm to the side
constexpr double kCutWidth = 160.0;   // px: a graph cut takes as long as it has pixels
constexpr int kHalfCut = 127;         // of 255

/// Position relative to the body: core is the head and the middle of the chest, likely are the shoulders and
/// the rest of the torso, open is where arms can be, far is out of reach.
enum class Place : std::size_t { core, likely, open, far };

// By place: where the graph cut starts, and the prior (1: surely the person, -1: surely not).
constexpr std::array<unsigned char, 4> kCut{cv::GC_FGD, cv::GC_PR_FGD, cv::GC_PR_BGD, cv::GC_BGD};
constexpr std::array<float, 4> kPrior{1.0F, 0.4F, -0.2F, -1.0F};

/// The place of a point given in half widths (x) and half heights (y) of the head from its centre.
Place place_of(double x, double y) {
  const double aside = std::abs(x);
  if (x * x / kFaceWidth + y * y / kFaceHeight < 1 || (aside < kChestAside && y > kChestTop) ||
      (aside < kThroatAside && y > 0)) {
    return Place::core;
  }
  if (x * x + y * y < kHeadRound || (y > kTorsoTop && aside < kTorsoAside && y < kTorsoBottom)) {
    return Place::likely;
  }
  if (y < -kArmUp || aside > kArmAside) {
    return Place::far;
  }
  return Place::open;
}

/// Sets OpenCV's random generator of the calling thread, which grabCut uses, to a fixed state; restores it at
/// the end of the scope.
class FixedSeed {
 public:
  FixedSeed() : state_(cv::theRNG().state) { cv::theRNG().state = 1; }
  ~FixedSeed() { cv::theRNG().state = state_; }
  FixedSeed(const FixedSeed&) = delete;
  FixedSeed& operator=(const FixedSeed&) = delete;

 private:
  std::uint64_t state_;
};

}  // namespace

cv::Mat cut_person(const cv::Mat& bgr, const HeadRegion& head) {
  const double scale = std::min(1.0, kCutWidth / bgr.cols);
  cv::Mat small;
  cv::resize(bgr, small, cv::Size(), scale, scale, cv::INTER_AREA);
  // Initial mask from the position of the head.
  cv::Mat mask(small.size(), CV_8UC1);
  for (int r = 0; r < mask.rows; ++r) {
    for (int c = 0; c < mask.cols; ++c) {
      const double x = ((c + 0.5) / scale - 0.5 - head.centre.x()) / head.radii.x();
      const double y = ((r + 0.5) / scale - 0.5 - head.centre.y()) / head.radii.y();
      mask.at<unsigned char>(r, c) = kCut[static_cast<std::size_t>(place_of(x, y))];
    }
  }
  // Graph cut, and the result at the size of the image.
  const FixedSeed seed;
  cv::Mat background_colours;
  cv::Mat person_colours;
  constexpr int kRounds = 4;
  cv::grabCut(small, mask, cv::Rect(), background_colours, person_colours, kRounds, cv::GC_INIT_WITH_MASK);
  cv::Mat person = (mask & 1) * 255;
  cv::resize(person, person, bgr.size(), 0, 0, cv::INTER_LINEAR);
  return person > kHalfCut;
}

cv::Mat body_prior(const cv::Size& size, const HeadRegion& head) {
  cv::Mat prior(size, CV_32FC1);
  for (int r = 0; r < size.height; ++r) {
    auto* p = prior.ptr<float>(r);
    const double y = (r - head.centre.y()) / head.radii.y();
    for (int c = 0; c < size.width; ++c) {
      const Place place = place_of((c - head.centre.x()) / head.radii.x(), y);
      p[c] = kPrior[static_cast<std::size_t>(place)];
    }
  }
  return prior;
}

cv::Mat person_area(const cv::Mat& mask, int margin) {
  constexpr double kPerhaps = 50;  // of 255
  cv::Mat area;
  cv::dilate(mask > kPerhaps, area,
             cv::getStructuringElement(cv::MORPH_ELLIPSE, cv::Size(2 * margin + 1, 2 * margin + 1)));
  return area;
}

}  // namespace telemime
