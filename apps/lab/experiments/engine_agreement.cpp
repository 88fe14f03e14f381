// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/experiments/engine.h"
#include "telemime/body/interpenetration.h"
#include "telemime/core/errors.h"
#include "telemime/search/budget.h"

namespace telemime {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Pose random_pose(const JointLimits& limits, Random& random) {
  Pose pose;
  pose.root = {random.uniform(-0.2, 0.2), random.uniform(0.2, 0.5), random.uniform(1.0, 1.6)};
  for (std::size_t a = 0; a < kAngleCount; ++a) {
    pose.angles[a] = random.uniform(limits.min[a], limits.max[a]);
  }
  return pose;
}

// Ranks about their mean; equal values share the mean of theirs.
Eigen::ArrayXd centred_ranks(std::span<const double> list) {
  const Eigen::Map<const Eigen::ArrayXd> values(list.data(), static_cast<Eigen::Index>(list.size()));
  return values.unaryExpr([&](double value) {
    return 0.5 * static_cast<double>((values < value).count() - (values > value).count());
  });
}

// Around a true pose, as the last steps of a search try them.
std::vector<Pose> poses_around(const Pose& pose, std::size_t count, Random& random) {
  constexpr double kAngle = 3.0 * kDegree;
  constexpr double kPlace = 0.015;  // m
  std::vector<Pose> poses(count, pose);
  for (Pose& other : poses) {
    for (int i = 0; i < 3; ++i) {
      other.root[i] += random.uniform(-kPlace, kPlace);
    }
    for (double& angle : other.angles) {
      angle += random.normal(0.0, kAngle);
    }
  }
  return poses;
}

struct Pair {
  std::vector<Score> reference;
  std::vector<Score> tested;
};

Pair evaluate_both(Backend& reference, Backend& tested, const PreparedFrame& frame, const Model& model,
                   std::span<const Pose> poses) {
  Pair scores = {std::vector<Score>(poses.size()), std::vector<Score>(poses.size())};
  reference.evaluate(frame, model, poses, Reduction::all, scores.reference);
  tested.evaluate(frame, model, poses, Reduction::all, scores.tested);
  return scores;
}

double rank_correlation(const Pair& scores, double (Score::*cost)() const) {
  const auto column = [&](const std::vector<Score>& of) {
    std::vector<double> values;
    values.reserve(of.size());
    for (const Score& score : of) {
      values.push_back((score.*cost)());
    }
    return values;
  };
  return spearman(column(scores.reference), column(scores.tested));
}

Camera small_camera() {
  return engine_cameras().front();
}

// One row for each back end except the reference; `row` measures it.
void compare_each(const EngineOptions& options, Table& table,
                  const std::function<std::vector<std::string>(Backend&, Backend&)>& row) {
  const auto reference = make_backend("scalar");
  for (const std::string& name : engine_backends(options)) {
    if (name != reference->name()) {
      std::vector<std::string> fields = {name};
      const auto measured = row(*reference, *make_backend(name));
      fields.insert(fields.end(), measured.begin(), measured.end());
      table.rows.push_back(std::move(fields));
    }
  }
}

}  // namespace

std::vector<Pose> valid_poses(const Body& body, const JointLimits& limits, std::size_t count,
                              Random& random) {
  constexpr int kMostTries = 10000;
  std::vector<Pose> poses;
  poses.reserve(count);
  for (int tries = 0; poses.size() < count;) {
    const Pose pose = random_pose(limits, random);
    if (interpenetration(body, forward_kinematics(body, pose)) < kInvalidInterpenetration) {
      poses.push_back(pose);
      tries = 0;
    } else if (++tries == kMostTries) {
      throw Error(ErrorKind::usage, "within the limits " + limits.name + " an arm is always inside the body",
                  "Give wider limits.");
    }
  }
  return poses;
}

std::array<Shape, 3> different_people() {
  std::array<Shape, 3> people;
  Shape& tall = people[1];
  tall.stature = 1.86;
  tall[Segment::chest] = {1.05, 1.1, 0.94};
  tall[Segment::head] = {0.97, 1.02, 1.04};
  tall[Segment::l_upper_arm] = tall[Segment::r_upper_arm] = {1.06, 0.9, 1.2};
  tall[Segment::l_forearm] = tall[Segment::r_forearm] = {0.95, 1.1, 1.05};
  tall[Segment::l_hand] = tall[Segment::r_hand] = {1.03, 0.95, 1.0};
  Shape& small = people[2];
  small.stature = 1.55;
  small[Segment::chest].width = 1.08;
  small[Segment::l_forearm].length = small[Segment::r_forearm].length = 1.05;
  small.sleeve = 1.6;
  return people;
}

double spearman(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size()) {
    throw Error(ErrorKind::usage, "a rank correlation needs two lists of one length");
  }
  const Eigen::ArrayXd rank_a = centred_ranks(a);
  const Eigen::ArrayXd rank_b = centred_ranks(b);
  const double scale = std::sqrt(rank_a.square().sum() * rank_b.square().sum());
  return scale > 0.0 ? (rank_a * rank_b).sum() / scale : 0.0;
}

Agreement compare_scores(Backend& reference, Backend& tested, std::size_t poses, std::uint64_t seed) {
  constexpr std::size_t kEachPicture = 100;
  const std::array<Shape, 3> people = different_people();
  Agreement result;
  for (std::size_t person = 0; person < people.size(); ++person) {
    const Model model = make_model(people[person]);
    Random random(seed, person);
    std::size_t left = poses * (person + 1) / people.size() - poses * person / people.size();
    while (left > 0) {
      const std::size_t count = std::min(left, kEachPicture);
      const std::vector<Pose> drawn = valid_poses(model.body, anatomical_limits(), count + 1, random);
      const PreparedFrame frame = frame_of_model(model, drawn.back(), small_camera());
      const Pair scores = evaluate_both(reference, tested, frame, model, std::span(drawn).first(count));
      for (std::size_t i = 0; i < count; ++i) {
        const double region = std::abs(scores.tested[i].region() - scores.reference[i].region());
        const double contour = std::abs(scores.tested[i].contour() - scores.reference[i].contour());
        result.region_max = std::max(result.region_max, region);
        result.contour_max = std::max(result.contour_max, contour);
        result.region_mean += region / static_cast<double>(poses);
        result.contour_mean += contour / static_cast<double>(poses);
      }
      result.poses += count;
      left -= count;
    }
  }
  return result;
}

RankAgreement compare_ranks(Backend& reference, Backend& tested, std::size_t frames, std::uint64_t seed) {
  constexpr std::size_t kPoses = 200;
  const std::array<Shape, 3> people = different_people();
  RankAgreement result;
  for (std::size_t f = 0; f < frames; ++f) {
    const Model model = make_model(people[f % people.size()]);
    Random random(seed, 1000 + f);
    const Pose pose = valid_poses(model.body, anatomical_limits(), 1, random).front();
    const PreparedFrame frame = frame_of_model(model, pose, small_camera());
    const Pair scores = evaluate_both(reference, tested, frame, model, poses_around(pose, kPoses, random));
    const double region = rank_correlation(scores, &Score::region);
    const double contour = rank_correlation(scores, &Score::contour);
    result.region_min = std::min(result.region_min, region);
    result.contour_min = std::min(result.contour_min, contour);
    result.region_mean += region / static_cast<double>(frames);
    result.contour_mean += contour / static_cast<double>(frames);
  }
  return result;
}

Table agreement_table(const EngineOptions& options) {
  const std::size_t poses = options.quick ? 500 : 10000;
  Table table{"Differences from scalar at 160x120, random valid poses",
              {"back end", "poses", "largest |dF|", "mean |dF|", "largest |dD_C| px", "mean |dD_C| px"},
              {}};
  compare_each(options, table, [&](Backend& reference, Backend& tested) {
    const Agreement a = compare_scores(reference, tested, poses, options.seed);
    return row_of(a.poses, a.region_max, a.region_mean, a.contour_max, a.contour_mean);
  });
  return table;
}

Table ranking_table(const EngineOptions& options) {
  const std::size_t frames = options.quick ? 5 : 20;
  Table table{"Rank correlation (Spearman) with scalar near the true pose at 160x120",
              {"back end", "frames", "F least", "F mean", "D_C least", "D_C mean"},
              {}};
  compare_each(options, table, [&](Backend& reference, Backend& tested) {
    const RankAgreement r = compare_ranks(reference, tested, frames, options.seed);
    return row_of(frames, r.region_min, r.region_mean, r.contour_min, r.contour_mean);
  });
  return table;
}

}  // namespace telemime
