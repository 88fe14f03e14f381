// SPDX-License-Identifier: Apache-2.0
// Faces and hands that are partly covered, in filmed and drawn pictures: nothing flutters.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "support/needs.h"
#include "telemime/capture/source.h"
#include "telemime/core/random.h"
#include "telemime/image/hand_finder.h"
#include "telemime/tracker/smoother.h"
#include "telemime/tracker/track_frame.h"

namespace telemime {
namespace {

constexpr std::size_t kSettled = 10;  // frames after which a face has been learned

// Clips of the test data.
constexpr const char* kWebcam = "real/webcam_hello/clip.mp4";
constexpr const char* kDeskTalk = "dev_practical/desk_talk/video.mp4";
constexpr const char* kJoy = "dev/joy/video.mp4";

class CoveredFace : public support::WithClips {};
class CoveredHands : public support::WithClips {};

std::vector<Frame> frames_of(const std::string& file, std::size_t first, std::size_t count) {
  const auto source = open_source((support::test_data() / file).string());
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < first + count; ++i) {
    auto frame = source->next();
    if (!frame) {
      break;
    }
    if (i >= first) {
      frames.push_back(*frame);
    }
  }
  return frames;
}

TrackingRun new_run(cv::Size size, double field_of_view, bool hands) {
  Config config;
  config.image.width = 160;
  config.image.height = 120;
  config.image.models = TELEMIME_BUILD_MODELS;
  config.filter.particles = 100;
  config.hands = hands;
  return make_tracking_run(config, camera_from_field_of_view(size.width, size.height, field_of_view));
}

// As a live run has it: steadied by what came before.
std::vector<MotionFrame> steadied(const std::vector<Frame>& frames, double field_of_view, bool hands) {
  TrackingRun run = new_run(frames.front().image.size(), field_of_view, hands);
  std::unique_ptr<Smoother> smoother;
  std::vector<MotionFrame> result;
  for (const Frame& frame : frames) {
    const MotionFrame motion = track_frame(frame, run).estimate.motion;
    if (!smoother) {
      smoother = make_smoother(run.tracker.config.smoothing, run.state.model.body, run.tracker.camera);
    }
    result.push_back((*smoother)(motion));
  }
  return result;
}

// A plain colour with the noise of a camera over the hull of the points.
void cover(const std::vector<cv::Point>& points, const cv::Scalar& colour, Random& random, cv::Mat& image) {
  std::vector<cv::Point> hull;
  cv::convexHull(points, hull);
  cv::Mat mask = cv::Mat::zeros(image.size(), CV_8UC1);
  cv::fillConvexPoly(mask, hull, 255);
  for (int r = 0; r < image.rows; ++r) {
    for (int c = 0; c < image.cols; ++c) {
      for (int k = 0; k < 3 && mask.at<unsigned char>(r, c) > 0; ++k) {
        image.at<cv::Vec3b>(r, c)[k] = cv::saturate_cast<unsigned char>(colour[k] + random.normal(0, 3));
      }
    }
  }
}

using Places = std::span<const std::size_t>;  // points of the face
constexpr std::size_t kMask[] = {6,   117, 346, 227, 447, 132, 58,  172, 136, 150, 149,
                                 176, 148, 152, 377, 400, 378, 379, 365, 397, 288, 361};
constexpr std::size_t kLeftHalf[] = {10,  151, 9,   8,   168, 6,   197, 4,   0,   17,  200, 152,
                                     377, 378, 365, 288, 361, 323, 454, 389, 251, 284, 332, 338};
constexpr std::size_t kRightGlass[] = {70, 63,  105, 66, 107, 55,  193, 188, 114,
                                       47, 100, 101, 50, 123, 116, 143, 156};
constexpr std::size_t kLeftGlass[] = {300, 293, 334, 296, 336, 285, 417, 412, 343,
                                      277, 329, 330, 280, 352, 345, 372, 383};

struct Covered {
  std::vector<Places> places;
  cv::Scalar colour;
};

// A filmed man at a webcam, and his face in each frame.
struct Webcam {
  std::vector<Frame> frames;
  std::vector<FaceLandmarks> faces;
};
const Webcam& webcam() {
  static const Webcam seen = [] {
    Webcam w{.frames = frames_of(kWebcam, 0, 60), .faces = {}};
    TrackingRun run = new_run(w.frames.front().image.size(), 60.0, false);
    for (const Frame& frame : w.frames) {
      const auto found = extract(frame, ColourRequest::keep, run.scene).face;
      w.faces.push_back(found ? *found : w.faces.empty() ? FaceLandmarks{} : w.faces.back());
    }
    return w;
  }();
  return seen;
}

// The same with parts of the face painted over.
std::vector<Frame> webcam_with(const Covered& covered) {
  const Webcam& seen = webcam();
  std::vector<Frame> frames = seen.frames;
  Random random(7);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    frames[f].image = frames[f].image.clone();
    for (const Places& places : covered.places) {
      std::vector<cv::Point> points;
      for (const std::size_t i : places) {
        const Eigen::Vector2d& pixel = seen.faces[f].points[i].pixel;
        points.emplace_back(cvRound(pixel.x()), cvRound(pixel.y()));
      }
      cover(points, covered.colour, random, frames[f].image);
    }
  }
  return frames;
}

// Standard deviation of a coefficient.
double deviation(const std::vector<MotionFrame>& frames, std::size_t expression) {
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t i = kSettled; i < frames.size(); ++i) {
    if (frames[i].face) {
      const double value = frames[i].face->expressions[expression];
      sum += value;
      squares += value * value;
      count += 1.0;
    }
  }
  EXPECT_GT(count, 0.8 * static_cast<double>(frames.size() - kSettled)) << "the face is seen";
  return std::sqrt(std::max(0.0, squares / count - (sum / count) * (sum / count)));
}

// The largest turn of the head between two frames, degrees.
double largest_turn(const std::vector<MotionFrame>& frames) {
  double largest = 0.0;
  for (std::size_t i = kSettled; i < frames.size(); ++i) {
    if (frames[i].face && frames[i - 1].face) {
      largest = std::max(largest, frames[i].face->head.angularDistance(frames[i - 1].face->head));
    }
  }
  return largest * 180.0 / std::numbers::pi;
}

// The largest change of a finger's angle between two frames from this one on, degrees.
double largest_change(const std::vector<MotionFrame>& frames, std::size_t from) {
  double largest = 0.0;
  for (std::size_t i = from; i < frames.size(); ++i) {
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t a = 0; a < kHandAngleCount; ++a) {
        const auto angle = [&](std::size_t frame) { return frames[frame].hands.value()[side].angles[a]; };
        largest = std::max(largest, std::abs(angle(i) - angle(i - 1)));
      }
    }
  }
  return largest * 180.0 / std::numbers::pi;
}

// The same picture again and again, each time with the noise of a camera.
std::vector<Frame> still(const cv::Mat& picture, std::size_t count) {
  Random random(7);
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < count; ++i) {
    Frame frame{picture.clone(), static_cast<std::int64_t>(i), 0.04 * static_cast<double>(i)};
    for (int r = 0; r < picture.rows; ++r) {
      for (int c = 0; c < picture.cols; ++c) {
        for (unsigned char& value : frame.image.at<cv::Vec3b>(r, c).val) {
          value = cv::saturate_cast<unsigned char>(value + random.normal(0, 2));
        }
      }
    }
    frames.push_back(frame);
  }
  return frames;
}

bool is_of_mouth(std::size_t expression) {
  const std::string_view name = kExpressionNames[expression];
  return name.starts_with("mouth") || name.starts_with("jaw");
}

bool is_of_eyes(std::size_t expression) {
  return kExpressionNames[expression].starts_with("eye");
}

TEST_F(CoveredFace, MouthUnderAMaskIsStill) {
  const auto motion = steadied(webcam_with({{kMask}, {150, 120, 90}}), 60.0, false);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    if (is_of_mouth(i)) {
      EXPECT_LE(deviation(motion, i), 0.05) << kExpressionNames[i];
    }
  }
  EXPECT_LE(largest_turn(motion), 5.0);
}

TEST_F(CoveredFace, HalfAFaceDoesNotFlutter) {
  const auto motion = steadied(webcam_with({{kLeftHalf}, {60, 60, 60}}), 60.0, false);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    if (!is_of_eyes(i)) {
      EXPECT_LE(deviation(motion, i), 0.05) << kExpressionNames[i];
    }
  }
  EXPECT_LE(largest_turn(motion), 5.0);
}

TEST_F(CoveredFace, SunglassesLeaveTheHeadSteady) {
  const auto motion = steadied(webcam_with({{kRightGlass, kLeftGlass}, {15, 15, 15}}), 60.0, false);
  EXPECT_LE(largest_turn(motion), 5.0);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    if (is_of_mouth(i)) {
      EXPECT_LE(deviation(motion, i), 0.05) << kExpressionNames[i];
    }
  }
}

TEST_F(CoveredFace, FilmedMaskDoesNotSmile) {
  const auto motion = steadied(frames_of("real/seated_stereo/clip.mp4", 35, 60), 43.6, false);
  EXPECT_LE(deviation(motion, static_cast<std::size_t>(Expression::mouth_smile_left)), 0.05);
  EXPECT_LE(deviation(motion, static_cast<std::size_t>(Expression::mouth_smile_right)), 0.05);
}

TEST_F(CoveredHands, FingersOfStillGlovesAreStill) {
  // Skin about the hands becomes dark.
  cv::Mat picture = frames_of(kDeskTalk, 150, 1).at(0).image.clone();
  TrackingRun run = new_run(picture.size(), 60.0, true);
  const FrameFeatures features = extract({picture, 0, 0.0}, ColourRequest::keep, run.scene);
  for (const SeenHand& hand : features.hands.value()) {
    ASSERT_TRUE(hand.found);
    const HandLandmarks seen = scaled_to(*hand.found, run.scene.features.working_size(), picture.size());
    const double reach = 1.6 * (seen.points[9].pixel - seen.points[0].pixel).norm();
    for (int r = 0; r < picture.rows; ++r) {
      for (int c = 0; c < picture.cols; ++c) {
        cv::Vec3b& pixel = picture.at<cv::Vec3b>(r, c);
        const bool skin = pixel[2] > 60 && pixel[2] - pixel[1] > 18;
        if (skin && (Eigen::Vector2d(c, r) - seen.points[9].pixel).norm() < reach) {
          pixel = pixel * 0.22 + cv::Vec3b(12, 12, 12);
        }
      }
    }
  }
  const auto motion = steadied(still(picture, 60), 60.0, true);
  EXPECT_LE(largest_change(motion, kSettled), 5.0);
}

TEST_F(CoveredHands, HiddenHandsGoToRestGently) {
  // Both hands are seen; then a board is before them.
  const cv::Mat picture = frames_of(kDeskTalk, 250, 1).at(0).image;
  std::vector<Frame> frames = still(picture, 50);
  TrackingRun run = new_run(picture.size(), 60.0, true);
  const FrameFeatures features = extract(frames.front(), ColourRequest::keep, run.scene);
  constexpr std::size_t kHidden = 25;
  std::size_t covered = 0;
  for (const SeenHand& hand : features.hands.value()) {
    if (!hand.found) {
      continue;
    }
    ++covered;
    const HandLandmarks seen = scaled_to(*hand.found, run.scene.features.working_size(), picture.size());
    const double reach = 1.6 * (seen.points[9].pixel - seen.points[0].pixel).norm();
    for (std::size_t i = kHidden; i < frames.size(); ++i) {
      cv::circle(frames[i].image, {cvRound(seen.points[9].pixel.x()), cvRound(seen.points[9].pixel.y())},
                 cvRound(reach), {90, 110, 120}, cv::FILLED);
    }
  }
  ASSERT_GT(covered, 0U);
  const auto motion = steadied(frames, 60.0, true);
  EXPECT_LE(largest_change(motion, kSettled), 5.0);
  for (const HandMotion& hand : motion.back().hands.value()) {
    EXPECT_LT(hand.visibility, 0.1);
  }
}

TEST_F(CoveredHands, FingersOfStillClaspedHandsAreStill) {
  const auto frames = still(frames_of(kDeskTalk, 262, 1).at(0).image, 60);
  EXPECT_LE(largest_change(steadied(frames, 60.0, true), kSettled), 5.0);
}

TEST_F(CoveredHands, HandsBehindTheHeadAreAtRest) {
  // Both hands go to the face; the head of the first frame is before them.
  const cv::Mat first = frames_of(kJoy, 0, 1).at(0).image;
  std::vector<Frame> frames = frames_of(kJoy, 100, 40);
  cv::Mat head = cv::Mat::zeros(first.size(), CV_8UC1);
  cv::ellipse(head, {317, 182}, {52, 66}, 0, 0, 360, 255, cv::FILLED);
  for (Frame& frame : frames) {
    frame.image = frame.image.clone();
    first.copyTo(frame.image, head);
  }
  const auto motion = steadied(frames, 60.0, true);
  EXPECT_LE(largest_change(motion, 1), 15.0);
  EXPECT_LE(largest_change(motion, 34), 5.0) << "at rest";
}

TEST_F(CoveredHands, HandOutsideThePictureIsAtRest) {
  // Of gesturing hands the picture has only the right one; then the left one comes in, too.
  std::vector<Frame> frames = frames_of(kDeskTalk, 158, 36);
  for (Frame& frame : frames) {
    frame.image = frame.image(cv::Rect(0, 0, 460, frame.image.rows)).clone();
  }
  const auto motion = steadied(frames, 45.1, true);
  for (std::size_t t = 1; t < 14; ++t) {
    EXPECT_LE(motion[t].hands.value()[0].visibility, 0.1) << t;
  }
}

TEST_F(CoveredHands, HandOfSomebodyElseIsNotTaken) {
  // Another hand is at the edge while the man's own are below the picture.
  const cv::Mat other = frames_of(kDeskTalk, 45, 1).at(0).image(cv::Rect(500, 290, 100, 135)).clone();
  std::vector<Frame> frames = frames_of(kDeskTalk, 220, 18);
  for (Frame& frame : frames) {
    frame.image = frame.image.clone();
    other.copyTo(frame.image(cv::Rect(540, 180, other.cols, other.rows)));
  }
  for (const MotionFrame& frame : steadied(frames, 60.0, true)) {
    for (const HandMotion& mine : frame.hands.value()) {
      EXPECT_LE(mine.visibility, 0.1) << frame.frame;
    }
  }
}

}  // namespace
}  // namespace telemime
