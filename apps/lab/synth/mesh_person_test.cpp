// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/mesh_person.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <set>

#include "lab/synth/testing_mesh_person.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

using Eigen::Vector3d;
using testing_errors::message_of;
using testing_errors::names;

// Frames of all gestures, by another seed each.
std::vector<ActorKinematics> poses() {
  std::vector<ActorKinematics> all;
  for (std::size_t g = 0; g < kGestureCount; ++g) {
    for (const int frame : {0, 30, 43, 60, 90, 130}) {
      all.push_back(actor_kinematics(
          {}, gesture_pose(static_cast<Gesture>(g), frame, static_cast<std::uint64_t>(frame) + g)));
    }
  }
  return all;
}

Vector3d between(const JointPositions& joints, Joint from, Joint to) {
  return joints[to] - joints[from];
}

constexpr std::array<std::pair<Joint, Joint>, 4> kArmBones = {{{Joint::l_shoulder, Joint::l_elbow},
                                                               {Joint::l_elbow, Joint::l_wrist},
                                                               {Joint::r_shoulder, Joint::r_elbow},
                                                               {Joint::r_elbow, Joint::r_wrist}}};

TEST_F(MeshPersonTest, HasTheLengthsOfItsLook) {
  const MeshLook look = TinyPeople::look();
  for (const std::string side : {".L", ".R"}) {
    const auto length = [&](const std::string& from, const std::string& to) {
      return (bone(to + side).head - bone(from + side).head).norm();
    };
    EXPECT_NEAR(length("upperarm01", "lowerarm01"), look.upper_arm, 2e-3f) << side;
    EXPECT_NEAR(length("lowerarm01", "wrist"), look.forearm, 4e-3f) << side;
    EXPECT_NEAR(length("wrist", "finger3-1"), look.hand, 2e-3f) << side;
  }
  float low = 0.0f;
  float high = 0.0f;
  for (const Eigen::Vector3f& v : person.parts[0].vertices) {
    low = std::min(low, v.y());
    high = std::max(high, v.y());
  }
  EXPECT_NEAR(high - low, look.stature, 1e-3f);
}

TEST_F(MeshPersonTest, HidesSkinUnderItsClothes) {
  const auto shown = [&](const std::string& name) {
    const auto i = static_cast<std::size_t>(&bone(name) - person.bones.data());
    std::size_t count = 0;
    for (const MeshPart::Triangle& t : person.parts[0].triangles) {
      count += static_cast<std::size_t>(t.vertex[0]) / 4 == i ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(shown("spine04"), 0U);
  // A triangle and the two of a square; the helper's triangle is not drawn.
  EXPECT_EQ(shown("neck01"), 3U);
  EXPECT_EQ(shown("head"), 3U);
}

TEST_F(MeshPersonTest, SurfacesAreThoseOfHeadAndArms) {
  for (const MeshPart::Triangle& t : person.parts[0].triangles) {
    const std::string& name = person.bones[static_cast<std::size_t>(t.vertex[0]) / 4].name;
    const bool head = name == "head" || name == "jaw" || name == "special03" || name.starts_with("eye") ||
                      name.starts_with("levator");
    EXPECT_EQ(t.surface, head ? Surface::head : Surface::arm) << name;
  }
}

TEST_F(MeshPersonTest, WeightsOfAVertexSumUpToOne) {
  for (const MeshPart& part : person.parts) {
    for (const Eigen::Vector4f& weights : part.weights) {
      EXPECT_NEAR(weights.sum(), 1.0f, 1e-5f);
      EXPECT_GE(weights.minCoeff(), 0.0f);
    }
  }
}

TEST_F(MeshPersonTest, BonesHaveTheActorsDirections) {
  for (const ActorKinematics& actor : poses()) {
    const PersonTruth truth = pose_mesh(person, actor).truth;
    for (const auto& [from, to] : kArmBones) {
      const Vector3d wanted = between(actor.joints, from, to).normalized();
      EXPECT_LT((between(truth.bones.joints, from, to).normalized() - wanted).norm(), 0.02);
    }
    EXPECT_LT((mid_shoulders(truth.bones.joints) - mid_shoulders(actor.joints)).norm(), 1e-6);
  }
}

TEST_F(MeshPersonTest, FingersHaveTheActorsDirections) {
  for (const ActorKinematics& actor : poses()) {
    const PersonTruth truth = pose_mesh(person, actor).truth;
    for (std::size_t side = 0; side < 2; ++side) {
      const auto shape = hand_joints(hand_shape(actor.curl[side]));
      const auto along = [&](std::size_t j) -> Vector3d {
        return actor.camera_from_hand[side] * (shape[j + 1] - shape[j]).cast<double>();
      };
      for (std::size_t j = hand_joint(1, 0); j + 1 < kHandJointCount; ++j) {
        if (j % 4 != 0) {
          const Vector3d is = truth.hands[side][j + 1] - truth.hands[side][j];
          EXPECT_LT((is.normalized() - along(j).normalized()).norm(), 1e-4) << kHandJointNames[j];
        }
      }
      // The palm, too, on either side.
      const Vector3d middle = truth.hands[side][hand_joint(2, 0)] - truth.hands[side][0];
      const Vector3d wanted = actor.camera_from_hand[side] * shape[hand_joint(2, 0)].cast<double>();
      EXPECT_GT(middle.normalized().dot(wanted.normalized()), 0.99);
      const Vector3d across = truth.hands[side][hand_joint(1, 0)] - truth.hands[side][hand_joint(4, 0)];
      EXPECT_GT(across.normalized().dot(actor.camera_from_hand[side].col(0)), 0.9);
    }
  }
}

TEST_F(MeshPersonTest, BonesKeepTheirLengths) {
  const PersonTruth first = pose_mesh(person, poses().front()).truth;
  for (const ActorKinematics& actor : poses()) {
    const PersonTruth truth = pose_mesh(person, actor).truth;
    for (const auto& [from, to] : kArmBones) {
      EXPECT_NEAR(between(truth.bones.joints, from, to).norm(), between(first.bones.joints, from, to).norm(),
                  5e-3);
    }
    for (std::size_t j = hand_joint(1, 1); j + 1 < kHandJointCount; ++j) {
      if (j % 4 != 0) {
        EXPECT_NEAR((truth.hands[1][j + 1] - truth.hands[1][j]).norm(),
                    (first.hands[1][j + 1] - first.hands[1][j]).norm(), 1e-4);
      }
    }
  }
}

TEST_F(MeshPersonTest, SkinGoesWithItsBone) {
  for (const ActorKinematics& actor : poses()) {
    const PosedMesh posed = pose_mesh(person, actor);
    const auto i = static_cast<std::size_t>(&bone("wrist.R") - person.bones.data());
    const Eigen::Vector3f at_rest = person.parts[0].vertices[4 * i + 2] - bone("wrist.R").head;
    const Vector3d now = posed.vertices[0][4 * i + 2].cast<double>() - posed.truth.hands[1][0];
    EXPECT_NEAR(now.norm(), at_rest.norm(), 1e-4);
    // A vertex at the joint is there in every pose.
    EXPECT_LT((posed.vertices[0][4 * i].cast<double>() - posed.truth.hands[1][0]).norm(), 1e-4);
  }
}

TEST_F(MeshPersonTest, HeadTurnsWithTheActors) {
  ActorPose pose;
  pose.look = 0.8;
  const ActorKinematics actor = actor_kinematics({}, pose);
  const PosedMesh posed = pose_mesh(person, actor);
  const auto i = static_cast<std::size_t>(&bone("jaw") - person.bones.data());
  const Vector3d chin = posed.vertices[0][4 * i + 1].cast<double>() - posed.truth.bones.joints[Joint::head];
  const Vector3d at_rest = (bone("jaw").tail - bone("head").head).cast<double>();
  EXPECT_LT((chin - actor.camera_from_head.linear() * at_rest).norm(), 1e-4);
}

TEST_F(MeshPersonTest, TheTurnOfTheHeadIsThatOfItsFace) {
  // A face that is turned at rest has the same place on the head, and the truth another turn.
  const ActorKinematics actor = actor_kinematics({}, {});
  const Eigen::Matrix3d straight = pose_mesh(person, actor).truth.bones.camera_from_head.linear();
  EXPECT_NEAR(straight.determinant(), 1.0, 1e-5);
  MeshLook look = TinyPeople::look();
  look.targets.emplace_back("turned", 1.0f);
  const MeshPerson turned = read_mesh_person(scratch.path(), look);
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(straight.transpose() * pose_mesh(turned, actor).truth.bones.camera_from_head.linear()));
  EXPECT_NEAR(turn.angle(), 0.2, 0.02);
  EXPECT_LT(turn.axis().dot(Eigen::Vector3d::UnitX()), -0.99);
}

TEST_F(MeshPersonTest, SkinBetweenTwoBonesLiesBetweenThem) {
  // A vertex that moves with the upper arm and the forearm is the mean of where each would take it.
  const auto elbow = static_cast<std::size_t>(&bone("lowerarm01.R") - person.bones.data());
  const auto upper = static_cast<std::size_t>(&bone("upperarm02.R") - person.bones.data());
  const std::size_t v = 4 * elbow + 2;
  const ActorKinematics actor = poses()[2];
  const auto moved = [&](const Eigen::Vector4f& weights) {
    person.parts[0].bones[v] = {static_cast<int>(elbow), static_cast<int>(upper), 0, 0};
    person.parts[0].weights[v] = weights;
    return pose_mesh(person, actor).vertices[0][v];
  };
  const Eigen::Vector3f one = moved(Eigen::Vector4f::UnitX());
  const Eigen::Vector3f other = moved(Eigen::Vector4f::UnitY());
  EXPECT_GT((one - other).norm(), 0.001f);
  EXPECT_LT((moved({0.25f, 0.75f, 0.0f, 0.0f}) - (0.25f * one + 0.75f * other)).norm(), 1e-5f);
}

TEST_F(MeshPersonTest, SkinBehindTheKnuckleMovesWithTheFinger) {
  // What the meshes give to the palm, but lies beyond the knuckle of people, belongs to the finger.
  const auto palm = static_cast<std::size_t>(&bone("metacarpal2.L") - person.bones.data());
  const auto finger = static_cast<int>(&bone("finger3-1.L") - person.bones.data());
  const auto share_of_finger = [&](std::size_t v) {
    float share = 0.0f;
    for (std::size_t k = 0; k < 4; ++k) {
      share += person.parts[0].bones[v][k] == finger
                   ? person.parts[0].weights[v][static_cast<Eigen::Index>(k)]
                   : 0.0f;
    }
    return share;
  };
  EXPECT_EQ(share_of_finger(4 * palm), 0.0f) << "at the wrist";
  EXPECT_GT(share_of_finger(4 * palm + 1), 0.9f) << "at the knuckle of the meshes";
}

TEST(MeshLook, LongSleevesAreOtherClothes) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random one(seed);
    Random other(seed);
    EXPECT_NE(random_mesh_look(true, one).clothes, random_mesh_look(false, other).clothes);
  }
}

TEST(MeshLook, DiffersByTheSeed) {
  std::set<std::string> worn;
  std::set<std::string> skins;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    const MeshLook look = random_mesh_look(seed % 2 == 0, random);
    worn.insert(look.clothes);
    skins.insert(look.skin);
    EXPECT_GT(look.stature, 1.35f);
    EXPECT_LT(look.stature, 2.0f);
    EXPECT_NEAR(look.upper_arm / look.stature, 0.16f, 0.02f);
  }
  EXPECT_GE(worn.size(), 8U);
  EXPECT_GE(skins.size(), 8U);
}

TEST_F(MeshPersonTest, AMissingOrDamagedFileIsNamed) {
  const std::string base = "public/data/models/human_full_size.json";
  const auto whole = people.read_json(base);
  const auto spoilt = [&](const std::string& file, const nlohmann::json& json) {
    const nlohmann::json kept = people.read_json(file);
    people.write_json(file, json);
    std::string message = refusal();
    people.write_json(file, kept);
    return message;
  };
  auto too_few = whole["skinWeights"];
  too_few.erase(too_few.size() - 1);
  struct Fault {
    std::vector<std::pair<std::string, nlohmann::json>> changes;  // by JSON pointers
    std::string words;
  };
  const std::string joints = "/metadata/joint_pos_idxs/";
  const std::vector<Fault> faults = {
      {{{"/faces/1", 100000}}, "human_full_size.json"},
      {{{"/faces/0", 64}}, "human_full_size.json"},
      {{{"/skinIndices/0", 9999}}, "human_full_size.json"},
      {{{"/skinIndices/0", -2}}, "human_full_size.json"},
      {{{"/materials/1/DbgName", "skin"}}, "called body"},
      {{{"/bones/1/name", "finger7-1.L"},
        {joints + "finger7-1.L____head", nlohmann::json::array({0})},
        {joints + "finger7-1.L____tail", nlohmann::json::array({1})}},
       "number of bones"},
      {{{joints + "wrist.L____head", nlohmann::json::array()}}, "wrist.L____head is nowhere"},
      {{{"/skinWeights", too_few}}, "human_full_size.json"},
      {{{"/bones/0/parent", 77}}, "human_full_size.json"},
  };
  for (const auto& [changes, words] : faults) {
    auto changed = whole;
    for (const auto& [place, value] : changes) {
      changed[nlohmann::json::json_pointer(place)] = value;
    }
    EXPECT_TRUE(names(spoilt(base, changed), words)) << changes.front().first;
  }
  EXPECT_TRUE(names(spoilt(base, {{"vertices", "none"}}), "human_full_size.json"));
  EXPECT_TRUE(names(spoilt("public/data/proxies/hair/wig/wig.json", nlohmann::json::array()), "wig.json"));
  const std::string shapes = "src/json/targets/target-list.json";
  auto listed = people.read_json(shapes);
  listed["targets"]["data/targets/slimmer.target"] = listed["targets"]["data/targets/slim.target"];
  listed["targets"].erase("data/targets/slim.target");
  EXPECT_TRUE(names(spoilt(shapes, listed), "slim"));
  listed["targets"].erase("data/targets/slimmer.target");
  EXPECT_TRUE(names(spoilt(shapes, listed), "targets.bin"));
  MeshLook giant = TinyPeople::look();
  giant.tall = "slim";
  EXPECT_TRUE(names(message_of(ErrorKind::input, [&] { read_mesh_person(scratch.path(), giant); }), "slim"));

  const std::filesystem::path targets = scratch.path() / "public/data/targets/targets.bin";
  std::filesystem::resize_file(targets, 100);
  EXPECT_TRUE(names(refusal(), "targets.bin"));
  EXPECT_TRUE(names(message_of(ErrorKind::input,
                               [&] {
                                 const TinyPeople again(scratch.path() / "again");
                                 std::filesystem::remove(scratch.path() /
                                                         "again/public/data/skins/pale/pale.png");
                                 read_mesh_person(scratch.path() / "again", TinyPeople::look());
                               }),
                    "pale.png"));
  EXPECT_TRUE(names(message_of(ErrorKind::input, [&] { read_mesh_person("/nowhere", TinyPeople::look()); }),
                    "people.sh"));
}

}  // namespace
}  // namespace telemime
