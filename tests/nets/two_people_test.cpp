// SPDX-License-Identifier: Apache-2.0
// The person finder in pictures of two people, made of frames of the demo clip.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "support/needs.h"
#include "support/pictures.h"
#include "telemime/capture/source.h"
#include "telemime/image/face_finder.h"
#include "telemime/image/features.h"
#include "telemime/image/person_finder.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

const fs::path kModels = TELEMIME_BUILD_MODELS;
constexpr int kColumns = 520;
constexpr int kRows = 240;
constexpr double kFrame = 0.04;  // s

class TwoPeople : public support::WithNetworks {
 protected:
  void SetUp() override {
    WithNetworks::SetUp();
    if (IsSkipped()) {
      return;
    }
    const std::unique_ptr<Source> source = open_source(TELEMIME_SOURCE_DIR "/data/demo/video.mp4");
    for (std::optional<Frame> frame = source->next(); frame && frames_.size() < 12; frame = source->next()) {
      frames_.push_back(frame->image.clone());
    }
    finder_ = PersonFinder(kModels);
  }

  // The near person on the left, somebody farther away on the right; either may be absent.
  cv::Mat picture(std::size_t frame, bool near, bool far) const {
    cv::Mat out(kRows, kColumns, CV_8UC3, cv::Scalar(180, 170, 170));
    if (near) {
      frames_[frame].copyTo(out(cv::Rect(0, 0, 320, 240)));
    }
    if (far) {
      cv::Mat small;
      cv::resize(frames_[frame], small, {200, 150}, 0, 0, cv::INTER_AREA);
      small.copyTo(out(cv::Rect(320, 60, 200, 150)));
    }
    return out;
  }

  // The room of the near person, empty, beside a grey wall.
  static cv::Mat empty_picture() {
    cv::Mat out(kRows, kColumns, CV_8UC3, cv::Scalar(180, 170, 170));
    open_source(TELEMIME_SOURCE_DIR "/data/demo/background.mp4")
        ->next()
        ->image.copyTo(out(cv::Rect(0, 0, 320, 240)));
    return out;
  }

  static FeatureExtractor extractor() {
    ImageConfig config;
    config.width = kColumns;
    config.height = kRows;
    config.models = kModels.string();
    return FeatureExtractor(config);
  }

  static bool on_the_left(const std::optional<PoseLandmarks>& person) {
    return person && place_of(*person).shoulders.x() < 320;
  }

  std::vector<cv::Mat> frames_;
  PersonFinder finder_;
};

TEST_F(TwoPeople, LargeOneIsFoundFirst) {
  EXPECT_TRUE(on_the_left(finder_.find(picture(0, true, true), 0.0)));
  EXPECT_EQ(finder_.people(), 2);
  finder_.reset();
  EXPECT_TRUE(on_the_left(finder_.find(picture(1, true, false), 2.0)));
  EXPECT_EQ(finder_.people(), 1);
}

TEST_F(TwoPeople, FollowedOneIsNotExchanged) {
  double time = 0.0;
  for (std::size_t i = 0; i < 4; ++i, time += kFrame) {
    ASSERT_TRUE(on_the_left(finder_.find(picture(i, true, i > 0), time))) << i;
  }
  // Gone: that is a loss, not a motion.
  for (std::size_t i = 4; i < 6; ++i, time += kFrame) {
    EXPECT_FALSE(finder_.find(picture(i, false, true), time)) << i;
  }
  // Back.
  EXPECT_TRUE(on_the_left(finder_.find(picture(6, true, true), time)));
  // Gone for good: the other one may be followed.
  time += 2.0;
  const auto other = finder_.find(picture(7, false, true), time);
  ASSERT_TRUE(other);
  EXPECT_FALSE(on_the_left(other));
}

TEST_F(TwoPeople, FarOneIsKeptWhenTheNearOneComes) {
  double time = 0.0;
  for (std::size_t i = 0; i < 8; ++i, time += kFrame) {
    const auto person = finder_.find(picture(i, i > 2, true), time);
    ASSERT_TRUE(person) << i;
    EXPECT_FALSE(on_the_left(person)) << i;
  }
}

TEST_F(TwoPeople, WhoSitsDownInFrontIsFollowed) {
  const auto at_work = [&](std::size_t frame, bool near) {
    cv::Mat out(240, 320, CV_8UC3, cv::Scalar(180, 170, 170));
    if (near) {
      frames_[frame](cv::Rect(60, 0, 200, 240)).copyTo(out(cv::Rect(0, 0, 200, 240)));
    }
    cv::Mat far;
    cv::resize(frames_[frame], far, {120, 90}, 0, 0, cv::INTER_AREA);
    far.copyTo(out(cv::Rect(200, 60, 120, 90)));
    return out;
  };
  // One person at the back of the room; somebody walks past, then somebody stays.
  std::vector<double> switched;
  for (double time = 0.0; time < 11.0; time += 0.5) {
    const bool near = (time > 0.6 && time < 2.1) || (time > 3.1 && time < 8.1);
    const auto person = finder_.find(at_work(static_cast<std::size_t>(time), near), time);
    if (time < 8.1 || time > 9.1) {  // who came has left: the other is found again within a second
      ASSERT_TRUE(person) << time;
      EXPECT_EQ(place_of(*person).shoulders.x() < 200, time > 5.9 && time < 8.1) << time;
    }
    if (finder_.switched()) {
      switched.push_back(time);
    }
  }
  ASSERT_EQ(switched.size(), 2U) << "there and back";
  EXPECT_EQ(switched[0], 6.0);
  EXPECT_GT(switched[1], 8.1);
}

TEST_F(TwoPeople, AMaskIsKeptForOnePicture) {
  const auto is_same = [](const cv::Mat& a, const cv::Mat& b) {
    return a.size() == b.size() && cv::countNonZero(a != b) == 0;
  };
  const auto find = [&](std::size_t i, bool keep_mask) {
    PoseLandmarks found =
        finder_.find(picture(i, true, false), kFrame * static_cast<double>(i)).value_or(PoseLandmarks{});
    found.mask = finder_.mask(keep_mask);
    return found;
  };
  std::vector<PoseLandmarks> kept;
  for (std::size_t i = 0; i < 4; ++i) {
    kept.push_back(find(i, true));
  }
  finder_.reset();
  for (std::size_t i = 0; i < 4; ++i) {
    const PoseLandmarks own = find(i, false);
    ASSERT_EQ(own.mask.size(), cv::Size(kColumns, kRows));
    EXPECT_EQ(is_same(kept[i].mask, own.mask), i % 2 == 0) << i;
    EXPECT_EQ(kept[i].points[0].pixel, own.points[0].pixel) << i;
  }
  EXPECT_TRUE(is_same(kept[1].mask, kept[0].mask));
  EXPECT_TRUE(is_same(kept[3].mask, kept[2].mask));
  // Pictures of a slow camera have their own.
  ASSERT_TRUE(finder_.find(picture(4, true, false), 10.0));
  const cv::Mat first = finder_.mask(true);
  ASSERT_TRUE(finder_.find(picture(5, true, false), 10.05));
  EXPECT_FALSE(is_same(first, finder_.mask(true)));
  // Where nobody is, there is no mask.
  EXPECT_FALSE(finder_.find(empty_picture(), 20.0));
  EXPECT_TRUE(finder_.mask(true).empty());
}

TEST_F(TwoPeople, CountingOthersChangesNoMask) {
  const cv::Mat both = picture(0, true, true);
  const auto mask_after = [&](double time) {
    PersonFinder finder(kModels);
    EXPECT_TRUE(finder.find(both, 0.0));
    EXPECT_TRUE(finder.find(both, time));
    EXPECT_EQ(finder.people(), 2);
    return finder.mask(false);
  };
  // Only after a second, the network looks at the other person again.
  const cv::Mat plain = mask_after(0.9);
  const cv::Mat counted = mask_after(1.0);
  ASSERT_EQ(plain.size(), counted.size());
  EXPECT_EQ(cv::countNonZero(plain != counted), 0);
  EXPECT_GT(cv::countNonZero(plain > 127), 0);
}

TEST_F(TwoPeople, SomebodyElseIsNoArm) {
  // Somebody stands behind and touches the outline of the near person.
  const cv::Mat room = empty_picture();
  const cv::Rect place(250, 50, 200, 150);
  const auto crowded = [&](std::size_t i) {
    cv::Mat out = picture(i, true, false);
    cv::Mat difference;
    cv::absdiff(frames_[i], room(cv::Rect(0, 0, 320, 240)), difference);
    cv::Mat person;
    cv::cvtColor(difference, person, cv::COLOR_BGR2GRAY);
    cv::resize(person > 25, person, place.size(), 0, 0, cv::INTER_NEAREST);
    cv::Mat small;
    cv::resize(frames_[i], small, place.size(), 0, 0, cv::INTER_AREA);
    small.copyTo(out(place), person);
    return out;
  };
  FeatureExtractor features = extractor();
  const std::vector<Frame> empty{{room, 0, 0.0}};
  features.learn_background(empty);
  ASSERT_TRUE(features.learn_person({picture(0, true, false), 0, 0.0}).accepted);
  for (std::size_t i = 1; i < 5; ++i) {
    const auto index = static_cast<std::int64_t>(i);
    const FrameFeatures seen = features.extract({crowded(i), index, kFrame * static_cast<double>(i)});
    const cv::Mat other = seen.labels(cv::Rect(335, 0, kColumns - 335, kRows));
    EXPECT_EQ(cv::countNonZero(other == static_cast<unsigned char>(Label::arms)), 0) << i;
    EXPECT_EQ(cv::countNonZero(other == static_cast<unsigned char>(Label::clothes)), 0) << i;
    EXPECT_GT(cv::countNonZero(other == static_cast<unsigned char>(Label::ignore)), 300) << i;
    const cv::Mat own = seen.labels(cv::Rect(0, 0, 320, kRows));
    EXPECT_GT(cv::countNonZero(own == static_cast<unsigned char>(Label::arms)), 1000) << i;
  }
}

TEST_F(TwoPeople, GreyPictureHasTheOutlineOfTheMask) {
  FeatureExtractor features = extractor();
  const std::vector<Frame> empty{{support::grey(empty_picture()), 0, 0.0}};
  features.learn_background(empty);
  const FrameFeatures seen = features.extract({support::grey(picture(0, true, false)), 0, 0.0});
  ASSERT_TRUE(seen.landmarks);
  EXPECT_EQ(cv::countNonZero(seen.silhouette != (seen.landmarks->mask > 127)), 0);
  EXPECT_GT(cv::countNonZero(seen.edges), 300);
  // It is that of each picture: a kept one would be the outline of an earlier pose.
  const FrameFeatures next = features.extract({support::grey(picture(1, true, false)), 1, kFrame});
  ASSERT_TRUE(next.landmarks);
  EXPECT_GT(cv::countNonZero(next.landmarks->mask != seen.landmarks->mask), 0);
  EXPECT_FALSE(has_colour(features.status()));
  EXPECT_EQ(cv::countNonZero(seen.labels == static_cast<unsigned char>(Label::arms)), 0);
}

TEST_F(TwoPeople, AFaceBesideACoveredOneIsNotTaken) {
  cv::Mat image = frames_[0].clone();
  const auto person = finder_.find(image, 0.0);
  ASSERT_TRUE(person);
  ASSERT_TRUE(FaceFinder(kModels).find(image, *person, image.size(), 0.0));
  // Somebody who leans in: the same face, a face's width beside the covered one.
  const PictureRegion head = head_region(*person);
  const auto face_at = [&](double aside) {
    const Eigen::Vector2d corner = head.centre + head.width * Eigen::Vector2d(aside - 0.2, -0.2);
    const int side = static_cast<int>(0.4 * head.width);
    return cv::Rect(static_cast<int>(corner.x()), static_cast<int>(corner.y()), side, side);
  };
  image(face_at(0.0)).copyTo(image(face_at(0.42)));
  image(face_at(0.0)).setTo(cv::Scalar(180, 170, 170));
  EXPECT_FALSE(FaceFinder(kModels).find(image, *person, image.size(), 0.0));
}

}  // namespace
}  // namespace telemime
