// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <span>

#include "lab/experiments/experiments.h"
#include "telemime/body/arm_ik.h"
#include "telemime/body/rotations.h"
#include "telemime/capture/source.h"
#include "telemime/core/errors.h"
#include "telemime/evaluation/error_means.h"
#include "telemime/evaluation/frame_errors.h"
#include "telemime/offline/look_ahead.h"
#include "telemime/search/simplex.h"
#include "telemime/tracker/track_frame.h"
#include "telemime/tracking/heuristics/motion_partition.h"
#include "telemime/tracking/posterior.h"

namespace telemime {
namespace {

// One tracked frame with its errors.
struct Sample {
  Body body;
  Pose pose;
  double region = 0.0;
  std::array<std::optional<Eigen::Vector3d>, kJointCount> error;  // m, mid-shoulders made to coincide
};

struct Samples {
  std::vector<Sample> frames;
  Camera camera;                      // of the working image
  std::vector<double> sigma_region;   // of each clip
  std::vector<double> sigma_contour;  // share of the width
  std::array<std::vector<double>, kPoseSize> change;
  std::array<std::vector<double>, 2> swivel;
  std::array<std::vector<double>, kPartCount> uncovered;  // by parts that were still
};

double deviation(const std::vector<double>& values) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(values, mean, deviation);
  return deviation[0];
}

// Largest displacement of the part's joints from one true frame to the next, m; nothing where one is unknown.
std::optional<double> truth_motion(const Truth& truth, std::size_t t, std::size_t part) {
  static const std::array<std::vector<Joint>, kPartCount> kJoints = {
      {{Joint::neck, Joint::l_shoulder, Joint::r_shoulder},
       {Joint::head, Joint::head_top},
       {Joint::l_elbow, Joint::l_wrist, Joint::l_hand},
       {Joint::r_elbow, Joint::r_wrist, Joint::r_hand}}};
  double most = 0.0;
  for (const Joint joint : kJoints[part]) {
    const auto j = static_cast<std::size_t>(joint);
    const auto& before = truth.frames[t - 1][j];
    const auto& now = truth.frames[t][j];
    if (!before || !now) {
      return std::nullopt;
    }
    most = std::max(most, (*now - *before).norm());
  }
  return most;
}

void collect(const Clip& clip, const Config& config, Samples& samples) {
  TrackingRun run = make_tracking_run(config, clip.camera);
  samples.camera = run.tracker.working_camera;
  run.scene.features.learn_background(clip.background);
  std::size_t read = 0;
  LookAhead ahead = look_ahead(
      {.next = [&] { return read < clip.frames.size() ? std::optional(clip.frames[read++]) : std::nullopt; }},
      run);
  std::vector<double> regions;
  std::vector<double> contours;
  std::optional<MotionFrame> before;
  cv::Mat labels;
  const auto add = [&](const FrameRecord& record) {
    const MotionFrame& motion = record.estimate.motion;
    const auto t = static_cast<std::size_t>(motion.frame);
    if (motion.state != TrackState::tracking) {
      before.reset();
      return;
    }
    const Body& body = run.state.model.body;
    regions.push_back(motion.region_score);
    contours.push_back(motion.contour_score /
                       reference_width(run.tracker.config.image.width, run.tracker.config.image.height));
    const FrameErrors errors =
        measure_frame(motion, clip.camera, clip.truth.frames[t], clip.truth.camera, 1.0);
    Sample sample{body, motion.pose, motion.region_score, {}};
    for (std::size_t j = 0; j < kJointCount; ++j) {
      sample.error[j] = errors[j] ? errors[j]->aligned : std::nullopt;
    }
    samples.frames.push_back(sample);
    if (before) {
      const PoseVector way = (motion.pose.vector() - before->pose.vector()).cwiseAbs();
      for (std::size_t i = 0; i < kPoseSize; ++i) {
        samples.change[i].push_back(way[static_cast<Eigen::Index>(i)]);
      }
      for (const Side side : {Side::left, Side::right}) {
        const double turn =
            arm_target(body, motion.pose, side).swivel - arm_target(body, before->pose, side).swivel;
        samples.swivel[static_cast<std::size_t>(side)].push_back(std::abs(wrap_angle(turn)));
      }
      const auto shares = uncovered_shares(labels, record.features.labels, run.state.model, before->pose,
                                           run.tracker.working_camera);
      constexpr double kStill = 0.0015;  // m from frame to frame
      for (std::size_t part = 0; part < kPartCount; ++part) {
        const auto moved = truth_motion(clip.truth, t, part);
        if (moved && *moved < kStill) {
          samples.uncovered[part].push_back(shares[part]);
        }
      }
    }
    before = motion;
    labels = record.features.labels.clone();
  };
  for (const FrameRecord& record : ahead.records) {
    add(record);
  }
  for (; read < clip.frames.size(); ++read) {
    add(track_frame(clip.frames[read], run));
  }
  if (regions.empty()) {
    throw Error(ErrorKind::tracking, clip.name + ": no frame was tracked");
  }
  samples.sigma_region.push_back(deviation(regions));
  samples.sigma_contour.push_back(deviation(contours));
}

// Squared Mahalanobis distances of all errors of these joints, and the sum of log determinants.
struct Fit {
  std::vector<double> squared;
  double log_determinants = 0.0;
};

constexpr std::array<Joint, 6> kArmJoints = {Joint::l_shoulder, Joint::r_shoulder, Joint::l_elbow,
                                             Joint::r_elbow,    Joint::l_wrist,    Joint::r_wrist};
constexpr std::array<Joint, 4> kTrunkJoints = {Joint::root, Joint::neck, Joint::head, Joint::head_top};

Fit fit_of(const std::vector<Sample>& samples, const Camera& camera, const SpreadModel& model,
           std::span<const Joint> joints) {
  Fit fit;
  for (const Sample& sample : samples) {
    const auto covariance =
        model_covariance({.body = sample.body, .camera = camera, .region = sample.region, .size = model.size},
                         sample.pose, model);
    for (const Joint joint : joints) {
      const auto j = static_cast<std::size_t>(joint);
      if (sample.error[j]) {
        fit.squared.push_back(sample.error[j]->dot(covariance[j].ldlt().solve(*sample.error[j])));
        fit.log_determinants += std::log(covariance[j].determinant());
      }
    }
  }
  return fit;
}

// Largest likelihood of the errors; then as much wider that 95 % of them lie inside the 95 % region.
SpreadModel fit_spread(const std::vector<Sample>& samples, const Camera& camera, const SpreadModel& start) {
  const auto model_at = [&](const Eigen::VectorXd& x) {
    SpreadModel model = start;
    model.trunk = std::exp(x[0]);
    model.across = std::exp(x[1]);
    model.seen = std::exp(x[2]);
    model.slide = std::exp(x[3]);
    return model;
  };
  const Eigen::VectorXd from = Eigen::Vector4d(std::log(start.trunk), std::log(start.across),
                                               std::log(start.seen), std::log(start.slide));
  const Bounds bounds = {from.array() - 3.0, from.array() + 3.0};
  SimplexOptions options;
  options.max_evaluations = 300;
  const SimplexResult found = minimise(
      [&](const Eigen::VectorXd& x) {
        const Fit fit = fit_of(samples, camera, model_at(x), kArmJoints);
        double sum = fit.log_determinants;
        for (const double squared : fit.squared) {
          // Heavy tails: a flipped arm must not inflate the spread of all others.
          sum += 5.0 * std::log1p(squared / 2.0);
        }
        return sum;
      },
      axis_simplex(from, Eigen::Vector4d::Constant(0.5), bounds), bounds, options);
  SpreadModel model = model_at(found.best().point);
  constexpr double kChiSquared = 7.8147;
  for (int round = 0; round < 30; ++round) {
    const auto wider = [&](std::span<const Joint> joints) {
      const double reached =
          quantile(fit_of(samples, camera, model, joints).squared, 0.95).value_or(kChiSquared);
      return std::pow(reached / kChiSquared, 0.25);
    };
    const double arms = wider(kArmJoints);
    const double trunk = wider(kTrunkJoints);
    model.trunk *= arms;
    model.across *= arms;
    model.seen *= arms;
    model.slide *= arms;
    model.lean *= trunk;
  }
  return model;
}

}  // namespace

FilterModel learn_filter_model(const std::vector<std::filesystem::path>& clips, const Config& config,
                               const std::function<void(const std::string&)>& progress) {
  Samples samples;
  for (const auto& folder : clips) {
    const Clip clip = read_clip(folder, 0);
    if (progress) {
      progress("tracking " + clip.name);
    }
    collect(clip, config, samples);
  }
  FilterModel model = load_filter_model(config.filter.model);
  model.sigma[cue::kRegion] = mean_of(samples.sigma_region);
  model.sigma[cue::kContour] = mean_of(samples.sigma_contour);
  // Two standard deviations reach all but the fastest hundredth of the changes.
  const auto half_of_largest = [](const std::vector<double>& ways) {
    // A number that never changed must still be positive, as the file format requires.
    constexpr double kLeast = 1e-6;
    return std::max(kLeast, 0.5 * quantile(ways, 0.99).value_or(0.0));
  };
  for (std::size_t i = 0; i < kPoseSize; ++i) {
    model.change[static_cast<Eigen::Index>(i)] = half_of_largest(samples.change[i]);
  }
  model.swivel = 0.5 * (half_of_largest(samples.swivel[0]) + half_of_largest(samples.swivel[1]));
  for (std::size_t part = 0; part < kPartCount; ++part) {
    // A part that never rests gives no estimate of the noise of a still one.
    constexpr std::size_t kFewest = 20;
    constexpr double kLeast = 0.005;
    if (samples.uncovered[part].size() >= kFewest) {
      model.motion[part] = std::max(kLeast, quantile(samples.uncovered[part], 0.95).value_or(kLeast));
    }
  }
  std::vector<double> regions;
  for (const Sample& sample : samples.frames) {
    regions.push_back(sample.region);
  }
  model.spread.residual = quantile(regions, 0.5).value_or(model.spread.residual);
  model.spread = fit_spread(samples.frames, samples.camera, model.spread);
  return model;
}

}  // namespace telemime
