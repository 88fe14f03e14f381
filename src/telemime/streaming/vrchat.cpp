// SPDX-License-Identifier: Apache-2.0
// The OSC trackers of VRChat (docs.vrchat.com/docs/osc-trackers).
#include <algorithm>
#include <numbers>
#include <set>
#include <string_view>

#include "telemime/core/errors.h"
#include "telemime/outputs/euler.h"
#include "telemime/streaming/all.h"
#include "telemime/streaming/udp_link.h"

namespace telemime {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr const char* kExample = "vrchat://localhost:9000";

struct Tracker {
  std::string_view part;    ///< as in the option `trackers`; the head is always sent
  std::string_view number;  ///< in the address
  HumanBone place;          ///< whose joint is the position
  HumanBone turn;           ///< whose rotation is sent
};

constexpr std::array<Tracker, 7> kTrackers = {{
    {"", "head", HumanBone::head, HumanBone::head},
    {"hips", "1", HumanBone::hips, HumanBone::hips},
    {"chest", "2", HumanBone::chest, HumanBone::chest},
    {"elbows", "3", HumanBone::l_lower_arm, HumanBone::l_upper_arm},
    {"elbows", "4", HumanBone::r_lower_arm, HumanBone::r_upper_arm},
    {"hands", "5", HumanBone::l_hand, HumanBone::l_hand},
    {"hands", "6", HumanBone::r_hand, HumanBone::r_hand},
}};

struct VrchatOptions {
  bool bundles = true;
  std::set<std::string, std::less<>> parts = {""};
};

Eigen::Quaterniond in_world(const HumanoidMotion& motion, HumanBone bone) {
  Eigen::Quaterniond world = Eigen::Quaterniond::Identity();
  for (auto b = static_cast<int>(bone); b >= 0; b = kHumanBoneParent[static_cast<std::size_t>(b)]) {
    world = motion.rotation[static_cast<std::size_t>(b)] * world;
  }
  return world;
}

/// Unity's frame is the mirror image of VRM's in x. Its Euler angles turn about z first, then x, then y.
std::array<double, 3> unity_degrees(const Eigen::Quaterniond& q) {
  const Eigen::Quaterniond unity(q.w(), q.x(), -q.y(), -q.z());
  const auto [y, x, z] = decompose(unity.toRotationMatrix(), {1, 0, 2}, {0.0, 0.0, 0.0});
  return {kDegrees * x, kDegrees * y, kDegrees * z};
}

class VrchatLink final : public UdpLink {
 public:
  VrchatLink(SendLoop& loop, const SendUrl& url, VrchatOptions options)
      : UdpLink(loop, url, kVrchatPort), options_(std::move(options)) {}

 private:
  /// Nothing while the person is lost: VRChat keeps the trackers where they are.
  std::vector<std::string> datagrams(const HumanoidSkeleton& skeleton, const HumanoidMotion* motion,
                                     const MotionFrame& /*frame*/) override {
    if (motion == nullptr) {
      return {};
    }
    const auto joints = humanoid_joints(skeleton, *motion);
    std::vector<Osc> messages;
    for (const auto& [part, number, place, turn] : kTrackers) {
      if (!options_.parts.contains(part)) {
        continue;
      }
      const std::string address = "/tracking/trackers/" + std::string(number);
      const Eigen::Vector3d& at = joints[static_cast<std::size_t>(place)];
      messages.emplace_back(address + "/position").number(-at.x()).number(at.y()).number(at.z());
      const auto [x, y, z] = unity_degrees(in_world(*motion, turn));
      messages.emplace_back(address + "/rotation").number(x).number(y).number(z);
    }
    return options_.bundles ? osc_bundles(messages, 0, largest()) : osc_single(messages);
  }

  VrchatOptions options_;
};

/// The parts in "chest,elbows". Throws Error(usage).
void add_parts(const SendUrl& url, std::string_view list, VrchatOptions& options) {
  while (true) {
    const std::string_view part = list.substr(0, list.find(','));
    if (part.empty() || std::ranges::none_of(kTrackers, [&](const Tracker& t) { return t.part == part; })) {
      throw Error(ErrorKind::usage,
                  "the option \"trackers\" of \"" + url.text + "\" cannot have \"" + std::string(part) + "\"",
                  "It is one or more of hips, chest, elbows, hands, with commas between them.");
    }
    options.parts.emplace(part);
    if (part.size() == list.size()) {
      return;
    }
    list.remove_prefix(part.size() + 1);
  }
}

}  // namespace

std::unique_ptr<Sender> make_vrchat_sender(const SendUrl& url) {
  check_options(url, {"trackers", "bundle", "mirror"});
  check_no_path(url, kExample);
  VrchatOptions options;
  options.bundles = option(url, "bundle", {"1", "0"}) == "1";
  add_parts(url, find_option(url, "trackers").value_or("chest,elbows,hands"), options);
  return make_queued_sender(url,
                            [&](SendLoop& loop) { return std::make_unique<VrchatLink>(loop, url, options); });
}

}  // namespace telemime
