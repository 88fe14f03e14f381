// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include <algorithm>
#include <array>
#include <string>

#include "telemime/body/rotations.h"
#include "telemime/outputs/bvh/skeleton.h"
#include "telemime/outputs/euler.h"
#include "telemime/outputs/finite.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

constexpr std::size_t kCountWidth = 10;
constexpr int kDecimals = 4;  // cm and degrees
constexpr AxisOrder kOrder = {2, 0, 1};
constexpr std::array<const char*, 6> kChannelNames = {"Xposition", "Yposition", "Zposition",
                                                      "Xrotation", "Yrotation", "Zrotation"};

void append_offset(std::string& text, const std::string& indent, const Eigen::Vector3d& offset) {
  text += indent + "OFFSET";
  for (const double value : offset) {
    text += ' ';
    append_fixed(text, value, kDecimals);
  }
  text += '\n';
}

void append_joint(std::string& text, const std::vector<BvhJoint>& joints, std::size_t index,
                  std::size_t depth) {
  const std::string outer(depth, '\t');
  const std::string inner(depth + 1, '\t');
  const BvhJoint& joint = joints[index];
  text += outer + (joint.parent < 0 ? "ROOT " : "JOINT ") + joint.name + "\n" + outer + "{\n";
  append_offset(text, inner, joint.offset);
  text += inner + "CHANNELS " + std::to_string(joint.channels.size());
  for (const BvhChannel channel : joint.channels) {
    text.append(" ").append(kChannelNames[static_cast<std::size_t>(channel)]);
  }
  text += '\n';
  for (std::size_t child = index + 1; child < joints.size(); ++child) {
    if (joints[child].parent == static_cast<int>(index)) {
      append_joint(text, joints, child, depth + 1);
    }
  }
  if (joint.end_site) {
    text += inner + "End Site\n" + inner + "{\n";
    append_offset(text, inner + "\t", *joint.end_site);
    text += inner + "}\n";
  }
  text += outer + "}\n";
}

class BvhEncoder final : public Encoder {
 public:
  std::string begin(const StreamHeader& header) override {
    body_ = header.body;
    std::string text = "HIERARCHY\n";
    append_joint(text, bvh_skeleton(body_), 0, 0);
    text += "MOTION\nFrames: ";
    count_offset_ = text.size();
    text += padded_count(0, kCountWidth) + "\nFrame Time: ";
    append_fixed(text, 1.0 / header.fps, 8);
    return text + "\n";
  }

  std::string frame(const MotionFrame& raw) override {
    const MotionFrame frame = finite_(raw);
    BvhMotion motion = bvh_motion(body_, frame.pose);
    if (frame.face) {
      turn_head(*frame.face, motion);
    }
    std::string text;
    for (const double value : motion.hips) {
      append_fixed(text, value, kDecimals);
      text += ' ';
    }
    for (std::size_t bone = 0; bone < kBvhBoneCount; ++bone) {
      EulerAngles& last = last_[bone];
      const EulerAngles angles = decompose(motion.parent_from_bone[bone], kOrder, last);
      for (std::size_t i = 0; i < 3; ++i) {
        // Continuing beyond 180 degrees keeps programs that interpolate between frames from spinning the bone
        // back.
        last[i] += wrap_angle(angles[i] - last[i]);
        append_fixed(text, last[i] * kDegreesPerRadian, kDecimals);
        text += ' ';
      }
    }
    ++count_;
    text.back() = '\n';
    return text;
  }

  std::optional<Patch> patch() const override {
    return Patch{count_offset_, padded_count(count_, kCountWidth)};
  }

 private:
  Body body_;
  FiniteFrames finite_;
  std::array<EulerAngles, kBvhBoneCount> last_{};
  std::size_t count_ = 0;
  std::size_t count_offset_ = 0;
};

}  // namespace

std::unique_ptr<Encoder> make_bvh_encoder() {
  return std::make_unique<BvhEncoder>();
}

}  // namespace telemime
