// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/find_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "support/needs.h"
#include "telemime/body/face_model.h"
#include "telemime/capture/source.h"
#include "telemime/evaluation/truth.h"
#include "telemime/nets/face_landmarks.h"
#include "telemime/nets/hand_landmarks.h"
#include "telemime/nets/pose_detector.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

const fs::path kModels = TELEMIME_BUILD_MODELS;
const fs::path kDemo = TELEMIME_SOURCE_DIR "/data/demo";

class FindPose : public support::WithNetworks {};

std::vector<cv::Mat> frames_of(const fs::path& clip, std::size_t count) {
  const std::unique_ptr<Source> source = open_source(clip.string());
  std::vector<cv::Mat> frames;
  for (std::optional<Frame> frame = source->next(); frame && frames.size() < count; frame = source->next()) {
    frames.push_back(frame->image.clone());
  }
  return frames;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

TEST_F(FindPose, LandmarksAreNearTheTrueJoints) {
  const std::vector<cv::Mat> frames = frames_of(kDemo / "video.mp4", 60);
  const Truth truth = read_truth(kDemo / "truth.json");
  PoseNetworks networks = load_pose_networks(kModels);
  constexpr std::pair<Joint, int> kPairs[] = {{Joint::l_elbow, PoseLandmarkIndex::left_elbow},
                                              {Joint::r_elbow, PoseLandmarkIndex::right_elbow},
                                              {Joint::l_wrist, PoseLandmarkIndex::left_wrist},
                                              {Joint::r_wrist, PoseLandmarkIndex::right_wrist}};
  std::vector<double> distances;
  std::vector<double> across;  // positive where the left elbow is on the right of the picture
  std::optional<PictureRegion> region;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::optional<PoseLandmarks> found = find_pose(frames[i], networks, region);
    ASSERT_TRUE(found) << "frame " << i;
    region = found->next_region;
    for (const auto& [joint, landmark] : kPairs) {
      const auto& position = truth.frames[i][static_cast<std::size_t>(joint)];
      ASSERT_TRUE(position);
      const PoseLandmark& point = found->points[landmark];
      distances.push_back((point.pixel - truth.camera.project(*position)).norm());
      EXPECT_GT(point.covariance.trace(), 0.0);
      EXPECT_GT(point.covariance.determinant(), 0.0);
    }
    across.push_back(found->points[PoseLandmarkIndex::left_elbow].world.x() -
                     found->points[PoseLandmarkIndex::right_elbow].world.x());
  }
  EXPECT_LT(median(distances), 5.0);  // pixels of 320 x 240; landmarks are on the skin, joints in the body
  EXPECT_GT(median(across), 0.3);     // m
}

TEST_F(FindPose, FollowsTheRegionOfTheFrameBefore) {
  const std::vector<cv::Mat> frames = frames_of(kDemo / "video.mp4", 2);
  PoseNetworks networks = load_pose_networks(kModels);
  const auto first = find_pose(frames[0], networks);
  ASSERT_TRUE(first);
  const auto followed = find_pose(frames[1], networks, first->next_region);
  const auto detected = find_pose(frames[1], networks);
  ASSERT_TRUE(followed && detected);
  EXPECT_LT((followed->region.centre - first->next_region.centre).norm(), 1e-9);
  for (const int index : {PoseLandmarkIndex::left_shoulder, PoseLandmarkIndex::right_elbow}) {
    EXPECT_LT((followed->points[index].pixel - detected->points[index].pixel).norm(), 4.0);
  }
}

TEST_F(FindPose, SearchesAgainWhereNobodyIsLeft) {
  const cv::Mat frame = frames_of(kDemo / "video.mp4", 1)[0];
  PoseNetworks networks = load_pose_networks(kModels);
  const PictureRegion corner{.centre = {10.0, 10.0}, .width = 30.0, .height = 30.0};
  const auto found = find_pose(frame, networks, corner);
  ASSERT_TRUE(found);
  EXPECT_GT((found->region.centre - corner.centre).norm(), 50.0);
}

TEST_F(FindPose, NobodyInAnEmptyPicture) {
  PoseNetworks networks = load_pose_networks(kModels);
  EXPECT_FALSE(find_pose(cv::Mat(240, 320, CV_8UC3, cv::Scalar(90, 90, 90)), networks));
  EXPECT_TRUE(detect_poses(cv::Mat(240, 320, CV_8UC3, cv::Scalar(90, 90, 90)), networks.detector).empty());
}

TEST_F(FindPose, SameFrameSameLandmarks) {
  const std::vector<cv::Mat> frames = frames_of(kDemo / "video.mp4", 3);
  PoseNetworks networks = load_pose_networks(kModels);
  PoseNetworks others = load_pose_networks(kModels);
  find_pose(frames[2], networks);
  const auto a = find_pose(frames[1], networks);
  const auto b = find_pose(frames[1], others);
  ASSERT_TRUE(a && b);
  for (std::size_t i = 0; i < PoseLandmarks::kCount; ++i) {
    EXPECT_EQ(a->points[i].pixel, b->points[i].pixel);
    EXPECT_EQ(a->points[i].covariance, b->points[i].covariance);
  }
}

TEST_F(FindPose, MaskCoversThePersonAlone) {
  const cv::Mat frame = frames_of(kDemo / "video.mp4", 1)[0];
  PoseNetworks networks = load_pose_networks(kModels);
  const auto found = find_pose(frame, networks);
  ASSERT_TRUE(found);
  const auto& points = found->points;
  const Eigen::Vector2d chest =
      0.5 * (points[PoseLandmarkIndex::left_shoulder].pixel + points[PoseLandmarkIndex::right_hip].pixel);
  ASSERT_EQ(found->mask.size(), frame.size());
  EXPECT_GT(found->mask.at<std::uint8_t>(cv::Point(cvRound(chest.x()), cvRound(chest.y()))), 200);
  EXPECT_LT(found->mask.at<std::uint8_t>(5, 5), 50);
}

TEST_F(FindPose, HandsBeginAtTheWristsOfThePose) {
  const std::vector<cv::Mat> frames = frames_of(kDemo / "video.mp4", 10);
  PoseNetworks networks = load_pose_networks(kModels);
  HandNetworks hands = load_hand_networks(kModels);
  int found = 0;
  for (const cv::Mat& frame : frames) {
    const auto pose = find_pose(frame, networks);
    ASSERT_TRUE(pose);
    const auto& points = pose->points;
    const double forearm =
        (points[PoseLandmarkIndex::left_wrist].pixel - points[PoseLandmarkIndex::left_elbow].pixel).norm();
    for (const HandSide side : {HandSide::left, HandSide::right}) {
      const bool left = side == HandSide::left;
      if (const auto hand = find_hand(frame, *pose, side, hands)) {
        ++found;
        const int wrist = left ? PoseLandmarkIndex::left_wrist : PoseLandmarkIndex::right_wrist;
        EXPECT_LT((hand->points[0].pixel - points[wrist].pixel).norm(), 0.4 * forearm);
      }
    }
  }
  EXPECT_GE(found, 10);
}

TEST_F(FindPose, FaceIsAroundTheNoseOfThePose) {
  const std::vector<cv::Mat> frames = frames_of(kDemo / "video.mp4", 5);
  PoseNetworks networks = load_pose_networks(kModels);
  FaceNetworks faces = load_face_networks(kModels);
  std::optional<PictureRegion> region;
  for (const cv::Mat& frame : frames) {
    const auto pose = find_pose(frame, networks);
    ASSERT_TRUE(pose);
    const auto face = region ? face_in(frame, *region, faces) : find_face(frame, head_region(*pose), faces);
    ASSERT_TRUE(face);
    region = face->next_region;
    constexpr std::size_t kNoseTip = 1, kRightEyeCorner = 33, kLeftEyeCorner = 263;
    const auto& points = face->points;
    const Eigen::Vector2d eyes = points[kLeftEyeCorner].pixel - points[kRightEyeCorner].pixel;
    EXPECT_GT(eyes.x(), 8.0);  // the person's left is on the right of a picture that is not mirrored
    EXPECT_LT((points[kNoseTip].pixel - pose->points[PoseLandmarkIndex::nose].pixel).norm(),
              0.5 * eyes.norm());
    EXPECT_NEAR(region->centre.x(), points[kNoseTip].pixel.x(), 0.5 * eyes.norm());
  }
}

// What is seen of the face in the first frames of the demo.
std::vector<std::optional<FaceLandmarks>> faces_of_demo(FaceNetworks& faces) {
  PoseNetworks networks = load_pose_networks(kModels);
  std::vector<std::optional<FaceLandmarks>> seen;
  for (const cv::Mat& frame : frames_of(kDemo / "video.mp4", 3)) {
    const auto pose = find_pose(frame, networks);
    seen.push_back(pose ? find_face(frame, head_region(*pose), faces) : std::nullopt);
  }
  return seen;
}

TEST_F(FindPose, EyesAndIrisesAreOnTheirOwnSide) {
  FaceNetworks faces = load_face_networks(kModels);
  for (const std::optional<FaceLandmarks>& face : faces_of_demo(faces)) {
    ASSERT_TRUE(face);
    FacePoints points;
    for (std::size_t i = 0; i < kFacePoints; ++i) {
      points[i] = {face->points[i].pixel.x(), face->points[i].pixel.y(), face->points[i].depth};
    }
    const HeadFit fit = fit_head(points);
    const std::vector<std::size_t> right = {33,  7,   163, 144, 145, 153, 154, 155,
                                            133, 173, 157, 158, 159, 160, 161, 246};
    const std::vector<std::size_t> left = {263, 249, 390, 373, 374, 380, 381, 382,
                                           362, 398, 384, 385, 386, 387, 388, 466};
    for (const auto& [iris, eye] : {std::pair(kRightIris, right), std::pair(kLeftIris, left)}) {
      std::vector<cv::Point2f> contour;
      for (const std::size_t i : eye) {
        contour.emplace_back(static_cast<float>(points[i].x()), static_cast<float>(points[i].y()));
        EXPECT_LT((fit.in_head(points[i]) - canonical_face()[i]).head<2>().norm(), 10.0) << i << ", mm";
      }
      const cv::Point2f middle(static_cast<float>(points[iris].x()), static_cast<float>(points[iris].y()));
      EXPECT_GT(cv::pointPolygonTest(contour, middle, false), 0.0) << iris;
      const double across = (points[iris + 1] - points[iris + 3]).head<2>().norm() / fit.scale;
      EXPECT_GT(across, 9.0) << "mm";
      EXPECT_LT(across, 14.0) << "mm";
    }
    for (const std::size_t i : {0U, 13U, 14U, 17U, 61U, 291U}) {
      EXPECT_LT((fit.in_head(points[i]) - canonical_face()[i]).head<2>().norm(), 15.0) << i << ", mm";
    }
  }
}

TEST_F(FindPose, TheSecondLookSeesTheSameFace) {
  FaceNetworks faces = load_face_networks(kModels);
  const cv::Mat blank(240, 320, CV_8UC3, cv::Scalar(90, 90, 90));
  for (const std::optional<FaceLandmarks>& face : faces_of_demo(faces)) {
    ASSERT_TRUE(face && face->again);
    double apart = 0.0;
    for (std::size_t i = 0; i < FaceLandmarks::kMeshCount; ++i) {
      apart += ((*face->again)[i].pixel - face->points[i].pixel).norm() / FaceLandmarks::kMeshCount;
    }
    // It is a look at another square, so it differs a little.
    EXPECT_GT(apart, 0.01);
    EXPECT_LT(apart, 0.03 * face->next_region.width);
    // Where there is no face, none is found.
    EXPECT_FALSE(face_in(blank, face->next_region, faces));
  }
}

TEST_F(FindPose, FindsEverybodyInTheRealClips) {
  const fs::path clips = support::test_data() / "real";
  if (!fs::exists(clips)) {
    GTEST_SKIP() << support::kNoClips;
  }
  PoseNetworks networks = load_pose_networks(kModels, PoseModel::lite);
  for (const char* clip :
       {"webcam_hello", "seated_stereo", "pose2sim_cam2", "handheld_wave", "room_wave_10fps"}) {
    std::optional<PictureRegion> region;
    for (const cv::Mat& frame : frames_of(clips / clip / "clip.mp4", 20)) {
      const auto found = find_pose(frame, networks, region);
      ASSERT_TRUE(found) << clip;
      region = found->next_region;
    }
  }
}

}  // namespace
}  // namespace telemime
