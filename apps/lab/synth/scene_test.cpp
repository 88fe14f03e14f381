// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/core.hpp>

#include "lab/synth/sequence.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

SceneOptions small_scene(Gesture gesture = Gesture::asking, std::uint64_t seed = 1) {
  SceneOptions options;
  options.gesture = gesture;
  options.seed = seed;
  options.width = 80;
  options.height = 60;
  return options;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

Surface surface_at(const SynthFrame& frame, const Camera& camera, const Eigen::Vector3d& point) {
  const Eigen::Vector2d pixel = camera.project(point);
  return static_cast<Surface>(frame.surfaces.at<std::uint8_t>(static_cast<int>(std::lround(pixel.y())),
                                                              static_cast<int>(std::lround(pixel.x()))));
}

TEST(Scene, SameSeedSamePixelsWhateverTheThreads) {
  const Scene scene = make_scene(small_scene());
  const Scene again = make_scene(small_scene());
  SynthFrame one;
  SynthFrame many;
  tbb::task_arena(1).execute([&] { one = render_frame(scene, 43); });
  tbb::task_arena(2).execute([&] { many = render_frame(again, 43); });
  EXPECT_TRUE(same(one.image, many.image));
  EXPECT_TRUE(same(one.surfaces, many.surfaces));
  EXPECT_FALSE(same(one.image, render_frame(make_scene(small_scene(Gesture::asking, 2)), 43).image));
}

TEST(Scene, FramesDoNotDependOnTheirOrder) {
  const Scene scene = make_scene(small_scene());
  const cv::Mat before = render_frame(scene, 10).image;
  render_frame(scene, 90);
  EXPECT_TRUE(same(before, render_frame(scene, 10).image));
}

TEST(Scene, TrueJointsLieOnThePerson) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    for (std::size_t g = 0; g < kGestureCount; ++g) {
      SceneOptions options = small_scene(static_cast<Gesture>(g), seed);
      options.width = 160;
      options.height = 120;
      const Scene scene = make_scene(options);
      const SynthFrame frame = render_frame(scene, 0);
      const auto at = [&](Joint joint) { return surface_at(frame, scene.camera, frame.joints[joint]); };
      for (const Joint joint :
           {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist, Joint::r_wrist, Joint::l_hand, Joint::r_hand}) {
        EXPECT_EQ(at(joint), Surface::arm)
            << kJointNames[static_cast<std::size_t>(joint)] << " seed " << seed;
      }
      EXPECT_EQ(at(Joint::l_shoulder), Surface::shirt);
      EXPECT_EQ(at(Joint::r_shoulder), Surface::shirt);
      EXPECT_EQ(at(Joint::head), Surface::head);
      // Nothing of the hands is cut off by the edge of the image.
      const cv::Mat arms = frame.surfaces == static_cast<int>(Surface::arm);
      EXPECT_EQ(cv::countNonZero(arms), cv::countNonZero(arms(cv::Rect(1, 1, 158, 118)))) << "seed " << seed;
      EXPECT_EQ(frame.joints[Joint::l_wrist].x() > frame.joints[Joint::r_wrist].x(), true);
    }
  }
}

TEST(Scene, HandsAndArmsNeverEnterTheTrunk) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (std::size_t g = 0; g < kGestureCount; ++g) {
      const Scene scene = make_scene(small_scene(static_cast<Gesture>(g), seed));
      for (int frame = 0; frame < kGestureFrames; frame += 2) {
        const ActorKinematics k = scene_kinematics(scene, frame);
        Avatar avatar = make_avatar(scene.look, k);
        std::erase_if(avatar.parts, [](const BodyPart& part) {
          return part.kind != BodyPart::Kind::torso && part.kind != BodyPart::Kind::head;
        });
        PartSelection all;
        for (const BodyPart& part : avatar.parts) {
          all.parts[all.count++] = &part;
        }
        for (const Joint joint : {Joint::l_wrist, Joint::r_wrist, Joint::l_hand, Joint::r_hand}) {
          EXPECT_GT(sample_body(avatar, all, k.joints[joint].cast<float>()).distance, 0.012f)
              << kGestureNames[g] << " seed " << seed << " frame " << frame << " "
              << kJointNames[static_cast<std::size_t>(joint)];
        }
      }
    }
  }
}

TEST(Scene, BoundingBallsHoldTheirParts) {
  const Scene scene = make_scene(small_scene(Gesture::joy, 5));
  for (const HairStyle style : {HairStyle::cap, HairStyle::short_hair, HairStyle::bob}) {
    Look look = scene.look;
    look.style = style;
    const Avatar avatar = make_avatar(look, scene_kinematics(scene, 30));
    Random random(11);
    for (const BodyPart& part : avatar.parts) {
      PartSelection one;
      one.parts[one.count++] = &part;
      for (int i = 0; i < 400; ++i) {
        Eigen::Vector3d direction{random.normal(), random.normal(), random.normal()};
        direction.normalize();
        const Eigen::Vector3f p = part.centre + 1.001f * part.radius * direction.cast<float>();
        EXPECT_GT(sample_body(avatar, one, p).distance, 0.0f);
      }
    }
  }
}

TEST(Scene, CleanSceneBesideThePersonIsTheBackground) {
  SceneOptions options = small_scene(Gesture::raising_arms);
  options.sensor = {0.0, 0.0};
  const Scene scene = make_scene(options);
  const SynthFrame frame = render_frame(scene, 0);
  const cv::Mat background = render_background(scene, 0);
  EXPECT_TRUE(same(background, render_background(scene, 7)));
  // No shadow falls above the head to the left.
  const cv::Rect corner(0, 0, 20, 12);
  EXPECT_EQ(cv::countNonZero(frame.surfaces(corner)), 0);
  EXPECT_TRUE(same(frame.image(corner).clone(), background(corner).clone()));
  // The shadow only darkens: it lies below the person to the right.
  const cv::Rect shadow(56, 44, 20, 14);
  const cv::Mat wall = frame.surfaces(shadow) == 0;
  EXPECT_LT(cv::mean(frame.image(shadow), wall)[1], cv::mean(background(shadow), wall)[1] - 2.0);
}

TEST(Scene, NoiseHasTheStatedDeviation) {
  SceneOptions options = small_scene();
  options.sensor = {3.0, 0.0};
  const Scene noisy = make_scene(options);
  options.sensor = {0.0, 0.0};
  const Scene clean = make_scene(options);
  cv::Mat difference;
  cv::subtract(render_background(noisy, 3), render_background(clean, 3), difference, cv::noArray(), CV_32F);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(difference, mean, deviation);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(mean[c], 0.0, 0.2);
    EXPECT_NEAR(deviation[c], 3.0, 0.2);
  }
}

TEST(Scene, LampBrightensRedMostAfterTheMiddle) {
  SceneOptions options = small_scene();
  options.frames = 40;
  options.sensor = {0.0, 0.0};
  const Scene plain = make_scene(options);
  options.light_change = true;
  const Scene lamp = make_scene(options);
  EXPECT_TRUE(same(render_frame(plain, 18).image, render_frame(lamp, 18).image));
  const cv::Scalar off = cv::mean(render_frame(plain, 30).image);
  const cv::Scalar on = cv::mean(render_frame(lamp, 30).image);
  for (int c = 0; c < 3; ++c) {
    EXPECT_GT(on[c] / off[c], 1.04);
    EXPECT_LT(on[c] / off[c], 1.30);
  }
  EXPECT_GT(on[2] / off[2], on[0] / off[0] + 0.03);
}

TEST(Scene, LongSleevesCoverTheForearm) {
  SceneOptions options = small_scene();
  options.long_sleeves = true;
  const Scene scene = make_scene(options);
  const SynthFrame frame = render_frame(scene, 0);
  const Eigen::Vector3d middle = 0.5 * (frame.joints[Joint::l_elbow] + frame.joints[Joint::l_wrist]);
  EXPECT_EQ(surface_at(frame, scene.camera, middle), Surface::shirt);
  EXPECT_EQ(surface_at(frame, scene.camera, frame.joints[Joint::l_hand]), Surface::arm);
}

TEST(Scene, PersonWalksInAndOut) {
  SceneOptions options = small_scene(Gesture::talking);
  options.frames = 120;
  options.walk_in = true;
  const Scene scene = make_scene(options);
  const auto pixels = [&](int frame) { return cv::countNonZero(render_frame(scene, frame).surfaces); };
  EXPECT_EQ(pixels(0), 0);
  EXPECT_EQ(pixels(27), 0);
  EXPECT_EQ(pixels(119), 0);
  EXPECT_GT(pixels(60), 500);
  for (const int frame : {0, 27, 30, 104, 119}) {
    EXPECT_FALSE(person_is_visible(scene, frame)) << frame;
  }
  for (const int frame : {48, 60, 85}) {
    EXPECT_TRUE(person_is_visible(scene, frame)) << frame;
  }
  // Walks to the left with the chest turned that way, and back.
  const auto neck = [&](int frame) { return scene_kinematics(scene, frame).joints[Joint::neck]; };
  EXPECT_GT(neck(35).x(), neck(50).x() + 0.3);
  EXPECT_LT(neck(85).x(), neck(100).x() - 0.3);
  EXPECT_LT(scene_kinematics(scene, 40).camera_from_chest.linear().col(2).x(), -0.5);
  EXPECT_GT(scene_kinematics(scene, 95).camera_from_chest.linear().col(2).x(), 0.5);
}

TEST(Scene, DistanceMovesThePersonAndKeepsTheHead) {
  for (const double distance : {0.75, 1.2, 1.7}) {
    SceneOptions options = small_scene(Gesture::talking);
    options.distance = distance;
    const Scene scene = make_scene(options);
    const SynthFrame frame = render_frame(scene, 0);
    EXPECT_NEAR(frame.joints[Joint::root].z(), distance, 0.06);
    EXPECT_EQ(surface_at(frame, scene.camera, frame.joints[Joint::head]), Surface::head) << distance;
    EXPECT_EQ(cv::countNonZero(frame.surfaces.row(0)), 0) << distance;
  }
}

// Signed angle (rad) about the y axis of the camera from the axis of the camera to the shoulders.
double turn_of_shoulders(const Scene& scene, int frame) {
  const JointPositions joints = scene_truth(scene, frame).bones.joints;
  const Eigen::Vector3d line = joints[Joint::l_shoulder] - joints[Joint::r_shoulder];
  return std::atan2(line.z(), line.x());
}

TEST(Scene, PersonSitsTurnedAndFacesTheCamera) {
  const Scene straight = make_scene(small_scene(Gesture::talking));
  for (const double turn : {-0.9, 0.6}) {
    SceneOptions options = small_scene(Gesture::talking);
    options.turn = turn;
    const Scene scene = make_scene(options);
    EXPECT_NEAR(turn_of_shoulders(scene, 0) - turn_of_shoulders(straight, 0), turn, 0.02);
    const Eigen::Quaterniond face(scene_kinematics(scene, 0).camera_from_head.linear());
    EXPECT_LT(
        face.angularDistance(Eigen::Quaterniond(scene_kinematics(straight, 0).camera_from_head.linear())),
        0.03);
  }
}

TEST(Scene, PersonLeansBackForACameraThatLooksUp) {
  SceneOptions options = small_scene(Gesture::talking);
  const auto lean = [](const Scene& scene) {
    const JointPositions joints = scene_kinematics(scene, 0).joints;
    const Eigen::Vector3d up = joints[Joint::neck] - joints[Joint::root];
    return std::atan2(up.z(), -up.y());
  };
  const double upright = lean(make_scene(options));
  options.camera_pitch = 0.35;
  EXPECT_NEAR(lean(make_scene(options)) - upright, 0.35, 1e-4);
}

TEST(Scene, HeadTurnsToEitherSideAndTheTruthHasIt) {
  SceneOptions options = small_scene(Gesture::talking);
  options.look_around = std::numbers::pi / 3.0;
  const auto truth = nlohmann::json::parse(truth_json(make_scene(options)));
  const auto& heads = truth.at("head");
  ASSERT_EQ(heads.size(), static_cast<std::size_t>(options.frames));
  double left = 0.0;
  double right = 0.0;
  for (const auto& head : heads) {
    const auto q = head.get<std::array<double, 4>>();
    const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
    EXPECT_NEAR(rotation.norm(), 1.0, 1e-3);
    const Eigen::Vector3d nose = rotation * -Eigen::Vector3d::UnitZ();  // camera frame
    left = std::max(left, std::atan2(nose.x(), -nose.z()));
    right = std::min(right, std::atan2(nose.x(), -nose.z()));
  }
  EXPECT_GT(left, 0.9);
  EXPECT_LT(left, 1.3);
  EXPECT_LT(right, -0.9);
  EXPECT_GT(right, -1.3);
}

TEST(Scene, ImpossibleOptionsAreRefused) {
  const auto refused = [](const std::function<void(SceneOptions&)>& spoil) {
    SceneOptions options = small_scene();
    spoil(options);
    EXPECT_THROW(make_scene(options), Error);
  };
  refused([](auto& options) { options.width = 4; });
  refused([](auto& options) { options.frames = 0; });
  refused([](auto& options) { options.sensor.noise = -1.0; });
  refused([](auto& options) { options.distance = 0.3; });
  refused([](auto& options) { options.camera_pitch = -0.6; });
  refused([](auto& options) { options.turn = 1.7; });
  refused([](auto& options) {
    options.walk_in = true;
    options.frames = 100;
  });
}

}  // namespace
}  // namespace telemime
