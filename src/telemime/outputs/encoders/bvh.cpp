// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include <algorithm>
#include <array>
#include <string>

#include "telemime/body/rotations.h"
#include "telemime/outputs/bvh/skeleton.h"
#include "telemime/outputs/clean_frames.h"
#include "telemime/outputs/euler.h"
#include "telemime/outputs/humanoid.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

constexpr std::size_t kCountWidth = 10;
constexpr std::size_t kOffsetWidth = 10;  // the head is patched: its size must not change
constexpr int kDecimals = 4;              // cm and degrees
constexpr AxisOrder kOrder = {2, 0, 1};   // as in CHANNELS

void append_offset(std::string& text, const std::string& indent, const Eigen::Vector3d& offset) {
  text += indent + "OFFSET";
  for (const double value : offset) {
    std::string number;
    append_fixed(number, value, kDecimals);
    // More decimals rather than spaces, which some readers take for empty values.
    number.append(std::max(kOffsetWidth, number.size()) - number.size(), '0');
    text.append(" ").append(number);
  }
  text += '\n';
}

/// `order` gets the indices of the joints as they stand in the file.
void append_joint(std::string& text, const std::vector<BvhJoint>& joints, std::size_t index,
                  std::size_t depth, std::vector<std::size_t>& order) {
  order.push_back(index);
  const std::string outer(depth, '\t');
  const std::string inner(depth + 1, '\t');
  const BvhJoint& joint = joints[index];
  text += outer + (joint.parent < 0 ? "ROOT " : "JOINT ") + joint.name + "\n" + outer + "{\n";
  append_offset(text, inner, joint.offset);
  text += inner + (joint.parent < 0 ? "CHANNELS 6 Xposition Yposition Zposition" : "CHANNELS 3") +
          " Zrotation Xrotation Yrotation\n";
  for (std::size_t child = index + 1; child < joints.size(); ++child) {
    if (joints[child].parent == static_cast<int>(index)) {
      append_joint(text, joints, child, depth + 1, order);
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
    fps_ = header.fps;
    if (header.fingers) {
      fingers_ = humanoid_skeleton(body_).fingers;
      turned_.fill(Eigen::Quaterniond::Identity());
    }
    return head(order_);
  }

  std::string frame(const MotionFrame& raw) override {
    const MotionFrame frame = clean_(raw);
    BvhMotion motion = bvh_motion(body_, frame.hands ? with_wrists(frame.pose, *frame.hands) : frame.pose);
    // A lost frame keeps the head as it keeps the body.
    face_ = frame.state == TrackState::tracking ? frame.face : face_;
    if (face_) {
      turn_head(*face_, motion);
    }
    if (fingers_ && frame.hands) {
      fingers_ = finger_skeleton(*frame.hands);
      turned_ = finger_bone_rotations(*frame.hands);
    }
    std::string text;
    for (const double value : motion.hips) {
      append_fixed(text, value, kDecimals);
      text += ' ';
    }
    for (const std::size_t bone : order_) {
      EulerAngles& last = last_[bone];
      const EulerAngles angles = decompose(
          bone < kBvhBoneCount ? motion.parent_from_bone[bone] : turned_[bone - kBvhBoneCount].matrix(),
          kOrder, last);
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

  // The lengths of the fingers are learned while the person is tracked: those of the last frame stay.
  std::optional<Patch> patch() const override {
    std::vector<std::size_t> order;
    return Patch{0, head(order)};
  }

 private:
  /// `order` gets the bones as they stand in the file.
  std::string head(std::vector<std::size_t>& order) const {
    std::string text = "HIERARCHY\n";
    append_joint(text, bvh_skeleton(body_, fingers_), 0, 0, order);
    text += "MOTION\nFrames: " + padded_count(count_, kCountWidth) + "\nFrame Time: ";
    append_fixed(text, 1.0 / fps_, 8);
    return text + "\n";
  }

  Body body_;
  double fps_ = 25.0;
  CleanFrames clean_;
  std::optional<FaceMotion> face_;  ///< of the last tracked frame
  std::optional<FingerSkeleton> fingers_;
  FingerRotations turned_;
  std::array<EulerAngles, kBvhBoneCount + kFingerBoneCount> last_{};
  std::vector<std::size_t> order_;
  std::size_t count_ = 0;
};

}  // namespace

std::unique_ptr<Encoder> make_bvh_encoder() {
  return std::make_unique<BvhEncoder>();
}

}  // namespace telemime
