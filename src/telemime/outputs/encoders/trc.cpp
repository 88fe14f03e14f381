// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include <string>
#include <utility>
#include <vector>

#include "telemime/outputs/clean_frames.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

constexpr std::size_t kCountWidth = 9;
constexpr int kDecimals = 3;

class TrcEncoder final : public Encoder {
 public:
  std::string begin(const StreamHeader& header) override {
    fingers_ = header.fingers;
    std::vector<std::string> names(kJointNames.begin(), kJointNames.end());
    for (const char* const hand : {"l_hand_", "r_hand_"}) {
      for (std::size_t j = 1; fingers_ && j < kHandJointCount; ++j) {  // joint 0 is the wrist
        names.push_back(hand + std::string(kHandJointNames[j]));
      }
    }
    const std::string rate = [&] {
      std::string text;
      append_fixed(text, header.fps, 3);
      return text;
    }();
    std::string text = "PathFileType\t4\t(X/Y/Z)\tmotion.trc\n";
    text +=
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames"
        "\n";
    text += rate + "\t" + rate + "\t";
    counts_offset_ = text.size();
    between_counts_ = "\t" + std::to_string(names.size()) + "\tmm\t" + rate + "\t1\t";
    text += counts() + "\nFrame#\tTime\t";
    for (const std::string& name : names) {
      text.append(name).append("\t\t\t");
    }
    text += "\n\t\t";
    for (std::size_t j = 1; j <= names.size(); ++j) {
      for (const char axis : {'X', 'Y', 'Z'}) {
        text += axis + std::to_string(j) + "\t";
      }
    }
    return text + "\n\n";
  }

  std::string frame(const MotionFrame& raw) override {
    const MotionFrame frame = clean_(raw);
    if (count_ == 0) {
      start_ = frame.time;
    }
    ++count_;
    std::string line = std::to_string(count_) + "\t";
    append_fixed(line, frame.time - start_, 6);
    line += '\t';
    const bool tracked = frame.state == TrackState::tracking;
    for (const Eigen::Vector3d& joint : frame.joints.at) {
      append_marker(line, tracked ? &joint : nullptr);
    }
    for (std::size_t side = 0; fingers_ && side < 2; ++side) {
      const HandMotion* const hand = tracked && frame.hands ? &(*frame.hands)[side] : nullptr;
      for (std::size_t j = 1; j < kHandJointCount; ++j) {
        append_marker(line, hand != nullptr && hand->visibility > 0.0 ? &hand->joints[j] : nullptr);
      }
    }
    return line + "\n";
  }

  std::optional<Patch> patch() const override { return Patch{counts_offset_, counts()}; }

 private:
  /// Three empty cells for a marker that is not seen.
  static void append_marker(std::string& line, const Eigen::Vector3d* place) {
    for (const auto& [axis, sign] : {std::pair(0, 1.0), {1, -1.0}, {2, -1.0}}) {
      if (place != nullptr) {
        append_fixed(line, kMillimetresPerMetre * sign * (*place)[axis], kDecimals);
      }
      line += '\t';
    }
  }

  /// The head contains the number of frames twice.
  std::string counts() const {
    return padded_count(count_, kCountWidth) + between_counts_ + padded_count(count_, kCountWidth);
  }

  CleanFrames clean_;
  bool fingers_ = false;
  std::size_t count_ = 0;
  double start_ = 0.0;
  std::size_t counts_offset_ = 0;
  std::string between_counts_;
};

}  // namespace

std::unique_ptr<Encoder> make_trc_encoder() {
  return std::make_unique<TrcEncoder>();
}

}  // namespace telemime
