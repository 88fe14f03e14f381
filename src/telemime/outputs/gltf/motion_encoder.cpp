// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "telemime/outputs/all.h"
#include "telemime/outputs/clean_frames.h"
#include "telemime/outputs/gltf/humanoid.h"
#include "telemime/outputs/gltf/keys.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

constexpr std::size_t kFirstSnapshot = 32;
/// Space in the JSON for numbers that get longer: some 150 by at most 9 digits each, the places of 30 finger
/// bones, and the position of the origin.
constexpr std::size_t kRoomToGrow = 4096;

class GltfMotionEncoder final : public Encoder {
 public:
  explicit GltfMotionEncoder(bool mannequin) : mannequin_(mannequin) {}

  std::string begin(const StreamHeader& header) override {
    HumanoidSkeleton skeleton = humanoid_skeleton(header.body);
    if (!header.fingers) {
      skeleton.fingers.reset();
    }
    fixed_ = make_gltf();
    add_humanoid(fixed_, skeleton);
    std::optional<std::size_t> face;
    if (mannequin_) {
      const std::size_t mesh = add_mannequin(fixed_, skeleton, header.body.shape.stature);
      add_skinned_mesh(fixed_, "mannequin", mesh, add_humanoid_skin(fixed_, skeleton));
    } else {
      fixed_.json["extensionsUsed"] = {"VRMC_vrm_animation"};
      face = add_face_nodes(fixed_);
      fixed_.json["extensions"]["VRMC_vrm_animation"] = {
          {"specVersion", "1.0"},
          {"humanoid", {{"humanBones", human_bones(skeleton)}}},
          {"expressions", animated_expressions(*face)},
          {"lookAt", animated_look_at(*face)}};
    }
    keys_.emplace(header.body, header.fingers, face);
    written_ = fixed_.buffer.size();
    const std::string first = snapshot();
    return head_ + fixed_.buffer + first;
  }

  std::string frame(const MotionFrame& raw) override {
    head_changed_ = false;
    keys_->add(clean_(raw));
    ++frames_;
    return keys_->count() >= next_snapshot_ ? snapshot() : std::string();
  }

  std::string end() override { return frames_ > 0 ? snapshot() : std::string(); }

  std::optional<Patch> patch() const override {
    return head_changed_ ? std::optional(Patch{0, head_}) : std::nullopt;
  }

 private:
  /// All keys so far, to be appended; updates the head to refer to them.
  std::string snapshot() {
    GltfDocument document;
    document.json = fixed_.json;
    keys_->add_animation(document);
    if (keys_->fingers()) {
      set_fingers(document, *keys_->fingers());
    }
    // The new accessors lie behind everything that was written before.
    const std::size_t first_view =
        fixed_.json.contains("bufferViews") ? fixed_.json["bufferViews"].size() : 0;
    for (std::size_t v = first_view; v < document.json["bufferViews"].size(); ++v) {
      auto& offset = document.json["bufferViews"][v]["byteOffset"];
      offset = offset.get<std::size_t>() + written_;
    }
    if (const auto& origin = keys_->origin()) {
      const Eigen::Vector3d place = kMillimetresPerMetre * *origin;
      document.json["asset"]["extras"]["root_at_start_mm"] = {rounded(place.x(), 2), rounded(place.y(), 2),
                                                              rounded(place.z(), 2)};
    }
    written_ += document.buffer.size();
    const std::size_t size = head_.empty() ? glb_head(document, written_).size() + kRoomToGrow : json_size_;
    json_size_ = size;
    head_ = glb_head(document, written_, size);
    head_changed_ = true;
    next_snapshot_ = std::max(kFirstSnapshot, 2 * keys_->count());
    return std::move(document.buffer);
  }

  bool mannequin_;      ///< shows the motion; otherwise VRM animation
  GltfDocument fixed_;  ///< the constant part: skeleton and mannequin
  std::optional<MotionKeys> keys_;
  CleanFrames clean_;
  std::string head_;           ///< always of the same size
  bool head_changed_ = false;  ///< with the last frame, or at the end
  std::size_t json_size_ = 0;  ///< of the JSON chunk
  std::size_t written_ = 0;    ///< bytes of the binary chunk
  std::size_t next_snapshot_ = kFirstSnapshot;
  std::size_t frames_ = 0;
};

}  // namespace

std::unique_ptr<Encoder> make_glb_encoder() {
  return std::make_unique<GltfMotionEncoder>(/*mannequin=*/true);
}

std::unique_ptr<Encoder> make_vrma_encoder() {
  return std::make_unique<GltfMotionEncoder>(/*mannequin=*/false);
}

}  // namespace telemime
