// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include <algorithm>
#include <string>

#include "telemime/outputs/bap/fingers.h"
#include "telemime/outputs/bap/profile.h"
#include "telemime/outputs/clean_frames.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

constexpr std::size_t kCountWidth = 9;
constexpr std::string_view kName = "motion.bap";

/// "25", or "29.970" when it is not whole.
std::string frame_rate(double fps) {
  std::string text;
  append_fixed(text, fps, fps == std::round(fps) ? 0 : 3);
  return text;
}

class BapEncoder final : public Encoder {
 public:
  explicit BapEncoder(const BapProfile& profile) : profile_(profile) {}

  std::string begin(const StreamHeader& header) override {
    fingers_ = header.fingers;
    mask_.clear();
    const auto ids = bap_ids(profile_);
    const auto& finger_ids = finger_bap_ids();
    for (int id = 1; id <= profile_.mask_length; ++id) {
      const bool sent = std::binary_search(ids.begin(), ids.end(), id) ||
                        (fingers_ && std::binary_search(finger_ids.begin(), finger_ids.end(), id));
      mask_ += sent ? "1" : "0";
      mask_ += id < profile_.mask_length ? " " : "\n";
    }
    std::string text =
        std::string(profile_.version) + " " + std::string(kName) + " " + frame_rate(header.fps) + " ";
    count_offset_ = text.size();
    return text + padded_count(0, kCountWidth) + "\n";
  }

  std::string frame(const MotionFrame& raw) override {
    const MotionFrame frame = clean_(raw);
    const Pose pose = frame.hands ? with_wrists(frame.pose, *frame.hands) : frame.pose;
    last_ = encode_bap(profile_, pose, last_);
    std::string text = mask_ + std::to_string(frame.frame);
    for (const int value : last_) {
      text += " " + std::to_string(value);
    }
    if (fingers_ && frame.hands) {
      last_fingers_ = encode_bap_fingers(profile_, *frame.hands, last_fingers_);
    }
    for (std::size_t i = 0; fingers_ && i < kFingerBapCount; ++i) {
      text += " " + std::to_string(last_fingers_[i]);
    }
    ++count_;
    return text + "\n";
  }

  std::optional<Patch> patch() const override {
    return Patch{count_offset_, padded_count(count_, kCountWidth)};
  }

 private:
  const BapProfile& profile_;
  std::string mask_;
  CleanFrames clean_;
  bool fingers_ = false;
  BapValues last_{};
  FingerBapValues last_fingers_{};
  std::size_t count_ = 0;
  std::size_t count_offset_ = 0;
};

}  // namespace

std::unique_ptr<Encoder> make_bap_encoder(std::string_view profile) {
  return std::make_unique<BapEncoder>(bap_profile(profile));
}

}  // namespace telemime
