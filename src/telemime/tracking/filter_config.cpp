// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/filter_config.h"

#include "telemime/core/errors.h"
#include "telemime/tracking/heuristics/all.h"

namespace telemime {

void FilterConfig::validate() const {
  const auto require = [](bool good, const std::string& what) {
    if (!good) {
      throw Error(ErrorKind::config, "filter: " + what);
    }
  };
  require(particles >= 1 && particles <= 1000000, "particles must be between 1 and 1000000");
  try {
    parse_heuristics(heuristics);
  } catch (const Error& error) {
    require(false, std::string("heuristics: ") + error.what());
  }
  require(estimate == "heaviest" || estimate == "mean", "estimate must be heaviest or mean");
  require(diffusion > 0.0 && diffusion <= 100.0, "diffusion must be above 0, at most 100");
  require(memory >= 0.0 && memory <= 1.0, "memory must be between 0 and 1");
  require(trust > 0.0 && trust <= 10.0, "trust must be above 0, at most 10");
  require(natural >= 0.0 && temporal >= 0.0 && invalid >= 0.0,
          "natural, temporal and invalid must not be negative");
  require(modes >= 1 && modes <= 1000, "modes must be between 1 and 1000");
  require(mode_radius > 0.0 && mode_radius <= 1.0, "mode_radius must be above 0, at most 1 m");
  require(mode_least >= 10 && mode_least <= mode_most && mode_most <= 1000000,
          "10 <= mode_least <= mode_most <= 1000000 is needed");
  require(turn_evaluations >= 10 && turn_evaluations <= 1000000,
          "turn_evaluations must be between 10 and 1000000");
  require(walk_evaluations >= 10 && walk_evaluations <= 1000000,
          "walk_evaluations must be between 10 and 1000000");
  require(flip_candidates >= 0 && flip_candidates <= 1000, "alternatives must be between 0 and 1000");
}

FilterConfig with_effort(FilterConfig config, double share) {
  for (int* number : {&config.particles, &config.mode_least, &config.mode_most, &config.turn_evaluations,
                      &config.walk_evaluations}) {
    *number = std::max(1, static_cast<int>(std::lround(share * *number)));
  }
  return config;
}

FilterConfig for_time_step(FilterConfig config, double frames) {
  config.diffusion *= std::sqrt(frames);
  config.temporal /= frames;
  return config;
}

FilterConfig reference_filter(const std::string& heuristics) {
  FilterConfig config;
  config.heuristics = heuristics;
  config.particles = 1000;
  config.memory = 1.0;
  config.trust = 1.0;
  config.natural = 0.0;
  config.temporal = 0.0;
  config.blocks = false;
  return config;
}

}  // namespace telemime
