// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/smoother.h"

#include <optional>

#include "telemime/body/rotations.h"
#include "telemime/tracker/face_smoother.h"
#include "telemime/tracker/hand_smoother.h"
#include "telemime/tracker/joint_rotations.h"
#include "telemime/tracker/rotation_noise.h"

namespace telemime {
namespace {

class NoSmoother final : public Smoother {
 public:
  MotionFrame operator()(const MotionFrame& frame) override { return frame; }
};

/// What all filters share: when to restart, and how a smoothed pose becomes a frame.
class RotationSmoother : public Smoother {
 public:
  RotationSmoother(const Body& body, const Camera& camera, const HandSmoothing& hands)
      : body_(body), camera_(camera), hands_(hands) {}

  MotionFrame operator()(const MotionFrame& frame) final {
    MotionFrame result = steadied_body(frame);
    result.face = face_(frame.face, frame.time);
    return result;
  }

 protected:
  /// First frame after a start or a loss: smooth_ becomes `measured`.
  virtual void start(const JointRotations& measured) = 0;
  /// Moves smooth_ toward `measured`, `step` seconds after the last.
  virtual void update(const JointRotations& measured, const NoiseRatios& noise, double step) = 0;

  JointRotations smooth_;

 private:
  MotionFrame steadied_body(const MotionFrame& frame) {
    if (frame.state == TrackState::lost || !frame.pose.vector().allFinite()) {
      last_time_.reset();
      return frame;
    }
    const JointRotations measured = rotations_of(frame.pose);
    const double step = last_time_ ? frame.time - *last_time_ : 0.0;
    if (step > 0.0 && step <= kLongestGap) {
      update(measured, noise_of(frame, camera_), step);
    } else {
      start(measured);
      hands_.restart();
    }
    last_time_ = frame.time;
    MotionFrame result = with_pose(frame, pose_of(smooth_, frame.pose), body_, camera_);
    if (frame.hands) {
      result.hands = hands_(*frame.hands, forward_kinematics(body_, result.pose), step);
    }
    return result;
  }

  Body body_;
  Camera camera_;
  HandSmoother hands_;
  std::optional<double> last_time_;
  FaceSmoother face_;
};

/// Equation 4.30 for a rotation: a of the past and 1 - a of the present along the arc between them.
class RecursiveSmoother final : public RotationSmoother {
 public:
  RecursiveSmoother(const Body& body, const Camera& camera, double coefficient)
      : RotationSmoother(body, camera, {.one_euro = {}, .share = 1.0 - coefficient}),
        present_(1.0 - coefficient) {}

 private:
  void start(const JointRotations& measured) override { smooth_ = measured; }

  void update(const JointRotations& measured, const NoiseRatios& /*noise*/, double /*step*/) override {
    smooth_.root += present_ * (measured.root - smooth_.root);
    for (std::size_t j = 0; j < smooth_.rotation.size(); ++j) {
      smooth_.rotation[j] = smooth_.rotation[j].slerp(present_, measured.rotation[j]).normalized();
    }
    for (std::size_t side = 0; side < 2; ++side) {
      smooth_.elbow[side] += present_ * wrap_angle(measured.elbow[side] - smooth_.elbow[side]);
    }
  }

  double present_;
};

class OneEuroSmoother final : public RotationSmoother {
 public:
  OneEuroSmoother(const Body& body, const Camera& camera, const SmoothingOptions& options)
      : RotationSmoother(body, camera, {.one_euro = options.hands, .share = {}}),
        angles_(options.angles),
        root_(options.root) {}

 private:
  void start(const JointRotations& measured) override {
    smooth_ = measured;
    last_ = measured;
    root_speed_.reset();
    for (auto& speed : rotation_speed_) {
      speed.reset();
    }
    for (auto& speed : elbow_speed_) {
      speed.reset();
    }
  }

  void update(const JointRotations& measured, const NoiseRatios& noise, double step) override {
    const double root_share = root_speed_(measured.root - last_.root, step, root_);
    smooth_.root += root_share * (measured.root - smooth_.root);
    for (std::size_t j = 0; j < smooth_.rotation.size(); ++j) {
      const double present =
          rotation_speed_[j](turn_between(last_.rotation[j], measured.rotation[j]), step, angles_);
      smooth_.rotation[j] = smooth_.rotation[j]
                                .slerp(with_noise(present, noise.rotation[j]), measured.rotation[j])
                                .normalized();
    }
    for (std::size_t side = 0; side < 2; ++side) {
      const double change = wrap_angle(measured.elbow[side] - last_.elbow[side]);
      const double present = elbow_speed_[side]({change, 0.0, 0.0}, step, angles_);
      smooth_.elbow[side] +=
          with_noise(present, noise.elbow[side]) * wrap_angle(measured.elbow[side] - smooth_.elbow[side]);
    }
    last_ = measured;
  }

  OneEuroOptions angles_;
  OneEuroOptions root_;
  JointRotations last_;
  SpeedShare root_speed_;
  std::array<SpeedShare, 6> rotation_speed_;
  std::array<SpeedShare, 2> elbow_speed_;
};

SettingTable one_euro_settings(OneEuroOptions& o, const std::string& group, const std::string& speed) {
  return {{number(group + ".minimum_cutoff", &o.minimum_cutoff, {1e-6, 1e6}, "Hz",
                  "Cutoff frequency of the One-Euro filter at rest; lower smooths more."),
           number(group + ".slope", &o.slope, {0, 1e6}, "Hz per " + speed,
                  "Increase of the cutoff frequency with the speed; higher follows fast motion sooner."),
           number(group + ".speed_cutoff", &o.speed_cutoff, {1e-6, 1e6}, "Hz",
                  "Cutoff frequency of the low-pass filter of the speed.")},
          {}};
}

SettingTable interval_settings(IntervalModel& o, const std::string& group, const std::string& unit) {
  return {
      {number(group + ".noise", &o.noise, {1e-6, 10}, unit, "Standard deviation of what is measured."),
       number(group + ".motion", &o.motion, {1e-6, 1e3}, unit + "/s^1.5",
              "Random acceleration: root of its spectral density; lower smooths more."),
       number(group + ".sudden", &o.sudden, {0.1, 1e6}, "",
              "Degrees of freedom of the acceleration (Student's t); lower follows sudden motion sooner.")},
      {}};
}

}  // namespace

SettingTable settings_of(SmoothingOptions& o) {
  SettingTable table;
  table.rows = {text("smoothing", o.name, {"none", "recursive", "one-euro"},
                     "Filter of the joint rotations over time."),
                number("smoother.look_ahead", &o.look_ahead, {0, 250}, "1/25 s",
                       "Time after a frame of a file that is used; 0: the plain filter, as live."),
                number("smoother.recursive_coefficient", &o.recursive_coefficient, {0, 0.999}, "",
                       "Share of the past in the recursive filter (equation 4.30).")};
  table.append(one_euro_settings(o.angles, "smoother.angles", "rad/s"));
  table.append(one_euro_settings(o.root, "smoother.root", "m/s"));
  table.append(one_euro_settings(o.hands, "smoother.hands", "rad/s"));
  table.append(interval_settings(o.file.angles, "smoother.file.angles", "rad"));
  table.append(interval_settings(o.file.root, "smoother.file.root", "m"));
  table.append(interval_settings(o.file.fingers, "smoother.file.fingers", "rad"));
  return table;
}

MotionFrame with_pose(const MotionFrame& frame, const Pose& pose, const Body& body, const Camera& camera) {
  MotionFrame result = frame;
  result.pose = pose;
  const Kinematics kinematics = forward_kinematics(body, pose);
  result.joints = kinematics.joints;
  if (result.hands) {
    place_hands(kinematics, *result.hands);
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Vector3d& before = frame.joints.at[j];
    const Eigen::Vector3d& after = result.joints.at[j];
    if (before.z() > 0.0 && after.z() > 0.0) {
      // A difference: pixels that were set otherwise keep their offset.
      result.pixels[j] += camera.project(after) - camera.project(before);
    }
  }
  return result;
}

std::unique_ptr<Smoother> make_smoother(const SmoothingOptions& options, const Body& body,
                                        const Camera& camera) {
  check_settings(options);
  if (options.name == "none") {
    return std::make_unique<NoSmoother>();
  }
  if (options.name == "recursive") {
    return std::make_unique<RecursiveSmoother>(body, camera, options.recursive_coefficient);
  }
  return std::make_unique<OneEuroSmoother>(body, camera, options);
}

}  // namespace telemime
