// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include <string>

#include "telemime/outputs/finite.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

constexpr std::size_t kCountWidth = 9;
constexpr int kDecimals = 3;

class TrcEncoder final : public Encoder {
 public:
  std::string begin(const StreamHeader& header) override {
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
    between_counts_ = "\t" + std::to_string(kJointCount) + "\tmm\t" + rate + "\t1\t";
    text += counts() + "\nFrame#\tTime\t";
    for (const auto name : kJointNames) {
      text.append(name).append("\t\t\t");
    }
    text += "\n\t\t";
    for (std::size_t j = 1; j <= kJointCount; ++j) {
      for (const char axis : {'X', 'Y', 'Z'}) {
        text += axis + std::to_string(j) + "\t";
      }
    }
    return text + "\n\n";
  }

  std::string frame(const MotionFrame& raw) override {
    const MotionFrame frame = finite_(raw);
    if (count_ == 0) {
      start_ = frame.time;
    }
    ++count_;
    std::string line = std::to_string(count_) + "\t";
    append_fixed(line, frame.time - start_, 6);
    line += '\t';
    for (const Eigen::Vector3d& joint : frame.joints.at) {
      for (const double value : {joint.x(), -joint.y(), -joint.z()}) {
        if (frame.state == TrackState::tracking) {
          append_fixed(line, kMillimetresPerMetre * value, kDecimals);
        }
        line += '\t';
      }
    }
    return line + "\n";
  }

  std::optional<Patch> patch() const override { return Patch{counts_offset_, counts()}; }

 private:
  /// The head contains the number of frames twice.
  std::string counts() const {
    return padded_count(count_, kCountWidth) + between_counts_ + padded_count(count_, kCountWidth);
  }

  FiniteFrames finite_;
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
