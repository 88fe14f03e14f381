// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/context.h"

#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "telemime/body/interpenetration.h"
#include "telemime/core/in_parallel.h"
#include "telemime/core/loop_order.h"
#include "telemime/core/square.h"
#include "telemime/likelihood/all.h"

namespace telemime {
Evaluators::Evaluators(const std::string& backend, int threads, const CueTable& cues)
    : threads_(usable_threads(threads)) {
  batch_ = make_backend(backend, {.threads = threads_, .cues = cues});
  // Single poses are too few for a device.
  const std::string single = backend == "scalar" ? "scalar" : "simd";
  for (int i = 0; i < threads_; ++i) {
    singles_.push_back(make_backend(single, {.cues = cues}));
  }
}

void Evaluators::evaluate(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
                          std::span<Score> scores, std::span<const Kinematics> kinematics) {
  batch_->evaluate(frame, model, poses, cues().needs(), scores, kinematics);
}

void Evaluators::each(std::size_t count, const std::function<void(std::size_t, Backend&)>& work) {
  // Whichever thread is free takes the next few. TBB alone would divide them among the threads beforehand.
  std::atomic<std::size_t> next = 0;
  const std::size_t workers = std::min(count, static_cast<std::size_t>(threads_));
  const std::size_t piece = std::max<std::size_t>(1, count / (16 * static_cast<std::size_t>(threads_)));
  const auto take = [&](Backend& backend) {
    for (std::size_t first = next.fetch_add(piece); first < count; first = next.fetch_add(piece)) {
      for (std::size_t i = first; i < std::min(first + piece, count); ++i) {
        work(i, backend);
      }
    }
  };
  tbb::task_arena arena(threads_);
  const LoopOrder order;
  arena.execute([&] {
    tbb::parallel_for(
        std::size_t{0}, workers,
        [&](std::size_t) {
          const LoopOrder::Task task(order);
          try {
            take(*singles_[static_cast<std::size_t>(tbb::this_task_arena::current_thread_index())]);
          } catch (...) {
            next = count;  // the others stop, too
            throw;
          }
        },
        tbb::simple_partitioner());
  });
}

Random FilterContext::random(std::uint64_t purpose, std::uint64_t index) const {
  return Random(seed, (purpose << 32U) ^ index);
}

double square_of_unknown_noise(double square, double usual) {
  return 2.0 * usual * std::log1p(square / usual);
}

double log_likelihood(const FilterContext& c, const Pose& pose, const Score& score, int parent) {
  return log_likelihood(c, pose, score, parent, forward_kinematics(c.model.body, pose));
}

double log_likelihood(const FilterContext& c, const Pose& pose, const Score& score, int parent,
                      const Kinematics& k) {
  // Equation 4.12: the costs of the cues are independent and normally distributed.
  const CueTable& cues = c.evaluators.cues();
  double squares = 0.0;
  for (std::size_t i = 0; i < cues.size(); ++i) {
    if (const double reliability = reliability_of(cues[i], c.frame); reliability > 0.0) {
      const double sigma = in_cost_units(cues[i], c.numbers.sigma[i], c.frame.camera);
      const double cost = square(score.costs[i] / sigma);
      const double usual = square(c.numbers.usual[i] / c.numbers.sigma[i]);
      const bool known = !c.frame.landmarks || usual == 0.0;
      squares += reliability * (known ? cost : square_of_unknown_noise(cost, usual));
    }
  }
  double sum = -0.5 * c.config.trust * squares;
  // What is known without the image.
  const Body& body = c.model.body;
  sum -= c.config.invalid > 0.0 ? c.config.invalid * interpenetration(body, k) : 0.0;
  sum -= c.config.natural > 0.0
             ? c.config.natural * natural_cost(body, pose, k, c.heading, arm_prior_of(c.frame))
             : 0.0;
  if (c.config.temporal > 0.0) {
    sum -= c.config.temporal *
           distance_from_predicted(k, c.predicted_joints.at(static_cast<std::size_t>(parent)));
  }
  return sum;
}

void measure(const FilterContext& context, std::span<Particle> particles) {
  std::vector<std::size_t> which;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (!particles[i].measured) {
      which.push_back(i);
      poses.push_back(particles[i].pose);
    }
  }
  // Once for the cues and for what is known without the image.
  std::vector<Kinematics> kinematics(poses.size());
  context.evaluators.each(poses.size(), [&](std::size_t i, Backend&) {
    kinematics[i] = forward_kinematics(context.model.body, poses[i]);
  });
  std::vector<Score> scores(poses.size());
  context.evaluators.evaluate(context.frame, context.model, poses, scores, kinematics);
  context.evaluators.each(which.size(), [&](std::size_t i, Backend&) {
    Particle& p = particles[which[i]];
    p.score = scores[i];
    p.log_likelihood = log_likelihood(context, p.pose, p.score, p.parent, kinematics[i]);
    p.measured = true;
  });
}

}  // namespace telemime
