// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include <string>

#include "telemime/outputs/clean_frames.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

void append_cell(std::string& line, double value, int decimals) {
  line += ',';
  append_fixed(line, value, decimals);
}

class CsvEncoder final : public Encoder {
 public:
  std::string begin(const StreamHeader& /*header*/) override {
    std::string line = "frame,time_s,state";
    for (const auto name : kAngleNames) {
      line.append(",").append(name).append("_deg");
    }
    line += ",root_x_mm,root_y_mm,root_z_mm";
    for (std::size_t j = 1; j < kJointCount; ++j) {  // joint 0 is the root, whose position was written before
      for (const char* const axis : {"_x_mm", "_y_mm", "_z_mm"}) {
        line.append(",").append(kJointNames[j]).append(axis);
      }
    }
    for (const auto name : kJointNames) {
      line.append(",").append(name).append("_u_px,").append(name).append("_v_px");
    }
    for (const char* const hand : {",l_hand_", ",r_hand_"}) {
      line.append(hand).append("visibility").append(hand).append("spread_mm");
      for (const char* const name : {"wrist_twisting", "wrist_pivot", "wrist_flexion"}) {
        line.append(hand).append(name).append("_deg");
      }
      for (const auto name : kHandAngleNames) {
        line.append(hand).append(name).append("_deg");
      }
      for (const auto name : kHandJointNames) {
        for (const char* const axis : {"_x_mm", "_y_mm", "_z_mm"}) {
          line.append(hand).append(name).append(axis);
        }
      }
    }
    line += ",F,D_C,evaluations,face_confidence,head_qx,head_qy,head_qz,head_qw,gaze_left_deg,gaze_up_deg";
    for (const auto name : kExpressionNames) {
      line.append(",").append(name);
    }
    return line + "\n";
  }

  std::string frame(const MotionFrame& raw) override {
    const MotionFrame frame = clean_(raw);
    std::string line = std::to_string(frame.frame);
    append_cell(line, frame.time, 6);
    line += frame.state == TrackState::tracking ? ",tracking" : ",lost";
    for (const double angle : frame.pose.angles) {
      append_cell(line, angle * kDegreesPerRadian, 4);
    }
    append_place(line, frame.pose.root);
    for (std::size_t j = 1; j < kJointCount; ++j) {
      append_place(line, frame.joints.at[j]);
    }
    for (const auto& pixel : frame.pixels) {
      append_cell(line, pixel.x(), 3);
      append_cell(line, pixel.y(), 3);
    }
    append_hands(line, frame);
    append_cell(line, frame.region_score, 6);
    append_cell(line, frame.contour_score, 6);
    line.append(",").append(std::to_string(frame.evaluations));
    append_face(line, frame.face.value_or(FaceMotion{}));
    return line + "\n";
  }

 private:
  static void append_face(std::string& line, const FaceMotion& face) {
    append_cell(line, face.confidence, 3);
    for (const double value : {face.head.x(), face.head.y(), face.head.z(), face.head.w()}) {
      append_cell(line, value, 6);
    }
    for (const double angle : face.gaze) {
      append_cell(line, angle * kDegreesPerRadian, 2);
    }
    for (const double value : face.expressions) {
      append_cell(line, value, 3);
    }
  }

  static void append_place(std::string& line, const Eigen::Vector3d& place) {
    for (const double value : place) {
      append_cell(line, value * kMillimetresPerMetre, 2);
    }
  }

  // Empty cells where hands are not tracked.
  static void append_hands(std::string& line, const MotionFrame& frame) {
    constexpr std::size_t kCells = 2 + 3 + kHandAngleCount + 3 * kHandJointCount;
    if (!frame.hands) {
      line.append(2 * kCells, ',');
      return;
    }
    for (const HandMotion& hand : *frame.hands) {
      append_cell(line, hand.visibility, 3);
      append_cell(line, hand.spread * kMillimetresPerMetre, 2);
      for (const double angle : {hand.wrist.twisting, hand.wrist.pivot, hand.wrist.flexion}) {
        append_cell(line, angle * kDegreesPerRadian, 4);
      }
      for (const double angle : hand.angles) {
        append_cell(line, angle * kDegreesPerRadian, 2);
      }
      for (const Eigen::Vector3d& joint : hand.joints) {
        append_place(line, joint);
      }
    }
  }

  CleanFrames clean_;
};

}  // namespace

std::unique_ptr<Encoder> make_csv_encoder() {
  return std::make_unique<CsvEncoder>();
}

}  // namespace telemime
