// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/vmc_messages.h"

#include <cctype>
#include <cstdint>
#include <utility>

#include "telemime/outputs/vrm_expressions.h"

namespace telemime {
namespace {

struct Place {
  Eigen::Vector3d position;
  Eigen::Quaterniond rotation;
};

Osc ok_message(bool tracking) {
  const std::int32_t loaded = 1;
  const std::int32_t calibrated = 3;
  const std::int32_t mode = 0;
  Osc message("/VMC/Ext/OK");
  for (const std::int32_t value : {loaded, calibrated, mode, tracking ? 1 : 0}) {
    message.integer(value);
  }
  return message;
}

/// A name and its place in Unity's frame: mirrored in the plane x = 0.
Osc place_message(const char* path, const std::string& name, const Place& place) {
  const auto& [p, q] = place;
  Osc message(path);
  message.text(name);
  for (const double value : {-p.x(), p.y(), p.z(), q.x(), -q.y(), -q.z(), q.w()}) {
    message.number(value);
  }
  return message;
}

/// Unity's HumanBodyBones are VRM's names with a capital letter, but for the thumbs.
std::string unity_name(std::string_view vrm) {
  std::string name(vrm);
  for (const auto& [from, to] :
       {std::pair("ThumbProximal", "ThumbIntermediate"), std::pair("ThumbMetacarpal", "ThumbProximal")}) {
    if (name.ends_with(from)) {
      name.replace(name.find("Thumb"), std::string::npos, to);
      break;
    }
  }
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

// Receivers that apply positions need the length of each bone.
const HumanoidSkeleton& average_skeleton() {
  static const HumanoidSkeleton skeleton = humanoid_skeleton(make_body(Shape()));
  return skeleton;
}

void add_places(const HumanoidSkeleton& skeleton, const HumanoidMotion& motion, const VmcOptions& options,
                std::vector<Osc>& messages) {
  const Eigen::Vector3d rest = skeleton.offset(HumanBone::hips);
  const Eigen::Vector3d moved = motion.hips - rest;
  const Eigen::Vector3d still = Eigen::Vector3d::Zero();
  messages.push_back(place_message("/VMC/Ext/Root/Pos", "root",
                                   {options.root_moves ? moved : still, Eigen::Quaterniond::Identity()}));
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    const auto bone = static_cast<HumanBone>(b);
    Eigen::Vector3d position = (options.all_positions ? skeleton : average_skeleton()).offset(bone);
    if (bone == HumanBone::hips) {
      position = options.root_moves ? rest : motion.hips;
    }
    messages.push_back(
        place_message("/VMC/Ext/Bone/Pos", unity_name(kHumanBoneNames[b]), {position, motion.rotation[b]}));
  }
}

void add_fingers(const FingerSkeleton& skeleton, const FingerRotations& fingers, std::vector<Osc>& messages) {
  for (std::size_t b = 0; b < kFingerBoneCount; ++b) {
    messages.push_back(place_message("/VMC/Ext/Bone/Pos", unity_name(kFingerBoneNames[b]),
                                     {skeleton.offset(b), fingers[b]}));
  }
}

void add_expressions(const FaceMotion& face, VmcExpressions names, std::vector<Osc>& messages) {
  const auto add = [&messages](std::string_view name, double weight) {
    messages.emplace_back("/VMC/Ext/Blend/Val").text(std::string(name)).number(weight);
  };
  if (names == VmcExpressions::arkit) {
    for (std::size_t i = 0; i < kExpressionCount; ++i) {
      add(kExpressionNames[i], face.expressions[i]);
    }
  } else {
    const auto weights = vrm_expressions(face);
    for (std::size_t i = 0; i < kVrmExpressionCount; ++i) {
      add(names == VmcExpressions::vrm0 ? kVrm0ExpressionNames[i] : kVrmExpressionNames[i], weights[i]);
    }
  }
  messages.emplace_back("/VMC/Ext/Blend/Apply");
}

}  // namespace

std::vector<std::string> vmc_datagrams(const HumanoidSkeleton& skeleton, const HumanoidMotion* motion,
                                       const FaceMotion* face, double time, const VmcOptions& options) {
  std::vector<Osc> messages;
  messages.push_back(ok_message(motion != nullptr));
  messages.emplace_back("/VMC/Ext/T").number(time);
  const std::size_t common = messages.size();
  if (motion != nullptr) {
    add_places(skeleton, *motion, options, messages);
    if (motion->fingers) {
      add_fingers((options.all_positions ? skeleton : average_skeleton()).fingers.value(), *motion->fingers,
                  messages);
    }
  }
  if (face != nullptr) {
    add_expressions(*face, options.expressions, messages);
  }
  return options.bundles ? osc_bundles(messages, common, options.largest) : osc_single(messages);
}

}  // namespace telemime
