// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lab/synth/actor.h"
#include "lab/synth/sdf.h"
#include "telemime/core/random.h"

namespace telemime {

enum class HairStyle : std::uint8_t { cap, short_hair, bob };

/// What the synthetic person looks like. Colours are linear light, red green blue, in [0, 1].
struct Look {
  ActorBuild build;
  Eigen::Vector3f skin{0.62f, 0.36f, 0.25f};
  Eigen::Vector3f shirt{0.04f, 0.20f, 0.45f};
  Eigen::Vector3f shirt2{0.60f, 0.60f, 0.58f};  ///< second colour of the stripes
  Eigen::Vector3f trousers{0.03f, 0.035f, 0.05f};
  Eigen::Vector3f hair{0.02f, 0.014f, 0.01f};
  Eigen::Vector3f eyes{0.06f, 0.04f, 0.03f};
  HairStyle style = HairStyle::short_hair;
  bool striped = false;
  double sleeve = 0.58;       ///< end of the sleeve: 0 shoulder, 1 elbow, 2 wrist
  double bust = 0.0;          ///< 0 flat ... 1
  float face_width = 1.0f;    ///< against the average
  float jaw = 1.0f;           ///< width of the jaw against the average
  std::uint32_t texture = 0;  ///< seed of the cloth's and skin's mottling
  int shirt_index = 0;        ///< which entry of the palette the shirt is
};

/// A colour given as sRGB-like 0..255 values, to linear light with the gamma of 2 that the renderer uses.
Eigen::Vector3f linear_colour(float red, float green, float blue);

/// Draws a look. The shirts avoid the hues of skin.
Look random_look(Random& random);

/// The head in its own frame: origin at the skull base, x to the person's own left, y up, z forward, metres
/// of a head whose crown is 0.147 m above the skull base. The face has the proportions of an average face.
struct AvatarHead {
  float width = 1.0f;
  float jaw = 1.0f;
  HairStyle style = HairStyle::short_hair;
};
inline constexpr float kHeadCrown = 0.147f;  ///< m above the skull base, hair not counted
inline constexpr float kHeadReach = 0.185f;  ///< m from (0, 0.035, 0): nothing of head and cap lies farther

/// Distance (m) to the skin of the head: skull, jaw, brow, nose, eyeballs, lips, ears.
float face_distance(const AvatarHead& head, const Eigen::Vector3f& p);

/// Distance (m) to the hair.
float hair_distance(const AvatarHead& head, const Eigen::Vector3f& p);

/// Colour (linear light) of the skin of the head at a point on its surface: brows, eyes, lids, lips and blush
/// are painted, as a frontal face detector needs them.
Eigen::Vector3f face_colour(const Look& look, const Eigen::Vector3f& p);

/// A hand in its own frame: origin at the wrist, x toward the thumb, y along the fingers, z out of the back;
/// metres of a hand whose middle knuckle is 0.092 m from the wrist.
struct HandShape {
  std::array<RoundCone, 5> palm;                    ///< metacarpals, the ball of the thumb
  std::array<std::array<RoundCone, 3>, 4> fingers;  ///< index to little finger, from the knuckle on
  std::array<RoundCone, 2> thumb;
};
inline constexpr float kHandKnuckle = 0.092f;
inline constexpr float kHandReach = 0.115f;  ///< m from (0, 0.085, 0): no part of the hand lies farther

HandShape hand_shape(const FingerCurls& curl);

/// The 21 joints of a hand (telemime/body/hand_model.h), in its frame.
std::array<Eigen::Vector3f, 21> hand_joints(const HandShape& hand);

/// Distance (m) to the surface of the hand.
float distance(const HandShape& hand, const Eigen::Vector3f& p);

/// What a pixel shows.
enum class Surface : std::uint8_t { background, head, arm, shirt, hair, trousers };

/// Cuts a part off where (p - at) . normal > 0, camera frame; used for hems.
struct Hem {
  Eigen::Vector3f at{0.0f, 0.0f, 0.0f};
  Eigen::Vector3f normal{0.0f, 0.0f, 0.0f};  ///< zero: no cut
};

/// One piece of the body with the ball that bounds it.
struct BodyPart {
  enum class Kind : std::uint8_t { limb, torso, head, hair, hand };
  Kind kind = Kind::limb;
  Surface surface = Surface::arm;
  std::uint8_t chain = 0;  ///< parts of one chain flow into each other, parts of different chains do not
  float blend = 0.02f;     ///< m, how softly
  Eigen::Vector3f centre{0.0f, 0.0f, 0.0f};  ///< of the bounding ball, camera frame, m
  float radius = 0.0f;
  /// Camera frame to the part's own: local = rotation (p - origin) / scale. Limbs: y along the bone.
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();
  Eigen::Vector3f origin{0.0f, 0.0f, 0.0f};
  float scale = 1.0f;
  std::vector<RoundCone> cones;  ///< limb: camera frame; torso: shoulders and chest in its own frame
  Hem hem;
  HandShape hand;
};

/// The person of one frame: a body of smoothly joined solids, made for this program and unlike the tracker's.
/// Parts of a chain follow each other.
struct Avatar {
  Look look;
  AvatarHead head;
  float girth = 1.0f;
  std::vector<BodyPart> parts;
};

/// Builds the body around the bones.
Avatar make_avatar(const Look& look, const ActorKinematics& kinematics);

/// The parts that a ray or a point can meet; a cheap subset for many distance queries.
struct PartSelection {
  static constexpr std::size_t kMost = 24;
  std::array<const BodyPart*, kMost> parts{};
  std::size_t count = 0;
  float near = 0.0f;  ///< along the ray: nothing of the parts lies before ...
  float far = 0.0f;   ///< ... or behind these, m
};

/// Parts whose bounding ball, grown by `margin` (m), meets the ray; `direction` of length 1.
PartSelection parts_along(const Avatar& avatar, const Eigen::Vector3f& origin,
                          const Eigen::Vector3f& direction, float margin);

/// Parts whose bounding ball lies within `margin` (m) of the point.
PartSelection parts_near(const Avatar& avatar, const Eigen::Vector3f& point, float margin);

struct BodySample {
  float distance = 1e9f;  ///< m; a lower bound away from the surface
  const BodyPart* part = nullptr;
};

/// Distance from p (camera frame) to the nearest surface of the selected parts, and the part it belongs to.
BodySample sample_body(const Avatar& avatar, const PartSelection& selection, const Eigen::Vector3f& p);

/// Colour of the surface, linear light.
Eigen::Vector3f surface_colour(const Avatar& avatar, const BodyPart& part, const Eigen::Vector3f& p);

}  // namespace telemime
