// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/head_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "telemime/image/feature_config.h"

namespace telemime {
namespace {

bool any_face(const cv::Rect&) {
  return true;
}

// The face of the bundled clip's first frame, and the square that the detector finds on it.
class HeadTrackerTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto clip = std::filesystem::path(TELEMIME_SOURCE_DIR) / "data" / "demo" / "video.mp4";
    cv::Mat image;
    ASSERT_TRUE(cv::VideoCapture(clip.string()).read(image)) << clip;
    cv::cvtColor(image, grey_, cv::COLOR_BGR2GRAY);
    HeadTracker fresh = tracker();
    const auto found = fresh.detect(grey_, whole(), any_face);
    ASSERT_TRUE(found.has_value());
    face_ = *found;
  }

  static HeadTracker tracker() { return {HeadTrackerConfig{}, ImageConfig{}.cascades}; }
  cv::Rect whole() const { return {0, 0, grey_.cols, grey_.rows}; }

  // A tracker gets a square that is a fifth wider than the face, `right` of it.
  double wider() const { return 1.2 * face_.side; }
  void adopt_wider(HeadTracker& heads, const cv::Mat& image, double match, double right = 0.0) const {
    const double half = 0.5 * (wider() - 1);
    heads.adopt(image, {face_.centre.x + right - half, face_.centre.y - half, wider(), wider()}, match);
  }

  cv::Mat grey_;
  TrackedFace face_;
};

TEST_F(HeadTrackerTest, ReportsReplacedOutlineSquare) {
  HeadTracker heads = tracker();
  adopt_wider(heads, grey_, 1.0, 3.0);
  int replaced = 0;
  for (int i = 0; i < 12; ++i) {
    const auto face = heads.update(grey_, whole(), any_face);
    ASSERT_TRUE(face.has_value());
    if (heads.replaced()) {
      ++replaced;
      EXPECT_TRUE(face->detected);
      EXPECT_NEAR(heads.replaced()->side, wider(), 1e-9);
      EXPECT_NEAR(heads.replaced()->centre.x, face_.centre.x + 3, 1.0);
      EXPECT_LT(face->side, wider());
    }
  }
  EXPECT_EQ(replaced, 1) << "once: then the detector gives the square";
}

TEST_F(HeadTrackerTest, FirstDetectionIsNotSmoothed) {
  HeadTracker heads = tracker();
  adopt_wider(heads, grey_, 1.0);
  for (int i = 0; i < 12 && !heads.replaced(); ++i) {
    ASSERT_TRUE(heads.update(grey_, whole(), any_face).has_value());
  }
  ASSERT_TRUE(heads.replaced().has_value());
  EXPECT_NEAR(heads.current()->side, face_.side, 0.1 * face_.side);
}

TEST_F(HeadTrackerTest, LostSquareKeepsOnlyItsSize) {
  HeadTracker heads = tracker();
  adopt_wider(heads, grey_, 1.0);
  // The face is absent in one image and then visible again, slightly shifted.
  ASSERT_TRUE(heads.update(cv::Mat(grey_.size(), CV_8UC1, cv::Scalar(90)), whole(), any_face).has_value());
  EXPECT_FALSE(heads.replaced().has_value());
  cv::Mat negative;
  cv::bitwise_not(grey_, negative);
  adopt_wider(heads, negative, 0.0);
  const auto face = heads.update(grey_, whole(), any_face);
  ASSERT_TRUE(face && face->detected && heads.replaced());
  ASSERT_LT(heads.replaced()->match, HeadTrackerConfig{}.lost_match);
  EXPECT_EQ(heads.replaced()->centre, face->centre);
  EXPECT_NEAR(heads.replaced()->side, wider(), 1e-9);
}

// At any rate, the face is detected at the same times.
TEST_F(HeadTrackerTest, IntervalsAreTimes) {
  for (const double rate : {12.5, 25.0, 100.0}) {
    HeadTracker heads = tracker();
    ASSERT_TRUE(heads.detect(grey_, whole(), any_face).has_value());
    int detections = 0;
    for (int i = 0; i < static_cast<int>(rate); ++i) {
      const auto face = heads.update(grey_, whole(), any_face, 25.0 / rate);
      detections += face && face->detected ? 1 : 0;
    }
    EXPECT_NEAR(detections, 5, rate < 25.0 ? 1 : 0) << rate;
  }
}

TEST_F(HeadTrackerTest, DetectedFaceReplacesNothing) {
  HeadTracker heads = tracker();
  ASSERT_TRUE(heads.detect(grey_, whole(), any_face).has_value());
  EXPECT_FALSE(heads.replaced().has_value());
  for (int i = 0; i < 12; ++i) {
    ASSERT_TRUE(heads.update(grey_, whole(), any_face).has_value());
    EXPECT_FALSE(heads.replaced().has_value());
  }
}

// A network finds the face in every image. Its place does not trail behind the face, nor tremble with the
// network's; its size is smoothed over time.
TEST_F(HeadTrackerTest, FaceOfANetworkIsFollowedWithoutLag) {
  const double side = face_.side;
  const auto moved = [&](double right) {
    cv::Mat image;
    cv::warpAffine(grey_, image, cv::Matx23d(1, 0, right, 0, 1, 0), grey_.size(), cv::INTER_LINEAR,
                   cv::BORDER_REPLICATE);
    return image;
  };
  for (const double rate : {5.0, 25.0, 50.0}) {
    HeadTracker heads = tracker();
    const auto found_at = [&](const cv::Mat& image, double x, double size) {
      const double half = 0.5 * (size - 1);
      return heads.take_over(image, {x - half, face_.centre.y - half, size, size}, 25.0 / rate).value();
    };
    found_at(grey_, face_.centre.x, side);
    const int frames = static_cast<int>(rate);
    for (int i = 1; i <= frames; ++i) {
      const double right = side * i / rate;
      EXPECT_NEAR(found_at(moved(right), face_.centre.x + right, side).centre.x, face_.centre.x + right,
                  0.05 * side)
          << rate << ": " << i;
    }
    // The network trembles, the face does not move.
    const cv::Mat still = moved(side);
    for (int i = 0; i < 10; ++i) {
      const double shift = i % 2 == 0 ? 2.0 : -2.0;
      const double x = found_at(still, face_.centre.x + side + shift, side).centre.x;
      EXPECT_LE(std::abs(x - face_.centre.x - side), rate < 25.0 ? 2.01 : 1.5) << rate << ": " << i;
    }
    double after = side;
    for (int i = 0; i < static_cast<int>(0.2 * rate + 0.5); ++i) {
      after = found_at(still, face_.centre.x + side, 1.2 * side).side;
    }
    EXPECT_NEAR((after - side) / (0.2 * side), 1.0 - std::pow(0.75, 5.0), 1e-6) << rate;
    // Another face has its own place and size from the start.
    const TrackedFace other = found_at(still, face_.centre.x - 2.0 * side, 0.6 * side);
    EXPECT_NEAR(other.side, 0.6 * side, 1e-9);
    EXPECT_NEAR(other.centre.x, face_.centre.x - 2.0 * side, 1e-9);
  }
}

}  // namespace
}  // namespace telemime
