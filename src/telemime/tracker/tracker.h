// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "telemime/body/motion_frame.h"
#include "telemime/core/camera.h"
#include "telemime/core/frame.h"
#include "telemime/core/random.h"
#include "telemime/image/features.h"
#include "telemime/likelihood/backend.h"
#include "telemime/tracker/config.h"
#include "telemime/tracking/particle_filter.h"

namespace telemime {

/// What calibration found out about a person and the scene; enough to track them again without calibrating.
struct TrackerCalibration {
  Shape shape;
  std::string scale_from;  ///< where the absolute scale comes from, in words
  std::string refusal;     ///< why the arms kept average proportions; empty: they were fitted
  Score score;
  bool height_given = false;  ///< the scale is that of a height that was given
};

/// A person who was calibrated before: where tracking starts, and from which pose.
struct KnownStart {
  TrackerCalibration person;
  std::int64_t frame = 0;
  Pose pose;  ///< in that frame
  /// From here on the person had the same colours and stayed in the picture: tracking may start here already,
  /// although no shape could be fitted yet.
  std::int64_t since = frame;
};

/// One frame's result with what a viewer may want to draw.
struct TrackedFrame {
  MotionFrame motion;      ///< not smoothed
  FrameFeatures features;  ///< of the working image
  std::string note;        ///< why the person is not tracked, in words; empty while tracking
  std::vector<std::string>
      warnings;  ///< what breaks the tracker's assumptions (light, sleeves, camera), in words
  std::optional<StretchFrame> stretch;  ///< while tracking, where Config::look_back asks for it
};

/// The image side of one frame: what the search side goes on with.
struct SeenFrame {
  Frame frame;
  FrameFeatures features;
  PreparedFrame prepared;             ///< when `coloured`; memory is used again
  std::vector<std::string> warnings;  ///< as TrackedFrame::warnings
  std::string note;                   ///< why the person's colours are not known
  bool coloured = false;              ///< the person's colours are known
  bool face_just_seen = false;        ///< they were learned in this frame
  bool person = false;                ///< somebody is in the picture
  double ms = 0.0;                    ///< time that it took
};

/// Follows one person from frame to frame: features, calibration on the first good frame, registration, lost
/// and found. Same frames, same configuration: same results.
class Tracker {
 public:
  /// `camera` is that of the input images. Throws Error(config).
  Tracker(const Config& config, const Camera& camera);

  void learn_background(std::span<const Frame> frames);
  /// Learns what it can of the scene from frames of the input itself (FeatureExtractor::bootstrap).
  SceneReport bootstrap(std::span<const Frame> clip);
  /// Takes over what another tracker of the same input learned of the scene.
  void set_scene(const ImageCalibration& scene);
  void set_calibration(const TrackerCalibration& calibration, const ImageCalibration& image);
  /// Uses this person and pose in that frame instead of calibrating there; or the person earlier, where a
  /// search finds the pose.
  void start_with(const KnownStart& start) { known_ = start; }

  /// decide(look(frame)).
  TrackedFrame step(const Frame& frame);

  /// The image side: features of a frame, into `seen`, whose memory is used again. Frames in the order of
  /// time. `settled` is settled() after decide() of the frame before; with true, look() may run beside
  /// decide(), and both give what they would give one after the other.
  void look(const Frame& frame, bool settled, SeenFrame& seen);
  /// The search side: the pose of a frame that was looked at.
  TrackedFrame decide(SeenFrame& seen);
  /// A person was calibrated: the image side needs nothing of the search side.
  bool settled() const { return calibration_.has_value(); }

  /// From the next decide() on, the search takes a share (above 0, at most 1) of the evaluations that the
  /// configuration asks for. Not beside decide().
  void set_effort(double share);

  /// Starts over with the person (not the scene) at the next frame: with their colours, too, since it may be
  /// somebody else, or the same person in other clothes. Not beside look().
  void recalibrate();

  /// How sure a particle filter that follows this person is of what it found.
  PoseSpread spread(const ParticleFilter& filter, const FilterResult& found) const;

  const std::optional<TrackerCalibration>& calibration() const { return calibration_; }
  /// The frame since which a head has been in the picture, with the colours that are known now.
  std::int64_t since() const { return since_; }
  const FeatureExtractor& features() const { return features_; }
  const Model& model() const { return model_; }
  const Camera& camera() const { return camera_; }
  const Camera& working_camera() const { return working_camera_; }
  const JointLimits& limits() const { return limits_; }
  const Config& config() const { return config_; }

 private:
  enum class Phase { waiting, tracking, lost };

  void person_colours(SeenFrame& seen);
  void search(const SeenFrame& seen, TrackedFrame& result);
  void follow(const SeenFrame& seen, TrackedFrame& result);
  void follow_with_filter(const SeenFrame& seen, TrackedFrame& result);
  void watch(const SeenFrame& seen, const Score& score, TrackedFrame& result);
  void adopt(const Pose& pose, const Score& score, TrackedFrame& result);
  void lose(const std::string& why, TrackedFrame& result);

  Config config_;
  Camera camera_;
  Camera working_camera_;
  JointLimits limits_;
  FeatureExtractor features_;
  std::unique_ptr<Backend> backend_;
  std::unique_ptr<Evaluators> evaluators_;
  std::unique_ptr<ParticleFilter> filter_;  ///< null: registration alone
  SeenFrame seen_;                          ///< of step(), for its memory
  Random random_;
  Model model_;
  std::optional<TrackerCalibration> calibration_;
  std::optional<KnownStart> known_;
  Phase phase_ = Phase::waiting;
  Pose pose_;
  Pose previous_;
  double effort_ = 1.0;
  double decided_ = 0.0;              ///< time of the last frame, s
  double steps_ = 1.0;                ///< since then, in 1/25 s
  double facing_ = 0.0;               ///< of the filter's last step
  double steps_before_ = 1.0;         ///< and between the two frames before it
  int bad_frames_ = 0;                ///< in a row
  double bad_for_ = 0.0;              ///< 1/25 s
  double frames_until_search_ = 0.0;  ///< 1/25 s
  std::int64_t since_ = 0;            ///< of the image side
  bool colours_asked_ = false;        ///< of the image side: those that are known are not the person's
  int waited_ = 0;                    ///< frames since a head came into the picture
};

/// Time between two frames in 1/25 s, for which the motion model is made: exactly 1 where it is about that or
/// not known, at least 0.2 and at most 8. Times in s.
double steps_between(double before, double now);

/// Fills joints and pixels of a frame from its pose.
void complete(MotionFrame& frame, const Body& body, const Camera& camera);

}  // namespace telemime
