// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <memory>
#include <opencv2/core.hpp>

#include "lab/synth/sequence.h"
#include "lab/synth/testing_mesh_person.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

using Eigen::Vector3d;
using testing_errors::message_of;
using testing_errors::names;

struct MeshSceneTest : MeshPersonTest {
  SceneOptions options = [] {
    SceneOptions o;
    o.width = 160;
    o.height = 120;
    o.seed = 3;
    return o;
  }();
  Scene scene() const {
    Scene made = make_scene(options);
    made.mesh = std::make_shared<const MeshPerson>(person);
    return made;
  }
};

TEST_F(MeshSceneTest, ThePictureIsTheSameForAnyNumberOfThreads) {
  const Scene made = scene();
  SynthFrame one, many;
  tbb::task_arena(1).execute([&] { one = render_frame(made, 43); });
  tbb::task_arena(2).execute([&] { many = render_frame(made, 43); });
  EXPECT_EQ(cv::norm(one.image, many.image, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(one.surfaces, many.surfaces, cv::NORM_INF), 0.0);
}

TEST_F(MeshSceneTest, JointsAreWhereThePictureShowsThem) {
  const Scene made = scene();
  const SynthFrame frame = render_frame(made, 43);
  // Each bone has a tetrahedron: near the middle of a forearm there is skin, above the head there is none.
  const JointPositions& joints = frame.joints;
  const auto surface = [&](const Vector3d& at) {
    const Eigen::Vector2d pixel = made.camera.project(at);
    return static_cast<Surface>(frame.surfaces.at<std::uint8_t>(cvRound(pixel.y()), cvRound(pixel.x())));
  };
  const auto i = static_cast<std::size_t>(&bone("lowerarm01.L") - person.bones.data());
  const PosedMesh posed = pose_mesh(person, scene_kinematics(made, 43));
  const Eigen::Vector3f middle =
      (posed.vertices[0][4 * i] + posed.vertices[0][4 * i + 1] + posed.vertices[0][4 * i + 2]) / 3.0f;
  EXPECT_EQ(surface(middle.cast<double>()), Surface::arm);
  EXPECT_EQ(surface(joints[Joint::head_top] - Vector3d(0.0, 0.1, 0.0)), Surface::background);
  EXPECT_EQ(joints[Joint::l_wrist], scene_truth(made, 43).bones.joints[Joint::l_wrist]);
}

TEST_F(MeshSceneTest, TheNearerSurfaceIsSeen) {
  // Something before the chest hides the clothes.
  Scene made = scene();
  const auto shirt_pixels = [&] {
    return cv::countNonZero(render_frame(made, 0).surfaces == static_cast<int>(Surface::shirt));
  };
  const int with = shirt_pixels();
  EXPECT_GT(with, 10);
  MeshPerson nearer = person;
  MeshPart wall = nearer.parts[1];
  for (Eigen::Vector3f& v : wall.vertices) {
    v.z() += 0.2f;
    v.x() *= 3.0f;
  }
  for (MeshPart::Triangle& t : wall.triangles) {
    t.surface = Surface::trousers;
  }
  nearer.parts.push_back(wall);
  made.mesh = std::make_shared<const MeshPerson>(nearer);
  EXPECT_LT(shirt_pixels(), with / 2);
}

TEST_F(MeshSceneTest, ClearHairShowsWhatIsBehindIt) {
  Scene made = scene();
  const cv::Mat with = render_frame(made, 0).image;
  MeshPerson bald = person;
  bald.parts.pop_back();
  MeshPerson clear = person;
  ASSERT_TRUE(clear.parts.back().transparent);
  clear.parts.back().texture = clear.parts.back().texture.clone();
  clear.parts.back().texture.forEach<cv::Vec4f>([](cv::Vec4f& c, const int*) { c[3] = 0.0f; });
  made.mesh = std::make_shared<const MeshPerson>(bald);
  const SynthFrame without = render_frame(made, 0);
  made.mesh = std::make_shared<const MeshPerson>(clear);
  const SynthFrame through = render_frame(made, 0);
  EXPECT_EQ(cv::norm(without.surfaces, through.surfaces, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(without.image, through.image, cv::NORM_INF), 0.0) << "clear hair casts a shadow";
  EXPECT_GT(cv::norm(with, through.image, cv::NORM_INF), 20.0);
}

TEST_F(MeshSceneTest, TheFileHasTheTruthOfTheMeshes) {
  const Scene made = scene();
  Scene short_clip = made;
  short_clip.options.frames = 2;
  short_clip.options.fingers = true;
  const auto truth = nlohmann::json::parse(truth_json(short_clip));
  const PersonTruth person_truth = scene_truth(short_clip, 1);
  int found = 0;
  for (std::size_t j = 0; j < truth["joints"].size(); ++j) {
    if (truth["joints"][j] == "r_wrist") {
      ++found;
      EXPECT_NEAR(truth["positions"][1][j][0].get<double>(),
                  1000.0 * person_truth.bones.joints[Joint::r_wrist].x(), 0.01);
    }
  }
  EXPECT_EQ(found, 1);
  EXPECT_NEAR(truth["hands"]["left"][1][20][2].get<double>(), 1000.0 * person_truth.hands[0][20].z(), 0.01);
}

TEST_F(MeshSceneTest, HalfClearHairIsMixedWithWhatIsBehindIt) {
  Scene made = scene();
  const auto drawn = [&](float opacity) {
    MeshPerson changed = person;
    cv::Mat& texture = changed.parts.back().texture;
    texture = texture.clone();
    texture.forEach<cv::Vec4f>([&](cv::Vec4f& c, const int*) { c = {1.0f, 1.0f, 1.0f, opacity}; });
    made.mesh = std::make_shared<const MeshPerson>(changed);
    made.options.sensor = {.noise = 0.0, .flicker = 0.0};
    return cv::sum(render_frame(made, 0).image)[0];
  };
  // White hair brightens the picture the more, the more it hides.
  EXPECT_GT(drawn(0.5f), drawn(0.0f) + 100.0);
  EXPECT_GT(drawn(1.0f), drawn(0.5f) + 100.0);
}

TEST(MeshScene, StripesAreRefused) {
  SceneOptions options;
  options.people = "people";
  options.striped_shirt = true;
  EXPECT_TRUE(names(message_of(ErrorKind::usage, [&] { make_scene(options); }), "--striped"));
}

}  // namespace
}  // namespace telemime
