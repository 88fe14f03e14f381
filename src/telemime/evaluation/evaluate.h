// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "telemime/body/motion_frame.h"
#include "telemime/evaluation/frame_errors.h"
#include "telemime/evaluation/hand_errors.h"
#include "telemime/evaluation/head_errors.h"
#include "telemime/evaluation/motion_measures.h"
#include "telemime/evaluation/truth.h"

namespace telemime {

struct EvaluationOptions {
  /// A tracked frame with F above this, or D_C (pixels of the working image) above that, is mistracked.
  double max_region_score = 0.5;
  double max_contour_score = 4.0;
  /// Poses are those of the frames of the truth at their times, not of the same numbers: for recordings and
  /// videos of variable rate, which hold some of the frames.
  bool by_time = false;
};

/// Mean errors, m and pixels; nothing where no frame could be measured.
struct MeanErrors {
  std::optional<double> camera;           ///< in the camera frame
  std::optional<double> aligned;          ///< mid-shoulders coincide
  std::optional<double> image_plane;      ///< part of `aligned` in x and y
  std::optional<double> depth;            ///< part of `aligned` in z
  std::optional<double> fitted;           ///< after a similarity fit of each frame
  std::optional<double> pixels;           ///< of the truth's image
  std::optional<double> pixels_at_depth;  ///< the same at the person's depth
};

/// Errors over one choice of frames.
struct ErrorReport {
  std::size_t frames = 0;  ///< that went into it
  MeanErrors scored;       ///< elbows and wrists: mean in each frame, then over frames
  std::array<MeanErrors, kJointCount> by_joint{};  ///< by Joint
  std::optional<double> aligned_median;            ///< of the frames' means
  std::optional<double> aligned_p95;
};

struct StageTime {
  std::string stage;
  double median_ms = 0.0;
  double p95_ms = 0.0;
};

/// Everything that is measured of one sequence (docs/evaluation.md).
struct Evaluation {
  EvaluationOptions options;
  std::string truth_name;
  double fps = 25.0;                   ///< of the truth
  std::size_t truth_frames = 0;        ///< in the truth
  std::size_t scored_frames = 0;       ///< of these, to be scored (visible, inside the range)
  std::size_t pose_frames = 0;         ///< frames of the pose file that the truth also has
  std::size_t extra_pose_frames = 0;   ///< frames of the pose file beyond the truth: ignored
  std::optional<double> fitted_scale;  ///< the estimate was multiplied by this; nothing when scale is known

  ErrorReport tracked;  ///< over scored frames that were tracked
  ErrorReport all;      ///< over all scored frames; a lost or missing one counts with its last known pose
  std::size_t unmeasured_frames = 0;  ///< scored frames before the first pose: in neither report

  double lost = 0.0;                   ///< fraction of all frames that are lost or missing
  double lost_scored = 0.0;            ///< of the scored frames
  std::optional<double> lost_empty;    ///< of the frames without a person: 1 is right
  std::optional<double> mean_region;   ///< F over scored, tracked frames
  std::optional<double> mean_contour;  ///< D_C, pixels of the working image
  std::size_t mistracked = 0;          ///< scored, tracked frames with F or D_C above its threshold
  std::vector<std::int64_t> swapped;   ///< scored, tracked frames with left and right exchanged
  /// Scored, tracked frames: how often the true elbow or wrist, seen from the middle of the shoulders, lies
  /// inside the 95 % region that the poses state; nothing when they state none.
  std::optional<double> covered;
  std::array<std::optional<double>, kJointCount> covered_by_joint{};  ///< the same of each joint
  std::optional<double> stated_across;  ///< m, mean stated standard deviation of elbows and wrists in x and y
  std::optional<double> stated_depth;   ///< m, the same in z
  std::optional<double> jitter;         ///< m/frame^2, scored and tracked frames
  std::optional<double> truth_jitter;   ///< the truth's own, same frames
  std::optional<Lag> lag;
  std::optional<TurnReport> turn;  ///< scored and tracked frames
  std::array<std::optional<BoneLength>, kBoneNames.size()> bones{};
  std::array<std::optional<BoneLength>, kBoneNames.size()> truth_bones{};
  std::optional<HandReport> hands;  ///< nothing when the truth or the pose file has none
  std::optional<HeadReport> head;   ///< the same
  std::vector<StageTime> times;     ///< over all frames of the pose file, in order of first appearance
};

/// Compares `frames` (numbers increasing), whose pixels belong to `input`, with the truth. Throws
/// Error(input) when they have no frame in common, or none that can be scored.
Evaluation evaluate(const std::vector<MotionFrame>& frames, const Camera& input, const Truth& truth,
                    const EvaluationOptions& options);

/// The frames with the numbers that frames of a constant rate have at their times; of several with the same
/// number, the nearest.
std::vector<MotionFrame> numbered_by_time(const std::vector<MotionFrame>& frames, double fps);

/// Whether a frame is more than half a frame from the time that its number has at a constant rate.
bool has_variable_rate(const std::vector<MotionFrame>& frames, double fps);

/// The factor that brings the estimate to the truth's size: least squares over elbows, wrists and shoulders
/// with the mid-shoulders as origin. 1 when there is nothing to fit.
double fit_scale(const JointTrack& estimate, const JointTrack& truth);

}  // namespace telemime
