// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/vmc_messages.h"

#include <lo/lo.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

#include "telemime/outputs/vrm_expressions.h"

namespace telemime {
namespace {

constexpr std::size_t kBundleHead = 16;  // "#bundle" and a time tag
constexpr std::size_t kSizeField = 4;
constexpr lo_timetag kAtOnce = {0U, 1U};

using MessagePtr = std::unique_ptr<void, decltype(&lo_message_free)>;

struct Message {
  const char* path;
  MessagePtr content;
  std::size_t size() const { return lo_message_length(content.get(), path); }
};

struct Place {
  Eigen::Vector3d position;
  Eigen::Quaterniond rotation;
};

/// liblo allocates by malloc and returns a copy of the bytes.
std::string taken(void* bytes, std::size_t size) {
  const std::unique_ptr<void, decltype(&std::free)> owner(bytes, std::free);
  if (bytes == nullptr) {
    throw std::bad_alloc();
  }
  return {static_cast<const char*>(bytes), size};
}

Message empty_message(const char* path) {
  Message message{path, MessagePtr(lo_message_new(), lo_message_free)};
  if (!message.content) {
    throw std::bad_alloc();
  }
  lo_message_incref(message.content.get());  // our reference; a bundle adds its own and releases it
  return message;
}

Message ok_message(bool tracking) {
  Message message = empty_message("/VMC/Ext/OK");
  const std::int32_t loaded = 1;
  const std::int32_t calibrated = 3;
  const std::int32_t mode = 0;
  for (const std::int32_t value : {loaded, calibrated, mode, tracking ? 1 : 0}) {
    lo_message_add_int32(message.content.get(), value);
  }
  return message;
}

Message time_message(double time) {
  Message message = empty_message("/VMC/Ext/T");
  lo_message_add_float(message.content.get(), static_cast<float>(time));
  return message;
}

/// A name and its place in Unity's frame: mirrored in the plane x = 0.
Message place_message(const char* path, const std::string& name, const Place& place) {
  Message message = empty_message(path);
  const auto& [p, q] = place;
  lo_message_add_string(message.content.get(), name.c_str());
  for (const double value : {-p.x(), p.y(), p.z(), q.x(), -q.y(), -q.z(), q.w()}) {
    lo_message_add_float(message.content.get(), static_cast<float>(value + 0.0));  // + 0.0: no -0
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
                std::vector<Message>& messages) {
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

void add_fingers(const FingerSkeleton& skeleton, const FingerRotations& fingers,
                 std::vector<Message>& messages) {
  for (std::size_t b = 0; b < kFingerBoneCount; ++b) {
    messages.push_back(place_message("/VMC/Ext/Bone/Pos", unity_name(kFingerBoneNames[b]),
                                     {skeleton.offset(b), fingers[b]}));
  }
}

void add_expressions(const FaceMotion& face, VmcExpressions names, std::vector<Message>& messages) {
  const auto add = [&messages](std::string_view name, double weight) {
    Message message = empty_message("/VMC/Ext/Blend/Val");
    lo_message_add_string(message.content.get(), std::string(name).c_str());
    lo_message_add_float(message.content.get(), static_cast<float>(weight));
    messages.push_back(std::move(message));
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
  messages.push_back(empty_message("/VMC/Ext/Blend/Apply"));
}

std::string bundle_of(const std::vector<const Message*>& messages) {
  // lo_bundle_free never releases the copies of the paths (liblo 0.31).
  const std::unique_ptr<void, decltype(&lo_bundle_free_recursive)> bundle(lo_bundle_new(kAtOnce),
                                                                          lo_bundle_free_recursive);
  if (!bundle) {
    throw std::bad_alloc();
  }
  for (const Message* message : messages) {
    lo_bundle_add_message(bundle.get(), message->path, message->content.get());
  }
  std::size_t size = 0;
  void* const bytes = lo_bundle_serialise(bundle.get(), nullptr, &size);
  return taken(bytes, size);
}

// As few bundles as there can be, each with the first `common` messages.
std::vector<std::string> bundled(const std::vector<Message>& messages, std::size_t common,
                                 std::size_t largest) {
  std::vector<const Message*> bundle;
  std::size_t size = kBundleHead;
  const auto add = [&](const Message& message) {
    bundle.push_back(&message);
    size += kSizeField + message.size();
  };
  const auto begin = [&] {
    bundle.clear();
    size = kBundleHead;
    std::for_each(messages.begin(), messages.begin() + static_cast<std::ptrdiff_t>(common), add);
  };
  begin();
  std::vector<std::string> datagrams;
  for (std::size_t i = common; i < messages.size(); ++i) {
    if (size + kSizeField + messages[i].size() > largest && bundle.size() > common) {
      datagrams.push_back(bundle_of(bundle));
      begin();
    }
    add(messages[i]);
  }
  datagrams.push_back(bundle_of(bundle));
  return datagrams;
}

std::vector<std::string> single(const std::vector<Message>& messages) {
  std::vector<std::string> datagrams;
  for (const Message& message : messages) {
    std::size_t size = 0;
    void* const bytes = lo_message_serialise(message.content.get(), message.path, nullptr, &size);
    datagrams.push_back(taken(bytes, size));
  }
  return datagrams;
}

}  // namespace

std::vector<std::string> vmc_datagrams(const HumanoidSkeleton& skeleton, const HumanoidMotion* motion,
                                       const FaceMotion* face, double time, const VmcOptions& options) {
  std::vector<Message> messages;
  messages.push_back(ok_message(motion != nullptr));
  messages.push_back(time_message(time));
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
  return options.bundles ? bundled(messages, common, options.largest) : single(messages);
}

}  // namespace telemime
