// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "meeting/protocol/pose_detail.h"
#include "meeting/protocol/pose_frame.h"
#include "telemime/body/motion_frame.h"
#include "telemime/outputs/humanoid.h"

namespace telemime::meeting {

/// The bones that the tracker estimates: hips to hands. Legs are left out because they do not move.
inline constexpr std::uint32_t kTrackedBones = (1U << static_cast<unsigned>(HumanBone::l_upper_leg)) - 1U;

/// The confidence of a bone with this standard deviation (m, >= 0): 15 up to 20 mm, 1 from 200 mm, linear in
/// between.
std::uint8_t confidence_of(double deviation);

/// The pose frame of a tracked person, without session, sequence and time. The confidence of a bone is that
/// of the joint that it moves (spine and chest: neck; lower arm: wrist; hand: middle knuckle; hips: root),
/// whose standard deviation is sqrt(trace(covariance) / 3); without a spread it is 0. The position of the
/// hips is limited to +-32 m.
PoseFrame pose_frame_of(const HumanoidMotion& motion, const std::optional<PoseSpread>& spread);

/// The fingers and the face of that person, without session and sequence: what `motion` and `face` have.
PoseDetail pose_detail_of(const HumanoidMotion& motion, const std::optional<FaceMotion>& face);

/// Frames per second that each participant publishes: 300 / participants, limited to [5, 30], so that
/// everyone receives about 300 frames per second.
double publish_rate(std::size_t participants);

/// Frames per second of a participant who does not move.
inline constexpr double kStillRate = 2.0;

/// A pose frame with its detail.
struct DetailedFrame {
  DetailedFrame(PoseFrame frame = {}, const PoseDetail& rest = {}) : pose(std::move(frame)), detail(rest) {}
  PoseFrame pose;
  PoseDetail detail;
};

/// Whether a person did not move between two frames: the same bones, none rotated by more than 0.3 degrees,
/// the hips moved by less than 3 mm, no finger bone turned by more than 2 degrees about an axis, no weight of
/// the face changed by more than 0.02 and the gaze by no more than 1 degree.
bool is_still(const DetailedFrame& before, const DetailedFrame& now);

/// Limits the rate of frames: evenly spaced slots, and a frame at most one slot early. Times are s of one
/// clock.
class PublishPace {
 public:
  /// Sets the number of participants, including oneself.
  void set_participants(std::size_t count) { rate_ = publish_rate(count); }
  /// Whether the person did not move since the last published frame.
  bool still(const DetailedFrame& frame) const { return last_ && is_still(*last_, frame); }
  /// The earliest time to publish this frame; far in the past for the first one.
  double due(const DetailedFrame& frame) const;
  /// Records that the frame was published at `now`.
  void sent(const DetailedFrame& frame, double now);

 private:
  double period(const DetailedFrame& frame) const { return 1.0 / (still(frame) ? kStillRate : rate_); }

  double rate_ = publish_rate(1);
  double slot_ = 0.0;  ///< of the last published frame; at most one period after it
  std::optional<DetailedFrame> last_;
};

/// Leaves out details that repeat the previous one, but no more than 14 in a row, so that readers who have
/// missed it or join later get it.
class DetailPace {
 public:
  /// Whether the detail of a tracked frame is to be sent.
  bool take(const PoseDetail& detail);

 private:
  PoseDetail last_;
  bool taken_ = false;  ///< a detail: trackers without hands and face send none
  int skipped_ = 0;
};

}  // namespace telemime::meeting
